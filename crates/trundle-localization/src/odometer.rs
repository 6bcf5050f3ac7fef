use crate::planar::{carried, without_negative_variances};
use nalgebra::Matrix3;
use trundle_core::{Odometry, Pose2};

/// Where the odometry had the base at a moment, and how uncertain that had become since the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Odometer {
    /// `odom_from_base`.
    pub pose: Pose2,
    /// Of `pose` as a right perturbation (x m, y m, theta rad).
    pub covariance: Matrix3<f64>,
}

impl Odometer {
    /// The motion from `earlier` to here, and its covariance as a right perturbation.
    pub fn since(&self, earlier: &Self) -> (Pose2, Matrix3<f64>) {
        let motion = earlier.pose.inverse() * self.pose;
        let noise = self.covariance - carried(&earlier.covariance, &motion);
        (motion, without_negative_variances(noise))
    }

    /// Part of the way from here to `later`.
    pub(crate) fn towards(&self, later: &Self, fraction: f64) -> Self {
        let (motion, noise) = later.since(self);
        let part = Pose2::exp(motion.log() * fraction);
        Self { pose: self.pose * part, covariance: carried(&self.covariance, &part) + noise * fraction }
    }
}

impl From<&Odometry> for Odometer {
    fn from(odometry: &Odometry) -> Self {
        Self { pose: odometry.pose, covariance: odometry.covariance }
    }
}
