//! The motion over several frames by odometry, with its covariance.

use nalgebra::Matrix6;
use trundle_core::{CameraMotion, Pose3};

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
        let moved = backward * (self.covariance + CameraMotion::mast_sway()) * backward.transpose();
        let information = ((moved + moved.transpose()) * 0.5).cholesky()?.inverse();
        information.iter().all(|value| value.is_finite()).then_some(information)
    }
}
