//! The error of a pose in the robot's frame.

use trundle_core::{Hypotenuse, Pose2, difference_of_angles};

/// The reference in the robot's frame: (e_x, e_y, e_theta) of A6.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrackingError {
    /// Ahead of the robot, m.
    pub along: f64,
    /// Cross-track error, m, positive to the robot's left.
    pub cross: f64,
    /// Counter-clockwise of the robot's heading, rad, in (-pi, pi].
    pub heading: f64,
}

impl TrackingError {
    /// Error of a robot at `pose` with its reference at `reference`, both in one frame.
    pub fn between(pose: Pose2, reference: Pose2) -> Self {
        let (s, c) = pose.theta.sin_cos();
        let gap = reference.position() - pose.position();
        Self {
            along: c * gap.x + s * gap.y,
            cross: c * gap.y - s * gap.x,
            heading: difference_of_angles(reference.theta, pose.theta),
        }
    }

    /// The distance, m.
    pub fn distance(&self) -> f64 {
        self.along.hypotenuse(self.cross)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_error_is_in_the_robots_frame() {
        let robot = Pose2::new(1.0, 1.0, FRAC_PI_2);
        let error = TrackingError::between(robot, Pose2::new(0.5, 1.2, 0.0));
        assert!((error.along - 0.2).abs() < 1e-12);
        assert!((error.cross - 0.5).abs() < 1e-12);
        assert!((error.heading + FRAC_PI_2).abs() < 1e-12);
    }
}
