use crate::anchor::Anchor;
use crate::ids::{KeyframeId, LandmarkId};
use crate::refine::Fix;
use crate::search::Projection;
use crate::tracker::Tracker;
use trundle_core::Pose3;

/// How a frame was located.
#[derive(Debug)]
pub(crate) struct Found {
    pub fix: Fix,
    /// The landmarks that should have been seen, and where.
    pub visible: Vec<(LandmarkId, Projection)>,
    /// Whether the landmark map itself agrees, not only the last frame.
    pub by_map: bool,
    /// Whether it was found by a keyframe that looks alike.
    pub relocalised: bool,
}

impl Found {
    /// From the last frame, whose reference keyframe is `reference`, to the map. Where the map has too little to say, in
    /// a blurred or quite new view, the last frame alone must do: a little drift is better than getting lost.
    pub fn from_last(
        tracker: &Tracker,
        last: Anchor,
        reference: Option<KeyframeId>,
        predicted: Pose3,
    ) -> Option<Self> {
        let rough = tracker.by_last(last, reference, predicted)?;
        let (fix, visible) = tracker.by_map(&rough);
        let by_map = fix.is_sound(tracker.config.min_inliers);
        let fix = if by_map { fix } else { rough };
        Some(Self { fix, visible, by_map, relocalised: false })
    }

    /// From a keyframe to the map; to be believed, it takes more landmarks that agree, most of those matched, and a good
    /// part of those that should be in view: a picture that hangs in two rooms is not the room.
    pub fn from_keyframe(tracker: &Tracker, keyframe: KeyframeId) -> Option<Self> {
        let rough = tracker.by_words(keyframe)?;
        let (fix, visible) = tracker.by_map(&rough);
        let expected = tracker.config.recognised_part * visible.len() as f64;
        let is_seen = fix.solution.inlier_count as f64 >= expected;
        let sound = fix.is_sound(tracker.config.weak_inliers) && fix.is_convincing() && is_seen;
        sound.then_some(Self { fix, visible, by_map: true, relocalised: true })
    }

    /// Points that agree.
    pub fn inliers(&self) -> usize {
        self.fix.solution.inlier_count
    }
}
