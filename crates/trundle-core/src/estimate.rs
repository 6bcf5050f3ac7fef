//! The pose estimate that planning and control use: stamp, pose, twist and covariance.

use crate::{Pose2, Stamp, Twist2};
use nalgebra::Matrix3;

/// The one pose estimate that planning and control use.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseEstimate {
    /// Time of the estimate.
    pub stamp: Stamp,
    /// `map_from_base`.
    pub pose: Pose2,
    /// The base's twist.
    pub twist: Twist2,
    /// Covariance of `pose` as a right perturbation: x m, y m, theta rad.
    pub covariance: Matrix3<f64>,
}
