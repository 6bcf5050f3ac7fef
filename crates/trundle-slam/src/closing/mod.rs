//! Loop closing: a place seen again takes the drift out of everything since.
//!
//! Problem: along a corridor the map drifts, and a place reached again stands beside its first image. Idea: a new
//! keyframe is compared with the old ones that look alike by their words, that it is not yet tied to, and that its drift
//! lets be near; where enough of the old points are found in it under one pose, and under no other nearly as many, the
//! keyframes between are moved by a pose graph, and landmarks that are there twice become one \[MurArtal17\]. A correction
//! larger than the drift explains must be asked for by several keyframes in a row, and be smaller than what parts two
//! rooms: a look-alike elsewhere is refused. Cost: a question to the index, and for each of at most three candidates a
//! matching under the words, about a ms each.

mod candidates;
mod config;
mod correct;
mod odometer;
mod verify;

use crate::claim::Claim;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use crate::mapping::MappingConfig;
use crate::places::Places;
use crate::sensor::Sensor;
use crate::tracker::TrackingConfig;
use candidates::Drift;
pub use config::LoopConfig;
use correct::Correction;
pub(crate) use odometer::Odometer;
use trundle_core::Pose3;
pub(crate) use verify::{Recognised, Verifier};

/// Closes loops as keyframes come.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoopCloser<'a> {
    pub places: &'a Places,
    pub odometer: &'a Odometer,
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
    /// Ties `keyframe`, the newest, to a place seen before, if it shows one. `surprise` is what the keyframes before it said
    /// against all expectation.
    pub fn close(
        &self,
        map: &mut LandmarkMap,
        keyframe: KeyframeId,
        surprise: &mut Option<Claim<()>>,
    ) -> Option<LoopClosure> {
        let found = self.recognise(map, keyframe, surprise)?;
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

    /// The place that the keyframe shows, if that can be believed.
    fn recognise(
        &self,
        map: &LandmarkMap,
        keyframe: KeyframeId,
        surprise: &mut Option<Claim<()>>,
    ) -> Option<Recognised> {
        let said_before = surprise.take();
        let own = self.places.worded(map, keyframe)?;
        let Self { places, odometer, sensor, config, tracking, seed, .. } = *self;
        let candidates = candidates::candidates(map, (places, odometer), (keyframe, own), config);
        let verifier = Verifier { map, places, sensor, tracking, config, seed };
        let found = verifier.recognise(own, &candidates)?;
        let here = map.keyframe(keyframe).visual_from_camera;
        let correction = here.inverse() * found.visual_from_camera;
        let drift = Drift::between(map, odometer, (found.candidate, keyframe), config);
        if drift.allows(correction) {
            return Some(found);
        }
        if !drift.may_be_surprised_by(correction) {
            return None;
        }
        *surprise = said_before;
        let times = Claim::note(surprise, (), found.visual_from_camera * here.inverse());
        (times >= config.consistency).then_some(found)
    }
}
