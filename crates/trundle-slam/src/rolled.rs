use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use crate::motion::{MotionConfig, carried, of_sigmas};
use nalgebra::Matrix6;
use trundle_core::{CameraMotion, Pose3};
use trundle_optim::{PoseConstraint, PosePrior};

/// What the camera may be off against the base whatever the wheels say, m and rad: how much a camera on a short mast nods.
///
/// This is what holds a robot that turns on the spot in its place: keyframe follows keyframe there, and what their images have wrong
/// they have wrong alike, so that a tie that lets each go 0.5 mm lets the turn go centimetres (docs/results.md).
const STEADY: (f64, f64) = (1e-4, 5e-4);
/// A way that is less certain, or longer, m, says nothing.
const FARTHEST: f64 = 100.0;

/// The way from a keyframe on, as wheels and gyro know it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rolled {
    pub from: KeyframeId,
    /// Where the camera is now, in the keyframe's frame.
    pub from_to: Pose3,
    /// Of that as a right perturbation.
    pub covariance: Matrix6<f64>,
}

impl Rolled {
    /// Standing at a keyframe.
    pub fn at(from: KeyframeId) -> Self {
        Self { from, from_to: Pose3::identity(), covariance: Matrix6::zeros() }
    }

    /// After another step of so many seconds; `None` once it says nothing any more.
    pub fn on(&self, step: CameraMotion, seconds: f64, config: &MotionConfig) -> Option<Self> {
        let noise = config.covariance_of(&step, seconds);
        let from_to = (self.from_to * step.motion).renormalized();
        let way = Self { from_to, covariance: carried(&self.covariance, step.motion) + noise, ..*self };
        let is_near = from_to.translation.norm() < FARTHEST && way.covariance.amax() < FARTHEST.powi(2);
        is_near.then_some(way)
    }

    /// After the way that `next` knows, which begins where this one ends.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let covariance = carried(&self.covariance, next.from_to) + next.covariance;
        Self { from: self.from, from_to: (self.from_to * next.from_to).renormalized(), covariance }
    }

    /// The same as a tie between the poses of these indices; `None` where it says nothing.
    pub fn tie(&self, from: usize, to: usize) -> Option<PoseConstraint> {
        Some(PoseConstraint { from, to, from_to: self.from_to, information: self.information()? })
    }

    /// Where the way leads from the keyframe in a map that has it.
    pub fn prior(&self, map: &LandmarkMap) -> Option<PosePrior> {
        let keyframe = map.live_keyframe(self.from)?;
        let world_from_camera = keyframe.visual_from_camera * self.from_to;
        Some(PosePrior { world_from_camera, covariance: self.spread() })
    }

    /// The inverse of the covariance, for a camera whose mast sways.
    pub fn information(&self) -> Option<Matrix6<f64>> {
        let information = self.spread().cholesky()?.inverse();
        information.iter().all(|v| v.is_finite()).then_some(information)
    }

    /// The covariance, for a camera whose mast sways.
    fn spread(&self) -> Matrix6<f64> {
        let spread = self.covariance + of_sigmas(STEADY.0, STEADY.1);
        (spread + spread.transpose()) * 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;

    #[test]
    fn a_way_in_two_parts_is_the_whole_way() {
        let config = MotionConfig::default();
        let step = Pose3::exp(Vector6::new(0.0, 0.0, 0.05, 0.0, 0.02, 0.0));
        let start = KeyframeId::from_index(0);
        let go = |from: Rolled, steps: usize| {
            (0..steps).fold(from, |rolled, _| rolled.on(step.into(), 0.1, &config).unwrap())
        };
        let (whole, first) = (go(Rolled::at(start), 20), go(Rolled::at(start), 8));
        let parts = first.then(&go(Rolled::at(KeyframeId::from_index(1)), 12));
        assert_eq!(parts.from, start);
        assert!((parts.from_to.inverse() * whole.from_to).log().norm() < 1e-12);
        assert!((parts.covariance - whole.covariance).norm() < 1e-12);
        let sigma = whole.covariance.fixed_view::<3, 3>(0, 0).trace().sqrt();
        assert!((0.05..0.2).contains(&sigma), "{sigma}");
        let known = |rolled: &Rolled| rolled.information().unwrap().trace();
        assert!(
            known(&whole) < known(&parts.then(&Rolled::at(start))) + 1e-6 && known(&first) > known(&whole)
        );
    }
}
