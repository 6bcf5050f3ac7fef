//! Loop closing: a place seen again takes the drift out of everything since.
//!
//! Problem: along a corridor the map drifts, and a place reached again stands beside its first image. Idea: a new
//! keyframe is compared with old ones that it is not yet tied to but that its uncertainty lets be near; where enough of
//! the old points are found in it under one pose, and that pose is no farther off than the drift allows, the
//! keyframes between are moved by a pose graph, and landmarks that are there twice become one (\[MurArtal17\], there with
//! a bag of words in place of the uncertainty). A look-alike elsewhere is refused by the uncertainty. Cost: nothing where
//! no old keyframe is near, else a matching of descriptors for each candidate, a few ms.

mod candidates;
mod config;
mod correct;
mod verify;

use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use crate::mapping::MappingConfig;
use crate::places::Places;
use crate::sensor::Sensor;
use crate::tracker::TrackingConfig;
pub use config::LoopConfig;
use correct::Correction;
use trundle_core::Pose3;
use verify::Verifier;

/// Closes loops as keyframes come.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoopCloser<'a> {
    pub places: &'a Places,
    pub sensor: &'a Sensor,
    pub config: &'a LoopConfig,
    pub tracking: &'a TrackingConfig,
    pub mapping: &'a MappingConfig,
    pub seed: u64,
}

/// A place seen again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopClosure {
    /// The keyframe that saw it again.
    pub keyframe: KeyframeId,
    /// The keyframe that had seen it.
    pub seen_before: KeyframeId,
    /// Points of the old place found again.
    pub points: usize,
    /// How the camera's pose changed: `new_from_old` in the visual frame.
    pub correction: Pose3,
}

impl LoopCloser<'_> {
    /// Ties `keyframe`, the newest, to a place seen before, if it shows one.
    pub fn close(&self, map: &mut LandmarkMap, keyframe: KeyframeId) -> Option<LoopClosure> {
        let verifier = Verifier {
            map,
            places: self.places,
            sensor: self.sensor,
            tracking: self.tracking,
            config: self.config,
            seed: self.seed,
        };
        let candidates = candidates::candidates(map, keyframe, self.config);
        let found = candidates.into_iter().find_map(|candidate| verifier.verify(keyframe, candidate))?;
        let before = map.keyframe(keyframe).visual_from_camera;
        let (seen_before, points) = (found.candidate, found.points);
        let correction = Correction {
            sensor: self.sensor,
            config: self.config,
            mapping: self.mapping,
            likeness: self.tracking.window_likeness(),
            window: self.tracking.map_window_px,
            found,
        };
        correction.apply(map, keyframe);
        let correction = map.keyframe(keyframe).visual_from_camera * before.inverse();
        Some(LoopClosure { keyframe, seen_before, points, correction })
    }
}
