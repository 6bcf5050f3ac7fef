//! Pose and covariance of the odometry at one stamp.

use crate::planar::{transported, without_negative_variances};
use nalgebra::Matrix3;
use trundle_core::{Odometry, Pose2};

/// Pose of the base by the odometry at one stamp, with the covariance accumulated since the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OdometryState {
    /// `odom_from_base`.
    pub pose: Pose2,
    /// Covariance of `pose` as a right perturbation (x m, y m, theta rad).
    pub covariance: Matrix3<f64>,
}

impl OdometryState {
    /// The motion from `earlier` to here, and its covariance as a right perturbation.
    pub fn since(&self, earlier: &Self) -> (Pose2, Matrix3<f64>) {
        let motion = earlier.pose.inverse() * self.pose;
        let noise = self.covariance - transported(&earlier.covariance, &motion);
        (motion, without_negative_variances(noise))
    }

    /// The state at a fraction of the motion from here to `later`.
    pub(crate) fn towards(&self, later: &Self, fraction: f64) -> Self {
        let (motion, noise) = later.since(self);
        let part = Pose2::exp(motion.log() * fraction);
        Self { pose: self.pose * part, covariance: transported(&self.covariance, &part) + noise * fraction }
    }
}

impl From<&Odometry> for OdometryState {
    fn from(odometry: &Odometry) -> Self {
        Self { pose: odometry.pose, covariance: odometry.covariance }
    }
}
