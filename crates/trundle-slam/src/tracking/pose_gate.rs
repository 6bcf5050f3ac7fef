//! Gate of a camera's pose around its prediction.

use crate::motion::motion_limits::MotionLimits;
use nalgebra::Matrix6;
use trundle_core::Pose3;

/// Largest chi-square (six degrees of freedom) of a pose against the prediction: 37, the probability of five standard deviations of one
/// variable. A pose beyond it is refused. Source: ours.
const MAX_CHI2: f64 = 37.0;
/// Standard deviation of a prediction besides its covariance: 0.1 m and 0.1 rad. Source: ours.
const MIN_PREDICTION_SIGMA: f64 = 0.1;
/// Error of a prediction without odometry besides the camera's largest motion: 0.3 m and 0.3 rad. Source: ours.
const PREDICTION_TOLERANCE: f64 = 0.3;

/// Longest time without odometry after which a place near the prediction needs no large part of the view: 2.5 s. A camera in a hand rarely
/// reaches another room in that time. Source: ours, for bursts of dropped images of up to 2 s.
const MAX_BRIEF_GAP_S: f64 = 2.5;

/// Possible poses of a camera since it was last located.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PoseGate {
    /// All poses: the camera's pose is unknown.
    Open,
    /// Poses within the covariance of the prediction: odometry measured the motion.
    Covariance,
    /// Poses that the camera can reach in a time, s.
    Elapsed(f64),
}

impl PoseGate {
    /// Whether the gate is the reach of a camera over a time so brief that look-alike places are outside it.
    pub fn is_brief(self) -> bool {
        matches!(self, Self::Elapsed(seconds) if seconds <= MAX_BRIEF_GAP_S)
    }

    /// Whether a camera predicted at `predicted` with this covariance can be at `pose`.
    pub fn allows(self, pose: Pose3, predicted: Pose3, covariance: &Matrix6<f64>) -> bool {
        let error = predicted.inverse() * pose;
        match self {
            Self::Open => true,
            Self::Covariance => is_within(covariance, error),
            Self::Elapsed(seconds) => MotionLimits::CAMERA.allow(error, PREDICTION_TOLERANCE, seconds),
        }
    }
}

/// Whether an error is likely under a covariance, by its chi-square.
fn is_within(covariance: &Matrix6<f64>, error: Pose3) -> bool {
    let tangent = error.log();
    let covariance = covariance + Matrix6::identity() * MIN_PREDICTION_SIGMA.powi(2);
    let information = covariance.try_inverse();
    information.is_some_and(|information| tangent.dot(&(information * tangent)) <= MAX_CHI2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;

    #[test]
    fn each_gate_allows_what_can_be() {
        let (here, exact) = (Pose3::identity(), Matrix6::zeros());
        let at = |x: f64| Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, 0.0, 0.0));
        assert!(PoseGate::Open.allows(at(1e6), here, &exact));
        assert!(PoseGate::Covariance.allows(at(0.6), here, &exact), "six standard deviations of 0.1 m");
        assert!(!PoseGate::Covariance.allows(at(0.62), here, &exact));
        assert!(PoseGate::Covariance.allows(at(3.0), here, &Matrix6::identity()));
        assert!(PoseGate::Elapsed(1.0).allows(at(2.2), here, &exact));
        assert!(!PoseGate::Elapsed(0.1).allows(at(2.2), here, &exact));
    }
}
