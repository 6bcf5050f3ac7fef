//! The motion between two keyframes by wheels and gyro.

use crate::ids::KeyframeId;
use crate::motion::motion_model::MotionModelConfig;
use crate::motion::uncertain_pose::UncertainPose;
use nalgebra::Matrix6;
use trundle_core::{CameraMotion, Pose3};
use trundle_optim::{PoseConstraint, PosePrior};

/// Largest translation (100 m) and largest standard deviation (100 m or 100 rad) of a factor. Beyond either the factor is dropped. Source:
/// ours.
const MAX_FACTOR_EXTENT: f64 = 100.0;

/// The motion from a keyframe to the camera, as wheels and gyro measured it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OdometryFactor {
    pub from: KeyframeId,
    /// Pose of the camera in the keyframe's frame.
    pub from_to: UncertainPose,
}

impl OdometryFactor {
    /// A camera that stands at a keyframe.
    pub fn at(from: KeyframeId) -> Self {
        Self { from, from_to: UncertainPose::identity() }
    }

    /// The factor after another step of `seconds` s; `None` if it is then too long or too uncertain.
    pub fn extended_by(&self, step: CameraMotion, seconds: f64, config: &MotionModelConfig) -> Option<Self> {
        let step = UncertainPose { pose: step.motion, covariance: config.covariance_of(&step, seconds) };
        let from_to = self.from_to.then(&step);
        let is_useful = from_to.pose.translation.norm() < MAX_FACTOR_EXTENT
            && from_to.covariance.amax() < MAX_FACTOR_EXTENT.powi(2);
        is_useful.then_some(Self { from_to, ..*self })
    }

    /// This motion followed by that of `next`, which begins at this factor's last keyframe.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self { from: self.from, from_to: self.from_to.then(&next.from_to) }
    }

    /// The factor as a constraint between two pose indices; `None` without information.
    pub fn constraint(&self, from: usize, to: usize) -> Option<PoseConstraint> {
        Some(PoseConstraint { from, to, from_to: self.from_to.pose, information: self.information()? })
    }

    /// The pose of the camera that the factor predicts when its keyframe is at `visual_from_keyframe`.
    pub fn prior(&self, visual_from_keyframe: Pose3) -> PosePrior {
        let world_from_camera = visual_from_keyframe * self.from_to.pose;
        PosePrior { world_from_camera, covariance: self.covariance_with_sway() }
    }

    /// Inverse of [`Self::covariance_with_sway`]; `None` if the covariance is singular.
    pub fn information(&self) -> Option<Matrix6<f64>> {
        let information = self.covariance_with_sway().cholesky()?.inverse();
        information.iter().all(|v| v.is_finite()).then_some(information)
    }

    /// Covariance of the factor and of the camera's mast together.
    fn covariance_with_sway(&self) -> Matrix6<f64> {
        let sum = self.from_to.covariance + CameraMotion::mast_sway();
        (sum + sum.transpose()) * 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;

    #[test]
    fn two_factors_compose_to_the_factor_of_the_whole_motion() {
        let config = MotionModelConfig::default();
        let step = Pose3::exp(Vector6::new(0.0, 0.0, 0.05, 0.0, 0.02, 0.0));
        let start = KeyframeId::from_index(0);
        let go = |from: OdometryFactor, steps: usize| {
            (0..steps).fold(from, |odometry, _| odometry.extended_by(step.into(), 0.1, &config).unwrap())
        };
        let (whole, first) = (go(OdometryFactor::at(start), 20), go(OdometryFactor::at(start), 8));
        let parts = first.then(&go(OdometryFactor::at(KeyframeId::from_index(1)), 12));
        assert_eq!(parts.from, start);
        assert!((parts.from_to.pose.inverse() * whole.from_to.pose).log().norm() < 1e-12);
        assert!((parts.from_to.covariance - whole.from_to.covariance).norm() < 1e-12);
        let sigma = whole.from_to.covariance.fixed_view::<3, 3>(0, 0).trace().sqrt();
        assert!((0.05..0.2).contains(&sigma), "{sigma}");
        let known = |odometry: &OdometryFactor| odometry.information().unwrap().trace();
        assert!(
            known(&whole) < known(&parts.then(&OdometryFactor::at(start))) + 1e-6
                && known(&first) > known(&whole)
        );
    }
}
