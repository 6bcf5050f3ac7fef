use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// What the odometry says of where the particle is: cells, rad, map frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prior {
    pub(super) guess: Pose2,
    pub(super) covariance: Matrix3<f64>,
    pub(super) information: Matrix3<f64>,
    /// ln of the determinant of the information.
    pub(super) log_determinant: f64,
}

impl Prior {
    /// Of a motion with this covariance in the base's frame, begun at `heading`.
    pub(super) fn new(guess: Pose2, heading: f64, covariance: &Matrix3<f64>) -> Self {
        let (s, c) = heading.sin_cos();
        let turn = Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
        Self::with(guess, turn * covariance * turn.transpose())
    }

    fn with(guess: Pose2, covariance: Matrix3<f64>) -> Self {
        let information =
            covariance.try_inverse().expect("invariant: the least sigmas of the odometry are positive");
        Self { guess, covariance, information, log_determinant: -covariance.determinant().ln() }
    }

    /// With a slip of one sigma `shift` (cells) and `turn` (rad) on top.
    pub(super) fn widened(&self, shift: f64, turn: f64) -> Self {
        let slip = Vector3::new(shift * shift, shift * shift, turn * turn);
        Self::with(self.guess, self.covariance + Matrix3::from_diagonal(&slip))
    }

    /// Of a robot whose wheels slipped: about `place` by some 0.4 m and 0.5 rad.
    pub(super) fn slipped(place: Pose2, resolution: f64) -> Self {
        let sigma = Vector3::new(0.4 / resolution, 0.4 / resolution, 0.5);
        Self::with(place, Matrix3::from_diagonal(&sigma.component_mul(&sigma)))
    }

    /// Of a robot that was turned any way.
    pub(super) fn turned(place: Pose2, resolution: f64) -> Self {
        let sigma = Vector3::new(0.4 / resolution, 0.4 / resolution, 1.5);
        Self::with(place, Matrix3::from_diagonal(&sigma.component_mul(&sigma)))
    }
}
