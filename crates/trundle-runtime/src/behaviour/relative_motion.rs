//! Motions relative to the robot's pose: a turn on the spot by an angle, a straight drive by a distance.

use crate::behaviour::spin::SPIN_RATE_RAD_S;
use trundle_core::{Pose2, Stamp, Twist2, difference_of_angles};

/// A motion relative to the robot's pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum RelativeMotion {
    /// A turn on the spot by an angle, positive to the left \[rad\].
    Turn {
        /// \[rad\]
        angle: f64,
    },
    /// A straight drive; a positive distance is ahead.
    Straight {
        /// \[m\]
        distance: f64,
        /// \[m/s\]
        speed: f64,
    },
}

/// Turn rate per remaining angle \[1/s\]: the turn ends without overshoot. Source: ours.
const TURN_GAIN: f64 = 2.0;
/// Lowest turn rate before the end of a turn \[rad/s\]. Source: ours.
const MIN_TURN_RATE_RAD_S: f64 = 0.1;
/// Remaining angle at which a turn is done \[rad\]. Source: ours.
const TURN_TOLERANCE_RAD: f64 = 0.015;
/// Deceleration towards the end of a straight drive \[m/s^2\]. Source: ours, below the limit of a Kobuki.
const DECELERATION_M_S2: f64 = 0.3;
/// Lowest speed before the end of a straight drive \[m/s\]. Source: ours.
const MIN_SPEED_M_S: f64 = 0.03;
/// Remaining distance at which a straight drive is done \[m\]. Source: ours.
const DISTANCE_TOLERANCE_M: f64 = 0.005;
/// Turn rate per heading error of a straight drive \[1/s\]. Source: the gain of the positioner's straight moves.
const HEADING_GAIN: f64 = 1.5;
/// Largest turn rate of a straight drive \[rad/s\]. Source: ours.
const MAX_HEADING_RATE_RAD_S: f64 = 0.1;
/// Time of a stop by the safety monitor after which the motion is abandoned \[s\]. Source: ours.
const BLOCKED_TIME_S: f64 = 5.0;

/// Carries out one relative motion.
#[derive(Debug, Clone, Default)]
pub(crate) struct RelativeMotionDrive {
    start: Option<Pose2>,
    heading: f64,
    turned: f64,
    stopped_since: Option<Stamp>,
}

impl RelativeMotionDrive {
    /// The command; `None` if the motion is done.
    pub(crate) fn step(&mut self, motion: RelativeMotion, pose: Pose2) -> Option<Twist2> {
        if self.start.is_none() {
            self.heading = pose.theta;
        }
        let start = *self.start.get_or_insert(pose);
        match motion {
            RelativeMotion::Turn { angle } => self.turn(angle, pose),
            RelativeMotion::Straight { distance, speed } => straight(start, distance, speed, pose),
        }
    }

    /// What is left of the motion \[m\], a turn as the way of a point at `radius` \[m\].
    pub(crate) fn rest(&self, motion: RelativeMotion, pose: Pose2, radius: f64) -> f64 {
        match (motion, self.start) {
            (RelativeMotion::Turn { angle }, _) => radius * (angle - self.turned).abs(),
            (RelativeMotion::Straight { distance, .. }, None) => distance.abs(),
            (RelativeMotion::Straight { distance, .. }, Some(start)) => {
                (distance - (start.inverse() * pose).x).abs()
            }
        }
    }

    /// Whether the safety monitor has stopped the motion for too long.
    pub(crate) fn is_blocked(&mut self, is_stopped: bool, now: Stamp) -> bool {
        if !is_stopped {
            self.stopped_since = None;
            return false;
        }
        now - *self.stopped_since.get_or_insert(now) > BLOCKED_TIME_S
    }

    fn turn(&mut self, angle: f64, pose: Pose2) -> Option<Twist2> {
        self.turned += difference_of_angles(pose.theta, self.heading);
        self.heading = pose.theta;
        let left = angle - self.turned;
        let rate = (TURN_GAIN * left.abs()).clamp(MIN_TURN_RATE_RAD_S, SPIN_RATE_RAD_S);
        (left.abs() > TURN_TOLERANCE_RAD).then(|| Twist2::new(0.0, rate.copysign(left)))
    }
}

fn straight(start: Pose2, distance: f64, speed: f64, pose: Pose2) -> Option<Twist2> {
    let driven = (start.inverse() * pose).x;
    let left = distance - driven;
    // A robot beyond the end does not return.
    let is_done = left.abs() <= DISTANCE_TOLERANCE_M || left * distance <= 0.0;
    let v = speed.min((2.0 * DECELERATION_M_S2 * left.abs()).sqrt()).max(MIN_SPEED_M_S.min(speed));
    let off = difference_of_angles(start.theta, pose.theta);
    let omega = (HEADING_GAIN * off).clamp(-MAX_HEADING_RATE_RAD_S, MAX_HEADING_RATE_RAD_S);
    (!is_done).then(|| Twist2::new(v.copysign(distance), omega))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Follows the commands without delay; the end and the time \[s\].
    fn drive(motion: RelativeMotion) -> (Pose2, f64) {
        let (mut drive, mut pose, mut time) =
            (RelativeMotionDrive::default(), Pose2::new(1.0, 2.0, 0.5), 0.0);
        while let Some(twist) = drive.step(motion, pose) {
            pose = pose.advance(twist, 0.02);
            time += 0.02;
            assert!(time < 100.0, "{motion:?} does not end: {pose:?}");
        }
        (pose, time)
    }

    #[test]
    fn a_turn_ends_at_its_angle_to_either_side_and_over_a_whole_revolution() {
        for angle in [0.3, -1.57, 3.5, -7.0, 0.0] {
            let (end, time) = drive(RelativeMotion::Turn { angle });
            assert!(difference_of_angles(end.theta, 0.5 + angle).abs() < 0.03, "{angle}: {end:?}");
            assert!(time >= angle.abs() / SPIN_RATE_RAD_S - 0.1, "{angle}: {time} s");
            assert_eq!(end.position(), Pose2::new(1.0, 2.0, 0.0).position());
        }
    }

    #[test]
    fn a_straight_drive_ends_at_its_distance_ahead_and_back() {
        for distance in [0.5, -0.3, 2.0] {
            let (end, time) = drive(RelativeMotion::Straight { distance, speed: 0.2 });
            let relative = Pose2::new(1.0, 2.0, 0.5).inverse() * end;
            assert!((relative.x - distance).abs() < 0.007 && relative.y.abs() < 1e-6, "{relative:?}");
            assert!(time >= distance.abs() / 0.2 - 0.1, "{distance}: {time} s");
        }
    }

    #[test]
    fn a_motion_that_safety_stops_is_given_up_after_five_seconds_in_a_row() {
        let mut drive = RelativeMotionDrive::default();
        let at = |s: f64| Stamp::default().after(s);
        assert!(!drive.is_blocked(true, at(0.0)) && !drive.is_blocked(true, at(4.9)));
        assert!(!drive.is_blocked(false, at(5.0)) && !drive.is_blocked(true, at(5.1)));
        assert!(!drive.is_blocked(true, at(10.0)) && drive.is_blocked(true, at(10.2)));
    }
}
