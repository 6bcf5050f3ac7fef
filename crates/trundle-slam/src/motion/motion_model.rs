//! Uncertainty of the camera's motion between located images.

use crate::motion::uncertain_pose::of_sigmas;
use nalgebra::Matrix6;
use serde::{Deserialize, Serialize};
use trundle_core::{CameraMotion, Hypotenuse, Invalid, PinholeCamera, Pose3, require_in};

/// Growth of a pose's uncertainty without located images.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct MotionModelConfig {
    /// Standard deviation of a motion prior after a motion of 1 m, m, and after a rotation of 1 rad, rad, 0 to 1. It grows with the root of
    /// the length, since errors of steps are independent \[Chong97\]. A larger value trusts images more than wheels. Default 0.05: wheels
    /// that slip occasionally.
    pub prior_part: f64,
    /// Standard deviation that a motion prior gains in 1 s: m, and rad, 0 to 1. It grows with the root of the time. Default 0.01 (ours).
    pub prior_drift: f64,
    /// Standard deviation of the speed of a camera without a prior, m/s, and of its turn rate, rad/s, 0 to 100. Default 1 (ours).
    pub unseen: f64,
    /// Readout time of a camera that has none of its own, s, 0 to 0.05. Deprecated: set the camera's readout time
    /// ([`PinholeCamera::with_readout`]). Default 0: a global shutter.
    #[serde(skip_serializing_if = "is_zero")]
    pub readout: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Default for MotionModelConfig {
    fn default() -> Self {
        Self { prior_part: 0.05, prior_drift: 0.01, unseen: 1.0, readout: 0.0 }
    }
}

impl MotionModelConfig {
    /// Standard deviations of a motion prior's translation (m) and rotation (rad) over a time, s.
    pub fn sigmas(&self, motion: Pose3, seconds: f64) -> (f64, f64) {
        let drift = self.prior_drift * seconds.sqrt();
        let grown = |length: f64| (self.prior_part * length.sqrt()).hypotenuse(drift);
        (grown(motion.translation.norm()), grown(motion.angle()))
    }

    /// The covariance of a motion prior over a time, s: its own, if that is a valid one, else by these settings.
    pub(crate) fn covariance_of(&self, prior: &CameraMotion, seconds: f64) -> Matrix6<f64> {
        prior.covariance.filter(is_covariance).unwrap_or_else(|| {
            let (translation_sigma, rotation_sigma) = self.sigmas(prior.motion, seconds);
            of_sigmas(translation_sigma, rotation_sigma)
        })
    }

    /// The camera, with the deprecated readout time if it has none of its own.
    pub(crate) fn with_readout_of(&self, camera: PinholeCamera) -> Result<PinholeCamera, Invalid> {
        if camera.readout() == 0.0 { camera.with_readout(self.readout) } else { Ok(camera) }
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("motion.prior_part", self.prior_part, "m", 0.0, 1.0)?;
        require_in("motion.prior_drift", self.prior_drift, "m", 0.0, 1.0)?;
        require_in("motion.unseen", self.unseen, "m/s", 0.0, 100.0)?;
        require_in("motion.readout", self.readout, "s", 0.0, 0.05)?;
        Ok(self)
    }
}

/// Whether a matrix is symmetric without negative variances, up to rounding.
fn is_covariance(matrix: &Matrix6<f64>) -> bool {
    let size = matrix.amax();
    let lifted = matrix + Matrix6::identity() * (1e-9 * size + f64::MIN_POSITIVE);
    (matrix - matrix.transpose()).amax() <= 1e-9 * size && lifted.cholesky().is_some()
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;

    #[test]
    fn the_variance_does_not_depend_on_how_a_motion_is_cut_into_steps() {
        let config = MotionModelConfig::default();
        let ahead = |metres: f64| Pose3::exp(Vector6::new(metres, 0.0, 0.0, 0.0, 0.0, 0.0));
        let (whole, _) = config.sigmas(ahead(1.0), 2.0);
        let (part, _) = config.sigmas(ahead(0.1), 0.2);
        assert!((whole * whole - 10.0 * part * part).abs() < 1e-12);
    }

    #[test]
    fn an_invalid_covariance_is_replaced_by_the_settings() {
        let config = MotionModelConfig::default();
        let step = Pose3::exp(Vector6::repeat(0.01));
        let with = |matrix: Matrix6<f64>| CameraMotion { motion: step, covariance: Some(matrix) };
        let own = config.covariance_of(&step.into(), 0.1);
        let mut lopsided = Matrix6::identity();
        lopsided[(0, 1)] = 0.5;
        for wrong in [
            -Matrix6::identity(),
            lopsided,
            Matrix6::from_diagonal(&Vector6::new(1.0, 1.0, -0.1, 1.0, 1.0, 1.0)),
        ] {
            assert_eq!(config.covariance_of(&with(wrong), 0.1), own);
        }
        let planar = Matrix6::from_diagonal(&Vector6::new(1e-6, 1e-6, 0.0, 0.0, 0.0, 1e-8));
        for right in [planar, Matrix6::zeros()] {
            assert_eq!(config.covariance_of(&with(right), 0.1), right);
        }
    }

    #[test]
    fn the_deprecated_readout_fills_in_for_a_camera_without_one() {
        let config = MotionModelConfig { readout: 0.02, ..MotionModelConfig::default() };
        let camera = PinholeCamera::kinect_v2();
        assert_eq!(config.with_readout_of(camera).unwrap().readout(), 0.02);
        let rolling = camera.with_readout(0.026).unwrap();
        assert_eq!(config.with_readout_of(rolling).unwrap().readout(), 0.026);
        assert_eq!(MotionModelConfig::default().with_readout_of(rolling).unwrap().readout(), 0.026);
    }
}
