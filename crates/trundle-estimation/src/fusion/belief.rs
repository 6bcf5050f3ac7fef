//! A Gaussian over planar poses, with its Kalman update.

use crate::planar::{symmetric, transported};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// A Gaussian over poses: `pose * exp(e)` with `e` of zero mean and this covariance (x m, y m, theta rad).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Belief {
    pub(crate) pose: Pose2,
    pub(crate) covariance: Matrix3<f64>,
}

/// A measured pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measurement {
    pub(crate) pose: Pose2,
    pub(crate) noise: Matrix3<f64>,
    /// Added to the prior's covariance before the update.
    pub(crate) prior_inflation: Matrix3<f64>,
    /// Variances of the measurement's frame: a lower bound of the belief's variances after measurements in that frame.
    pub(crate) variance_floor: Vector3<f64>,
}

impl Belief {
    /// The larger of the variances of x and y, m^2.
    pub(crate) fn position_variance(&self) -> f64 {
        self.covariance[(0, 0)].max(self.covariance[(1, 1)])
    }

    /// The belief after a motion with this noise.
    pub(crate) fn moved(&self, motion: &Pose2, noise: &Matrix3<f64>) -> Self {
        Self { pose: self.pose * *motion, covariance: transported(&self.covariance, motion) + noise }
    }

    /// The innovation of a measurement and its Mahalanobis distance.
    pub(crate) fn innovation(&self, measurement: &Measurement) -> (Vector3<f64>, f64) {
        let innovation = (self.pose.inverse() * measurement.pose).log();
        let spread = symmetric(self.covariance + measurement.noise);
        let squared = spread.cholesky().map_or(f64::INFINITY, |c| innovation.dot(&c.solve(&innovation)));
        (innovation, squared.sqrt())
    }

    /// The Kalman update on SE(2), in Joseph's form. No variance falls below `min_variances`.
    pub(crate) fn corrected(&self, measurement: &Measurement, min_variances: &Vector3<f64>) -> Self {
        let prior = symmetric(self.covariance + measurement.prior_inflation);
        let Some(spread) = symmetric(prior + measurement.noise).cholesky() else { return *self };
        let gain = spread.solve(&prior).transpose();
        let (innovation, _) = self.innovation(measurement);
        let rest = Matrix3::identity() - gain;
        let covariance = rest * prior * rest.transpose() + gain * measurement.noise * gain.transpose();
        let floor = min_variances.sup(&measurement.variance_floor.inf(&prior.diagonal()));
        let lacking = (floor - covariance.diagonal()).sup(&Vector3::zeros());
        Self {
            pose: self.pose * Pose2::exp(gain * innovation),
            covariance: symmetric(covariance) + Matrix3::from_diagonal(&lacking),
        }
    }
}
