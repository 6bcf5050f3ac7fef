use crate::planar::{carried, symmetric};
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
    /// Added to the covariance first: what the belief had better not been so sure of.
    pub(crate) doubt: Matrix3<f64>,
    /// What its frame is known to: measurements in one frame, however many, make no belief surer than that.
    pub(crate) frame: Vector3<f64>,
}

impl Belief {
    /// The larger of the variances of the position's coordinates, m^2.
    pub(crate) fn position_variance(&self) -> f64 {
        self.covariance[(0, 0)].max(self.covariance[(1, 1)])
    }

    /// After a motion with this noise.
    pub(crate) fn moved(&self, motion: &Pose2, noise: &Matrix3<f64>) -> Self {
        Self { pose: self.pose * *motion, covariance: carried(&self.covariance, motion) + noise }
    }

    /// What the measurement says that the belief does not, and its Mahalanobis distance.
    pub(crate) fn innovation(&self, measurement: &Measurement) -> (Vector3<f64>, f64) {
        let innovation = (self.pose.inverse() * measurement.pose).log();
        let spread = symmetric(self.covariance + measurement.noise);
        let squared = spread.cholesky().map_or(f64::INFINITY, |c| innovation.dot(&c.solve(&innovation)));
        (innovation, squared.sqrt())
    }

    /// The Kalman update on SE(2), in Joseph's form; variances stay at `least` or above.
    pub(crate) fn corrected(&self, measurement: &Measurement, least: &Vector3<f64>) -> Self {
        let prior = symmetric(self.covariance + measurement.doubt);
        let Some(spread) = symmetric(prior + measurement.noise).cholesky() else { return *self };
        let gain = spread.solve(&prior).transpose();
        let (innovation, _) = self.innovation(measurement);
        let rest = Matrix3::identity() - gain;
        let covariance = rest * prior * rest.transpose() + gain * measurement.noise * gain.transpose();
        let floor = least.sup(&measurement.frame.inf(&prior.diagonal()));
        let lacking = (floor - covariance.diagonal()).sup(&Vector3::zeros());
        Self {
            pose: self.pose * Pose2::exp(gain * innovation),
            covariance: symmetric(covariance) + Matrix3::from_diagonal(&lacking),
        }
    }
}
