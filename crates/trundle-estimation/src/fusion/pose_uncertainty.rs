//! Uncertainty of a pose: an independent part, and the part that follows from the scale of the turns.

use crate::planar::symmetric;
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// Uncertainty of a pose as a right perturbation (x m, y m, theta rad).
///
/// The gyro's scale is constant during a turn, so its error adds up along the turn: after an angle `a` the standard deviation of the heading is
/// `a` times that of the scale. A map that is drawn during the turn has the same error. This part is therefore a displacement, not a
/// covariance: a match with that map does not reduce it, and a match with an older part of the map does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PoseUncertainty {
    /// Covariance without the error of the scale.
    pub covariance: Matrix3<f64>,
    /// Displacement of the pose if the scale of the turns is one standard deviation off (m, m, rad).
    pub scale_error: Vector3<f64>,
}

impl PoseUncertainty {
    /// The covariance of both parts.
    pub fn total(&self) -> Matrix3<f64> {
        self.covariance + self.scale_error * self.scale_error.transpose()
    }

    /// The uncertainty of a pose in the map as that of the map frame: a displacement `exp(e) * pose`.
    pub(crate) fn in_map(&self, pose: &Pose2) -> Self {
        self.transformed(&pose.adjoint())
    }

    /// The inverse of [`PoseUncertainty::in_map`]; also the uncertainty after the motion `pose`, without its own noise.
    pub(crate) fn at_pose(&self, pose: &Pose2) -> Self {
        self.transformed(&pose.inverse().adjoint())
    }

    fn transformed(&self, by: &Matrix3<f64>) -> Self {
        let covariance = symmetric(by * self.covariance * by.transpose());
        Self { covariance, scale_error: by * self.scale_error }
    }
}
