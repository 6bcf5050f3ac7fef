use crate::Pose3;
use nalgebra::Matrix6;

/// What a camera did between two images, as other sensors know it: wheels and gyro, say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraMotion {
    /// `previous_camera_from_camera`.
    pub motion: Pose3,
    /// Of `motion` as a right perturbation (m, m, m, rad, rad, rad); none where nobody says it.
    pub covariance: Option<Matrix6<f64>>,
}

impl CameraMotion {
    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        self.motion.is_finite() && self.covariance.is_none_or(|c| c.iter().all(|v| v.is_finite()))
    }
}

/// A motion of which nobody says how exact it is.
impl From<Pose3> for CameraMotion {
    fn from(motion: Pose3) -> Self {
        Self { motion, covariance: None }
    }
}
