use crate::anchor::MAX_RELATIVE_SIGMA;
use crate::frame::Frame;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose3, require_in, require_positive};

/// When a frame becomes a keyframe. Time has no part in it: a camera that stands still adds nothing, however long.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct KeyframeConfig {
    /// Never nearer to every keyframe than this, m, above 0. Default 0.03: well over the tracking noise.
    pub min_translation: f64,
    /// Nor turned less than this against it, rad, above 0. Default 0.05 (3 deg): a tenth of the picture at most.
    pub min_rotation: f64,
    /// Always when farther than this from every keyframe, m. Default 0.3: the smaller detail then looks different.
    pub max_translation: f64,
    /// Or turned more than this against it, rad. Default 0.35 (20 deg): a third of the picture is new.
    pub max_rotation: f64,
    /// When less than this part of the reference keyframe's landmarks is still seen, 0 to 1. Default 0.6, between the
    /// 0.4 and 0.75 of \[MurArtal17\].
    pub tracked_ratio: f64,
    /// When less than this part of the features with depth is a landmark, 0 to 1. Default 0.25: the view is new, whatever
    /// the reference sees.
    pub known_ratio: f64,
}

impl Default for KeyframeConfig {
    fn default() -> Self {
        Self {
            min_translation: 0.03,
            min_rotation: 0.05,
            max_translation: 0.3,
            max_rotation: 0.35,
            tracked_ratio: 0.6,
            known_ratio: 0.25,
        }
    }
}

impl KeyframeConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names, or a `min` is above its `max`.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_positive("keyframes.min_translation", self.min_translation, "m")?;
        require_positive("keyframes.min_rotation", self.min_rotation, "rad")?;
        require_in("keyframes.max_translation", self.max_translation, "m", self.min_translation, f64::MAX)?;
        require_in("keyframes.max_rotation", self.max_rotation, "rad", self.min_rotation, f64::MAX)?;
        require_in("keyframes.tracked_ratio", self.tracked_ratio, "", 0.0, 1.0)?;
        require_in("keyframes.known_ratio", self.known_ratio, "", 0.0, 1.0)?;
        Ok(self)
    }

    /// Whether a frame at `pose` that sees `tracked` landmarks should become a keyframe. `reference` is the keyframe
    /// with which it shares the most.
    pub(crate) fn wants(
        &self,
        frame: &Frame,
        pose: Pose3,
        tracked: usize,
        reference: KeyframeId,
        map: &LandmarkMap,
    ) -> bool {
        let everywhere = |translation: f64, rotation: f64| {
            map.keyframes().rev().all(|(_, keyframe)| {
                let offset = keyframe.visual_from_camera.inverse() * pose;
                offset.translation.norm() > translation || offset.angle() > rotation
            })
        };
        if !everywhere(self.min_translation, self.min_rotation) {
            return false;
        }
        let few = (tracked as f64) < self.tracked_ratio * confirmed(reference, map) as f64;
        let unknown = (tracked as f64) < self.known_ratio * with_depth(frame) as f64;
        few || unknown || everywhere(self.max_translation, self.max_rotation)
    }
}

/// How many landmarks the keyframe shares with another; with the first keyframe alone, how many it has.
fn confirmed(reference: KeyframeId, map: &LandmarkMap) -> usize {
    let least = map.keyframe_count().min(2);
    let landmarks = map.keyframe(reference).landmarks.iter().flatten().filter_map(|id| map.landmark(*id));
    landmarks.filter(|l| l.observations.len() >= least).count()
}

/// How many features have a depth good enough to become landmarks.
pub(crate) fn with_depth(frame: &Frame) -> usize {
    frame.depths.iter().flatten().filter(|d| d.sigma <= MAX_RELATIVE_SIGMA * d.value).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{frame_with_depth, map_of_one_view};
    use nalgebra::Vector6;

    #[test]
    fn what_stands_still_adds_nothing_and_what_moves_does() {
        let config = KeyframeConfig::default();
        let (map, reference) = map_of_one_view(100);
        let frame = frame_with_depth(100);
        let wants = |x: f64, turn: f64, tracked: usize| {
            let pose = Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, turn, 0.0));
            config.wants(&frame, pose, tracked, reference, &map)
        };
        assert!(!wants(0.02, 0.01, 5), "blind but still");
        assert!(!wants(0.1, 0.1, 90), "moved, but the view is well known");
        assert!(wants(0.1, 0.0, 55), "sees little of what the reference sees");
        assert!(wants(0.0, 0.4, 100), "turned far");
        assert!(wants(0.4, 0.0, 100), "moved far");
    }

    #[test]
    fn bounds_are_checked() {
        assert!(KeyframeConfig { max_rotation: 0.01, ..Default::default() }.validated().is_err());
        assert!(KeyframeConfig { tracked_ratio: f64::NAN, ..Default::default() }.validated().is_err());
    }
}
