//! Largest speeds of a camera and of a robot.

use trundle_core::Pose3;

/// Fastest translation of a camera without a motion prior: 2 m/s, a brisk walk. A faster motion is refused. Source: ours.
const MAX_CAMERA_SPEED_M_S: f64 = 2.0;
/// Fastest rotation of a camera without a motion prior: 3.5 rad/s (200 deg/s). A faster motion is refused. Source: ours.
const MAX_CAMERA_TURN_RATE_RAD_S: f64 = 3.5;
/// Fastest translation of a motion prior: 10 m/s. A faster prior is an odometry that jumped, and is dropped. Source: ours.
const MAX_PRIOR_SPEED_M_S: f64 = 10.0;
/// Fastest rotation of a motion prior: 20 rad/s. A faster prior is dropped. Source: ours.
const MAX_PRIOR_TURN_RATE_RAD_S: f64 = 20.0;

/// Upper bounds of translation and rotation per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MotionLimits {
    /// Upper bound of the speed, m/s.
    speed: f64,
    /// Upper bound of the turn rate, rad/s.
    turn_rate: f64,
}

impl MotionLimits {
    /// For a camera without a measured motion.
    pub const CAMERA: Self = Self { speed: MAX_CAMERA_SPEED_M_S, turn_rate: MAX_CAMERA_TURN_RATE_RAD_S };
    /// For a motion prior by wheels and gyro.
    pub const PRIOR: Self = Self { speed: MAX_PRIOR_SPEED_M_S, turn_rate: MAX_PRIOR_TURN_RATE_RAD_S };

    /// Whether a motion is possible within a time (s), with a tolerance (m and rad).
    pub fn allow(self, motion: Pose3, tolerance: f64, seconds: f64) -> bool {
        motion.translation.norm() <= tolerance + self.speed * seconds
            && motion.angle() <= tolerance + self.turn_rate * seconds
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;

    #[test]
    fn a_motion_is_possible_up_to_the_limit_and_the_tolerance() {
        let step = |x: f64, turn: f64| Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, turn, 0.0));
        assert!(MotionLimits::CAMERA.allow(step(2.2, 0.0), 0.3, 1.0));
        assert!(!MotionLimits::CAMERA.allow(step(2.4, 0.0), 0.3, 1.0), "too far");
        assert!(!MotionLimits::CAMERA.allow(step(0.0, 0.4), 0.3, 0.0), "turned in no time");
        assert!(MotionLimits::PRIOR.allow(step(9.0, 0.0), 0.2, 1.0));
    }
}
