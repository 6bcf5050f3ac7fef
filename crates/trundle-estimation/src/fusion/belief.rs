//! A Gaussian over planar poses, with its Kalman update.

use crate::fusion::pose_uncertainty::PoseUncertainty;
use crate::planar::symmetric;
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// A Gaussian over poses: `pose * exp(e)` with `e` of zero mean and this uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Belief {
    pub(crate) pose: Pose2,
    pub(crate) uncertainty: PoseUncertainty,
}

/// A motion by odometry.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    pub(crate) pose: Pose2,
    /// Covariance, right perturbation.
    pub(crate) noise: Matrix3<f64>,
    /// Standard deviation of the scale of its turn.
    pub(crate) scale_sigma: f64,
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
    /// Displacement of the measurement's frame at the pose if the scale of the turns is one standard deviation off.
    pub(crate) scale_error: Vector3<f64>,
}

impl Belief {
    /// A belief without an error of the scale.
    pub(crate) fn new(pose: Pose2, covariance: Matrix3<f64>) -> Self {
        Self { pose, uncertainty: PoseUncertainty { covariance, scale_error: Vector3::zeros() } }
    }

    /// The covariance, with the error of the scale.
    pub(crate) fn covariance(&self) -> Matrix3<f64> {
        self.uncertainty.total()
    }

    /// The larger of the variances of x and y, m^2.
    pub(crate) fn position_variance(&self) -> f64 {
        let covariance = self.covariance();
        covariance[(0, 0)].max(covariance[(1, 1)])
    }

    /// The belief after a motion.
    pub(crate) fn moved(&self, motion: &Motion) -> Self {
        let mut uncertainty = self.uncertainty.at_pose(&motion.pose);
        uncertainty.covariance += motion.noise;
        uncertainty.scale_error.z += motion.pose.theta * motion.scale_sigma;
        Self { pose: self.pose * motion.pose, uncertainty }
    }

    /// Covariance of the belief relative to a measurement's frame.
    fn relative_to(&self, measurement: &Measurement) -> Matrix3<f64> {
        let PoseUncertainty { covariance, scale_error } = self.uncertainty;
        let scale_error = scale_error - measurement.scale_error;
        PoseUncertainty { covariance, scale_error }.total()
    }

    /// The innovation of a measurement and its Mahalanobis distance.
    pub(crate) fn innovation(&self, measurement: &Measurement) -> (Vector3<f64>, f64) {
        let innovation = (self.pose.inverse() * measurement.pose).log();
        let spread = symmetric(self.relative_to(measurement) + measurement.noise);
        let squared = spread.cholesky().map_or(f64::INFINITY, |c| innovation.dot(&c.solve(&innovation)));
        (innovation, squared.sqrt())
    }

    /// The Kalman update on SE(2), in Joseph's form. No variance falls below `min_variances`.
    pub(crate) fn corrected(&self, measurement: &Measurement, min_variances: &Vector3<f64>) -> Self {
        let relative = symmetric(self.relative_to(measurement) + measurement.prior_inflation);
        let Some(spread) = symmetric(relative + measurement.noise).cholesky() else { return *self };
        let gain = spread.solve(&relative).transpose();
        let (innovation, _) = self.innovation(measurement);
        let rest = Matrix3::identity() - gain;
        let prior = symmetric(self.uncertainty.covariance + measurement.prior_inflation);
        let covariance = rest * prior * rest.transpose() + gain * measurement.noise * gain.transpose();
        let prior_total = self.covariance() + measurement.prior_inflation;
        let floor = min_variances.sup(&measurement.variance_floor.inf(&prior_total.diagonal()));
        let scale_error = rest * self.uncertainty.scale_error + gain * measurement.scale_error;
        let mut uncertainty = PoseUncertainty { covariance: symmetric(covariance), scale_error };
        let lacking = (floor - uncertainty.total().diagonal()).sup(&Vector3::zeros());
        uncertainty.covariance += Matrix3::from_diagonal(&lacking);
        Self { pose: self.pose * Pose2::exp(gain * innovation), uncertainty }
    }
}
