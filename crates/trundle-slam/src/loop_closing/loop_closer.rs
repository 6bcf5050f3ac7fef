//! Decides whether a keyframe closes a loop, and closes it.

use crate::frame::observation_model::ObservationModel;
use crate::ids::KeyframeId;
use crate::local_mapping::config::LocalMappingConfig;
use crate::local_mapping::local_mapper::LocalMapper;
use crate::loop_closing::candidates::{DriftBound, loop_candidates};
use crate::loop_closing::config::LoopConfig;
use crate::loop_closing::correction::LoopCorrection;
use crate::loop_closing::loop_closure::LoopClosure;
use crate::loop_closing::place_verification::{PlaceVerifier, RecognizedPlace};
use crate::loop_closing::uncertainty_paths::UncertaintyPaths;
use crate::map::landmark_map::LandmarkMap;
use crate::optimisation::map_optimisation::MapOptimisation;
use crate::place_recognition::consistency_check::ConsistencyCheck;
use crate::place_recognition::keyframe_index::KeyframeIndex;
use crate::place_recognition::place_hypothesis::without_rival;
use crate::tracking::config::TrackingConfig;

/// Closes loops for new keyframes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoopCloser<'a> {
    pub place_index: &'a KeyframeIndex,
    pub model: &'a ObservationModel,
    pub config: &'a LoopConfig,
    pub tracking: &'a TrackingConfig,
    pub mapping: &'a LocalMappingConfig,
    pub seed: u64,
}

/// The search for one keyframe's place among the old keyframes, in steps: first the list of candidates, then one candidate per step.
#[derive(Debug, Clone)]
pub(crate) struct LoopSearch {
    keyframe: KeyframeId,
    /// Candidates to verify, the most similar last; `None` before the first step.
    candidates: Option<Vec<KeyframeId>>,
    found: Vec<RecognizedPlace>,
}

impl LoopSearch {
    pub fn of(keyframe: KeyframeId) -> Self {
        Self { keyframe, candidates: None, found: Vec::new() }
    }
}

impl LoopCloser<'_> {
    /// Does the next step of a search. Returns whether the search is complete.
    pub fn advance(&self, map: &LandmarkMap, search: &mut LoopSearch) -> bool {
        let Self { place_index, model, config, tracking, seed, .. } = *self;
        let Some(own) = place_index.frame_bow(map, search.keyframe) else { return true };
        let Some(candidates) = &mut search.candidates else {
            let found = loop_candidates(map, place_index, (search.keyframe, own), config);
            return search.candidates.insert(found.into_iter().rev().collect()).is_empty();
        };
        // Culling may have removed a candidate since the search began.
        let next = candidates.pop().filter(|id| map.live_keyframe(*id).is_some());
        let is_last = candidates.is_empty();
        let verifier = PlaceVerifier { map, place_index, model, tracking, config, seed };
        search.found.extend(next.and_then(|id| verifier.verify(own, id)));
        is_last
    }

    /// Corrects the map by the place of a finished search, if the correction is accepted. `pending` is an unexpected correction found by
    /// earlier searches.
    pub fn close(
        &self,
        (map, optimisation): (&mut LandmarkMap, &mut MapOptimisation),
        search: LoopSearch,
        pending: &mut Option<ConsistencyCheck<()>>,
    ) -> Option<LoopClosure> {
        let keyframe = search.keyframe;
        let place = self.accepted_place(map, search, pending)?;
        let before = map.keyframe(keyframe).visual_from_camera;
        let (seen_before, points) = (place.candidate, place.points);
        let mapper = LocalMapper::new(self.model, self.mapping, self.tracking);
        let correction = LoopCorrection { mapper, config: self.config, place };
        correction.apply(map, optimisation, keyframe);
        let correction = map.keyframe(keyframe).visual_from_camera * before.inverse();
        Some(LoopClosure { keyframe, seen_before, points, correction })
    }

    /// The place that the keyframe shows: at once where the drift explains the correction, else after several keyframes in a row.
    fn accepted_place(
        &self,
        map: &LandmarkMap,
        search: LoopSearch,
        pending: &mut Option<ConsistencyCheck<()>>,
    ) -> Option<RecognizedPlace> {
        let found_before = pending.take();
        let keyframe = search.keyframe;
        let is_alive = |place: &RecognizedPlace| map.live_keyframe(place.candidate).is_some();
        let place = without_rival(search.found).filter(is_alive)?;
        let here = map.live_keyframe(keyframe)?.visual_from_camera;
        let correction = here.inverse() * place.visual_from_camera;
        let paths = UncertaintyPaths::from(map, keyframe, self.config);
        let drift = DriftBound::along(&paths, map, (place.candidate, keyframe), self.config);
        if drift.allows(correction, &place.covariance) {
            return Some(place);
        }
        if !drift.allows_unexpected(correction) {
            return None;
        }
        *pending = found_before;
        let count = ConsistencyCheck::record(pending, (), (place.visual_from_camera, here), 0.0);
        (count >= self.config.consistency).then_some(place)
    }
}
