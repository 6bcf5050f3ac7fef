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
mod common_sight;
mod config;
mod correct;
mod essential_graph;
mod verify;
mod ways;

use crate::claim::Claim;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use crate::mapping::MappingConfig;
use crate::places::Places;
use crate::relocalisation::unrivalled;
use crate::sensor::Sensor;
use crate::tracker::TrackingConfig;
use candidates::Drift;
pub use config::LoopConfig;
use correct::Correction;
use trundle_core::Pose3;
pub(crate) use verify::{Recognised, Verifier};
use ways::SurestWays;

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

/// The look for the place of one keyframe among the old ones, a piece a frame: which look like it, then one of these after
/// the other.
#[derive(Debug, Clone)]
pub(crate) struct Search {
    pub keyframe: KeyframeId,
    /// What is still to be looked at, the likeliest last; `None` before it is known.
    candidates: Option<Vec<KeyframeId>>,
    found: Vec<Recognised>,
}

impl Search {
    pub fn of(keyframe: KeyframeId) -> Self {
        Self { keyframe, candidates: None, found: Vec::new() }
    }
}

impl LoopCloser<'_> {
    /// Does the next piece of a search; whether that was the last.
    pub fn look(&self, map: &LandmarkMap, search: &mut Search) -> bool {
        let Self { places, sensor, config, tracking, seed, .. } = *self;
        let Some(own) = places.worded(map, search.keyframe) else { return true };
        let Some(candidates) = &mut search.candidates else {
            let found = candidates::candidates(map, places, (search.keyframe, own), config);
            return search.candidates.insert(found.into_iter().rev().collect()).is_empty();
        };
        // One may have been forgotten meanwhile.
        let next = candidates.pop().filter(|id| map.live_keyframe(*id).is_some());
        let is_last = candidates.is_empty();
        let verifier = Verifier { map, places, sensor, tracking, config, seed };
        search.found.extend(next.and_then(|id| verifier.verify(own, id)));
        is_last
    }

    /// Ties the keyframe to the place that a search has found, if that can be believed. `surprise` is what the searches before
    /// said against all expectation.
    pub fn close(
        &self,
        map: &mut LandmarkMap,
        search: Search,
        surprise: &mut Option<Claim<()>>,
    ) -> Option<LoopClosure> {
        let keyframe = search.keyframe;
        let found = self.recognise(map, search, surprise)?;
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
        search: Search,
        surprise: &mut Option<Claim<()>>,
    ) -> Option<Recognised> {
        let said_before = surprise.take();
        let keyframe = search.keyframe;
        let is_there = |found: &Recognised| map.live_keyframe(found.candidate).is_some();
        let found = unrivalled(search.found).filter(is_there)?;
        let here = map.live_keyframe(keyframe)?.visual_from_camera;
        let correction = here.inverse() * found.visual_from_camera;
        let ways = SurestWays::from(map, keyframe, self.config);
        let drift = Drift::along(&ways, map, (found.candidate, keyframe), self.config);
        if drift.allows(correction, &found.covariance) {
            return Some(found);
        }
        if !drift.may_be_surprised_by(correction) {
            return None;
        }
        *surprise = said_before;
        let times = Claim::note(surprise, (), (found.visual_from_camera, here), 0.0);
        (times >= self.config.consistency).then_some(found)
    }
}
