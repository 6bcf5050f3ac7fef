//! The motion over several frames by odometry, with its covariance.

use nalgebra::{Matrix6, Vector6};
use trundle_core::{CameraMotion, Pose3};

/// Standard deviation of the camera's position on its mast \[m\]. Without it the covariance of a robot at rest is singular.
/// Source: docs/experiments/slam-odometry.md.
const MAST_SWAY_SIGMA_M: f64 = 1e-4;
/// Standard deviation of the camera's rotation on its mast \[rad\]. See [`MAST_SWAY_SIGMA_M`].
const MAST_SWAY_SIGMA_RAD: f64 = 5e-4;

/// Motion of the camera over some frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OdometryPath {
    /// `first_camera_from_last_camera`.
    pub(super) motion: Pose3,
    /// Covariance of `motion` as a right perturbation (m, m, m, rad, rad, rad).
    covariance: Matrix6<f64>,
}

impl OdometryPath {
    /// The composition of these steps; `None` if one was not measured, or has no covariance.
    pub(super) fn over(steps: impl IntoIterator<Item = Option<CameraMotion>>) -> Option<Self> {
        let start = Self { motion: Pose3::identity(), covariance: Matrix6::zeros() };
        steps.into_iter().try_fold(start, |path, step| path.then(&step?))
    }

    fn then(&self, step: &CameraMotion) -> Option<Self> {
        let backward = step.motion.inverse().adjoint();
        let covariance = backward * self.covariance * backward.transpose() + step.covariance?;
        let motion = (self.motion * step.motion).renormalized();
        (step.is_finite() && motion.is_finite()).then_some(Self { motion, covariance })
    }

    /// Inverse covariance of `motion` with the sway of the mast; `None` if it is not finite.
    pub(super) fn information(&self) -> Option<Matrix6<f64>> {
        self.information_at(Pose3::identity())
    }

    /// Inverse covariance of `first_camera_from_there`, with `there` at `last_camera_from_there` exactly.
    pub(super) fn information_at(&self, last_camera_from_there: Pose3) -> Option<Matrix6<f64>> {
        let backward = last_camera_from_there.inverse().adjoint();
        let moved = backward * (self.covariance + sway()) * backward.transpose();
        let information = ((moved + moved.transpose()) * 0.5).cholesky()?.inverse();
        information.iter().all(|value| value.is_finite()).then_some(information)
    }
}

fn sway() -> Matrix6<f64> {
    let (shift, turn) = (MAST_SWAY_SIGMA_M.powi(2), MAST_SWAY_SIGMA_RAD.powi(2));
    Matrix6::from_diagonal(&Vector6::new(shift, shift, shift, turn, turn, turn))
}
