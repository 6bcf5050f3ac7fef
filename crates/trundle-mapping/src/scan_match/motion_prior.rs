//! Gaussian prior of a pose.

use nalgebra::{Matrix3, Vector3};
use trundle_core::{Pose2, wrap_angle};

/// Pose of the particle by the odometry: cells, rad, map frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MotionPrior {
    pub(crate) guess: Pose2,
    pub(crate) covariance: Matrix3<f64>,
    pub(crate) information: Matrix3<f64>,
    /// ln of the determinant of the information.
    pub(crate) log_determinant: f64,
}

impl MotionPrior {
    /// The prior of a motion that began at `heading`, with this covariance in the base's frame.
    pub(crate) fn new(guess: Pose2, heading: f64, covariance: &Matrix3<f64>) -> Self {
        let (s, c) = heading.sin_cos();
        let turn = Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
        Self::with(guess, turn * covariance * turn.transpose())
    }

    /// The prior with this covariance, cells and rad, map frame.
    pub(crate) fn with(guess: Pose2, covariance: Matrix3<f64>) -> Self {
        let information =
            covariance.try_inverse().expect("invariant: the least sigmas of the odometry are positive");
        Self { guess, covariance, information, log_determinant: -covariance.determinant().ln() }
    }

    /// The product with another Gaussian (cells, rad, map frame) with an independent error.
    pub(crate) fn fused(self, pose: Pose2, covariance: &Matrix3<f64>) -> Self {
        let other = covariance.try_inverse().expect("invariant: a positive covariance");
        let both = (self.information + other).try_inverse().expect("invariant: a sum of positive matrices");
        let (guess, turn) = (self.guess, wrap_angle(pose.theta - self.guess.theta));
        let step = both * other * Vector3::new(pose.x - guess.x, pose.y - guess.y, turn);
        Self::with(Pose2::new(guess.x + step.x, guess.y + step.y, guess.theta + step.z), both)
    }

    /// The prior of a robot with failed odometry: near the line from `before` to `guess`, with sigmas `shift` (cells) and `turn` (rad).
    pub(crate) fn slipped(before: Pose2, guess: Pose2, shift: f64, turn: f64) -> Self {
        let distance = (guess.position() - before.position()).norm();
        let turned = wrap_angle(guess.theta - before.theta).abs();
        let (shift, turn) = (shift + 0.5 * distance, turn + 0.5 * turned);
        let sigma = Vector3::new(shift, shift, turn);
        Self::with(before.interpolate(&guess, 0.5), Matrix3::from_diagonal(&sigma.component_mul(&sigma)))
    }
}
