//! When a frame becomes a keyframe.

use crate::frame::rgbd_frame::{Frame, with_depth};
use crate::ids::KeyframeId;
use crate::map::landmark_map::LandmarkMap;
use serde::{Deserialize, Serialize};
use std::{collections::BTreeSet, f64::consts::PI};
use trundle_core::{Invalid, Pose3, Vector2, require_in};

/// When a frame becomes a keyframe. Time does not matter: a camera at rest adds no keyframe.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct KeyframeConfig {
    /// Distance from a keyframe up to which no frame becomes a keyframe, unless turned by more than `min_rotation`, m, above 0, to 10. A larger
    /// value makes fewer keyframes. Default 0.03: well over the tracking noise.
    pub min_translation: f64,
    /// Rotation against a keyframe up to which no frame becomes a keyframe, unless farther than `min_translation`, rad, above 0, to pi. Default
    /// 0.05 (3 deg): a tenth of the image at most.
    pub min_rotation: f64,
    /// Distance from every keyframe beyond which a frame with half of `new_ratio` new features becomes a keyframe, m, `min_translation` to 10;
    /// beyond twice the distance any frame does. A smaller value makes more keyframes. Default 0.3: small detail then looks different.
    pub max_translation: f64,
    /// Rotation against every keyframe beyond which a frame with half of `new_ratio` new features becomes a keyframe, rad, `min_rotation` to pi;
    /// beyond twice the rotation any frame does. Default 0.35 (20 deg): a third of the image is new.
    pub max_rotation: f64,
    /// Fraction of the features with depth in areas without an expected landmark, 0 to 1, above which a frame becomes a keyframe. Expected
    /// landmarks count, not found ones: a blurred frame finds few landmarks and would be a bad keyframe. Default 0.25 (ours).
    pub new_ratio: f64,
    /// Number of tracked landmarks, 0 or more, below which a frame becomes a keyframe, if twice as many features have a depth. Default 50: tracking is
    /// about to fail.
    pub min_tracked: usize,
}

impl Default for KeyframeConfig {
    fn default() -> Self {
        Self {
            min_translation: 0.03,
            min_rotation: 0.05,
            max_translation: 0.3,
            max_rotation: 0.35,
            new_ratio: 0.25,
            min_tracked: 50,
        }
    }
}

impl KeyframeConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation, or a `min` is above its `max`.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("keyframes.min_translation", self.min_translation, "m", 1e-6, 10.0)?;
        require_in("keyframes.min_rotation", self.min_rotation, "rad", 1e-6, PI)?;
        require_in("keyframes.max_translation", self.max_translation, "m", self.min_translation, 10.0)?;
        require_in("keyframes.max_rotation", self.max_rotation, "rad", self.min_rotation, PI)?;
        require_in("keyframes.new_ratio", self.new_ratio, "", 0.0, 1.0)?;
        Ok(self)
    }

    /// Whether a frame at `pose` that found `tracked` landmarks should become a keyframe. `shown` are the expected pixels of the map's
    /// landmarks, rectified px.
    pub(crate) fn needs_keyframe(
        &self,
        frame: &Frame,
        pose: Pose3,
        tracked: usize,
        shown: impl Iterator<Item = Vector2>,
        map: &LandmarkMap,
    ) -> bool {
        let beyond_all =
            |translation: f64, rotation: f64| !is_near_one(map, pose, (translation, rotation), None);
        if !beyond_all(self.min_translation, self.min_rotation) {
            return false;
        }
        let all = with_depth(frame).count();
        let thin = tracked < self.min_tracked && all >= 2 * tracked;
        let new = count_new_features(frame, shown) as f64 / all.max(1) as f64;
        let (far, turned) = (self.max_translation, self.max_rotation);
        thin || new > self.new_ratio
            || (new > 0.5 * self.new_ratio && beyond_all(far, turned))
            || beyond_all(2.0 * far, 2.0 * turned)
    }
}

impl KeyframeConfig {
    /// Whether no new keyframe would be made at this keyframe's pose if it were removed.
    pub(crate) fn is_covered_without(&self, map: &LandmarkMap, id: KeyframeId) -> bool {
        let pose = map.keyframe(id).visual_from_camera;
        is_near_one(map, pose, (2.0 * self.max_translation, 2.0 * self.max_rotation), Some(id))
    }
}

/// Whether a keyframe other than `except` is within a distance \[m\] and an angle \[rad\] of a pose.
fn is_near_one(
    map: &LandmarkMap,
    pose: Pose3,
    (translation, rotation): (f64, f64),
    except: Option<KeyframeId>,
) -> bool {
    let near = map.keyframes_near(pose.translation, translation);
    near.into_iter().filter(|id| Some(*id) != except).any(|id| {
        let offset = map.keyframe(id).visual_from_camera.inverse() * pose;
        offset.translation.norm() <= translation && offset.angle() <= rotation
    })
}

/// Number of features with depth in image cells without an expected landmark.
fn count_new_features(frame: &Frame, shown: impl Iterator<Item = Vector2>) -> usize {
    let cell = |pixel: Vector2| ((pixel.x / CELL_PX).floor() as i32, (pixel.y / CELL_PX).floor() as i32);
    let known: BTreeSet<(i32, i32)> = shown.map(cell).collect();
    with_depth(frame).filter(|i| !known.contains(&cell(frame.pixels[*i]))).count()
}

/// Side of the image cells that count as known or new: 40 px, a few times the distance between features. Source: ours.
const CELL_PX: f64 = 40.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{frame_with_depth, map_of_one_view};
    use nalgebra::Vector6;

    #[test]
    fn a_still_camera_makes_no_keyframe_and_a_moving_one_does() {
        let config = KeyframeConfig::default();
        let (map, _) = map_of_one_view(100);
        let frame = frame_with_depth(100);
        let needs_keyframe = |x: f64, turn: f64, tracked: usize, shown: usize| {
            let pose = Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, turn, 0.0));
            let shown = frame.pixels[..shown].iter().copied();
            config.needs_keyframe(&frame, pose, tracked, shown, &map)
        };
        assert!(!needs_keyframe(0.02, 0.01, 5, 5), "blind but still");
        assert!(!needs_keyframe(0.1, 0.1, 90, 100), "moved, but the view is well known");
        assert!(!needs_keyframe(0.1, 0.1, 60, 100), "blurred, but the view is well known");
        assert!(needs_keyframe(0.1, 0.0, 60, 60), "a part of the view is new");
        assert!(needs_keyframe(0.1, 0.0, 40, 100), "about to get lost");
        assert!(!needs_keyframe(0.4, 0.4, 100, 100), "farther, but the view is well known");
        assert!(needs_keyframe(0.0, 0.4, 100, 70), "turned far");
        assert!(needs_keyframe(0.4, 0.0, 100, 70), "moved far");
        assert!(needs_keyframe(0.0, 0.8, 100, 100), "turned very far");
        assert!(needs_keyframe(0.7, 0.0, 100, 100), "moved very far");
    }

    #[test]
    fn bounds_are_checked() {
        assert!(KeyframeConfig { max_rotation: 0.01, ..Default::default() }.validated().is_err());
        assert!(KeyframeConfig { new_ratio: f64::NAN, ..Default::default() }.validated().is_err());
    }
}
