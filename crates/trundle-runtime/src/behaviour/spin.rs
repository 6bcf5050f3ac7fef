//! A turn on the spot to observe the surroundings.

use std::f64::consts::TAU;
use trundle_core::{Pose2, Twist2, Vector2, wrap_angle};

/// A turn on the spot that observes the surroundings.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Spin {
    last: Option<f64>,
    turned: f64,
    /// The commands so far.
    commands: u32,
}

/// Turn rate \[rad/s\]: slow enough for features to be tracked. Source: ours.
pub(crate) const SPIN_RATE_RAD_S: f64 = 0.6;
/// Length of a spin in turns: slightly more than one, for overlapping views. Source: ours.
pub(crate) const SPIN_TURNS: f64 = 1.02;
/// Factor on the commands needed for a spin; a spin that no sensor measures ends at this multiple. Source: ours.
const UNMEASURED_SPIN_FACTOR: f64 = 1.5;
/// Time between two commands \[s\]. Source: ours, a control rate of 50 Hz.
const COMMAND_PERIOD_S: f64 = 0.02;
/// Bearing of a target below which the robot faces the target \[rad\]. Source: ours.
const FACING_TOLERANCE_RAD: f64 = 0.05;

impl Spin {
    /// The command of a turn to the left; records the angle turned.
    pub(crate) fn twist(&mut self, pose: Pose2) -> Twist2 {
        self.twist_towards(SPIN_RATE_RAD_S, pose)
    }

    /// The command of a turn in the direction of this turn rate (rad/s); records the angle turned.
    pub(crate) fn twist_towards(&mut self, side: f64, pose: Pose2) -> Twist2 {
        let last = self.last.replace(pose.theta).unwrap_or(pose.theta);
        self.turned += wrap_angle(pose.theta - last).abs();
        self.commands = self.commands.saturating_add(1);
        Twist2::new(0.0, SPIN_RATE_RAD_S.copysign(side))
    }

    /// The angle left of a spin of [`SPIN_TURNS`], rad.
    pub(crate) fn rest(&self) -> f64 {
        (SPIN_TURNS * TAU - self.turned).max(0.0)
    }

    /// Whether at least `turns` revolutions are made.
    pub(crate) fn has_turned(&self, turns: f64) -> bool {
        self.turned
            .max(f64::from(self.commands) * COMMAND_PERIOD_S * SPIN_RATE_RAD_S / UNMEASURED_SPIN_FACTOR)
            > turns * TAU
    }
}

/// The turn on the spot that brings `at` (map frame, m) into the middle of the view.
pub(crate) fn face(pose: Pose2, at: Vector2) -> Twist2 {
    let ahead = at - pose.position();
    if ahead.norm() < 1e-3 { Twist2::ZERO } else { turn_to(pose, ahead.y.atan2(ahead.x)) }
}

/// The turn on the spot towards a heading. Zero if the heading is near enough.
pub(crate) fn turn_to(pose: Pose2, heading: f64) -> Twist2 {
    let off = wrap_angle(heading - pose.theta);
    Twist2::new(
        0.0,
        if off.abs() < FACING_TOLERANCE_RAD {
            0.0
        } else {
            (2.0 * off).clamp(-SPIN_RATE_RAD_S, SPIN_RATE_RAD_S)
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn two_turns_are_two_turns() {
        let mut look = Spin::default();
        let mut steps = 0;
        while !look.has_turned(2.0) {
            assert_eq!(look.twist(Pose2::new(0.0, 0.0, 0.1 * f64::from(steps))).v, 0.0);
            steps += 1;
        }
        assert!((f64::from(steps) * 0.1 - 2.0 * TAU).abs() < 0.3, "{steps} steps");
    }

    #[test]
    fn a_turn_that_nobody_counts_comes_to_an_end() {
        let mut look = Spin::default();
        let steps =
            (0..10_000).take_while(|_| !look.has_turned(1.0) && look.twist(Pose2::IDENTITY).omega > 0.0);
        let seconds = steps.count() as f64 * COMMAND_PERIOD_S;
        assert!((seconds - 1.5 * TAU / SPIN_RATE_RAD_S).abs() < 0.1, "{seconds} s");
    }

    #[test]
    fn it_turns_the_shorter_way_to_what_it_faces() {
        let right = Vector2::new(0.0, -1.0);
        assert!(face(Pose2::IDENTITY, right).omega < 0.0);
        assert_eq!(face(Pose2::new(0.0, 0.0, -std::f64::consts::FRAC_PI_2), right), Twist2::ZERO);
    }

    #[test]
    fn a_spin_to_either_side_has_the_same_rate() {
        for side in [-3.0, -0.1, 0.1, 3.0] {
            let twist = Spin::default().twist_towards(side, Pose2::IDENTITY);
            assert_eq!((twist.v, twist.omega), (0.0, SPIN_RATE_RAD_S.copysign(side)));
        }
    }

    #[test]
    fn the_floor_under_the_robot_needs_no_turn() {
        assert_eq!(face(Pose2::new(1.0, 2.0, 0.5), Vector2::new(1.0, 2.0)), Twist2::ZERO);
    }

    proptest! {
        #[test]
        fn a_turn_reaches_any_heading_the_shorter_way_without_overshoot(
            start in -9.0..9.0_f64, heading in -9.0..9.0_f64,
        ) {
            // A step wraps the heading of the pose, so the first angle is that from the wrapped start.
            let (mut pose, mut off) =
                (Pose2::new(1.0, 2.0, start), wrap_angle(heading - wrap_angle(start)));
            let steps = (off.abs() / SPIN_RATE_RAD_S + 3.0) / COMMAND_PERIOD_S;
            for _ in 0..steps as usize {
                let twist = turn_to(pose, heading);
                prop_assert!(twist.v == 0.0 && twist.omega.abs() <= SPIN_RATE_RAD_S);
                pose = pose.advance(twist, COMMAND_PERIOD_S);
                let left = wrap_angle(heading - pose.theta);
                prop_assert!(left.abs() <= off.abs() && left * off >= 0.0, "{off} rad became {left} rad");
                off = left;
            }
            prop_assert!(off.abs() <= FACING_TOLERANCE_RAD);
            prop_assert_eq!(turn_to(pose, heading), Twist2::ZERO);
        }
    }
}
