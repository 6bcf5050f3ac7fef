use std::f64::consts::TAU;
use trundle_core::{Pose2, Twist2, wrap_angle};

/// Turning on the spot to see what is around.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LookAround {
    last: Option<f64>,
    turned: f64,
}

/// Turn rate, rad/s: slow enough for features to be tracked.
const RATE: f64 = 0.6;
/// So many turns see everything twice.
const TURNS: f64 = 2.0;

impl LookAround {
    /// The command, and a note of how far it has turned.
    pub(crate) fn twist(&mut self, pose: Pose2) -> Twist2 {
        let last = self.last.replace(pose.theta).unwrap_or(pose.theta);
        self.turned += wrap_angle(pose.theta - last).abs();
        Twist2::new(0.0, RATE)
    }

    /// Whether everything around has been seen; the next look begins anew.
    pub(crate) fn is_over(&mut self, pose: Pose2) -> bool {
        let over = self.turned > TURNS * TAU;
        if over {
            *self = Self { last: Some(pose.theta), turned: 0.0 };
        }
        over
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_turns_are_enough() {
        let mut look = LookAround::default();
        let mut steps = 0;
        while !look.is_over(Pose2::IDENTITY) {
            assert_eq!(look.twist(Pose2::new(0.0, 0.0, 0.1 * f64::from(steps))).v, 0.0);
            steps += 1;
        }
        assert!((f64::from(steps) * 0.1 - 2.0 * TAU).abs() < 0.3, "{steps} steps");
    }
}
