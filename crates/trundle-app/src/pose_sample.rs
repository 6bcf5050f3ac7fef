//! An estimated pose beside the true one, with the uncertainty that the robot claimed.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use trundle_core::{Pose2, PoseBound, PoseEstimate};

/// Normalised squared error that 99.73 % of the samples of a consistent pose keep, as three standard deviations of one quantity. Source:
/// chi-square, 3 degrees of freedom.
const THREE_SIGMA_NEES: f64 = 14.156;

/// An estimated pose and the true one at the same time, map frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PoseSample {
    /// Seconds since the first event.
    pub at_s: f64,
    /// The estimated pose.
    pub estimate: Pose2,
    /// The true pose.
    pub truth: Pose2,
    /// Bound of the estimate's error with a probability of 95 %, by the robot's covariance.
    pub bound: PoseBound,
    /// Normalised squared error of the estimate (NEES), 3 degrees of freedom; `None` for a singular covariance.
    pub nees: Option<f64>,
}

impl PoseSample {
    /// Compares an estimate with the truth.
    pub fn new(at_s: f64, estimate: &PoseEstimate, truth: Pose2) -> Self {
        let (pose, bound) = (estimate.pose, estimate.bound_95());
        Self { at_s, estimate: pose, truth, bound, nees: nees(estimate, truth) }
    }

    /// Whether the estimate is off by more than three of its standard deviations.
    pub fn is_overconfident(&self) -> bool {
        self.nees.is_some_and(|square| square > THREE_SIGMA_NEES)
    }

    /// Distance of the estimated position from the true one, m.
    pub fn distance(&self) -> f64 {
        self.estimate.distance(&self.truth)
    }
}

/// The squared error of an estimate over its covariance. The covariance is that of a right perturbation.
fn nees(estimate: &PoseEstimate, truth: Pose2) -> Option<f64> {
    let error = estimate.pose.inverse() * truth;
    let error = Vector3::new(error.x, error.y, error.theta);
    let solved = estimate.covariance.cholesky()?.solve(&error);
    Some(error.dot(&solved)).filter(|square| square.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;
    use trundle_core::{Stamp, Twist2};

    fn sample(covariance: Matrix3<f64>) -> PoseSample {
        let pose = Pose2::new(1.0, 2.0, std::f64::consts::FRAC_PI_2);
        let estimate = PoseEstimate { stamp: Stamp::default(), pose, twist: Twist2::ZERO, covariance };
        PoseSample::new(0.5, &estimate, Pose2::new(1.0, 2.3, std::f64::consts::FRAC_PI_2 + 0.1))
    }

    #[test]
    fn the_error_is_measured_in_the_frame_of_the_base() {
        // The robot faces along y: an error along y is an error along its own x axis.
        let found = sample(Matrix3::from_diagonal(&Vector3::new(0.01, 1e-6, 0.01)));
        assert!((found.nees.unwrap() - (0.09 / 0.01 + 0.01 / 0.01)).abs() < 1e-9, "{found:?}");
        assert!((found.distance() - 0.3).abs() < 1e-12);
        assert!(!found.is_overconfident());
        assert!(sample(Matrix3::from_diagonal_element(0.005)).is_overconfident());
    }

    #[test]
    fn a_covariance_without_inverse_gives_no_normalised_error() {
        assert_eq!(sample(Matrix3::zeros()).nees, None);
    }
}
