//! Recognizes another map in a keyframe, and merges the two.

use crate::atlas::map_collection::Atlas;
use crate::atlas::sub_map::{IdMap, SubMap};
use crate::ids::{KeyframeId, MapId};
use crate::local_mapping::local_mapper::LocalMapper;
use crate::loop_closing::config::LoopConfig;
use crate::loop_closing::place_verification::{PlaceVerifier, RecognizedPlace};
use crate::optimisation::local_bundle::{BundleSize, refine_around};
use crate::place_recognition::consistency_check::ConsistencyCheck;
use crate::report::MapMerge;
use crate::tracking::config::TrackingConfig;
use trundle_core::Pose3;

/// Number of keyframes that the bundle adjustment around the common keyframe moves, and of those that it fixes: 40. More take longer than
/// an image. Source: ours.
const MERGE_BUNDLE_KEYFRAMES: usize = 40;

/// Merges maps when keyframes show them \[Campos21, sec. VI-B\].
#[derive(Debug, Clone, Copy)]
pub(crate) struct MapMerger<'a> {
    pub mapper: LocalMapper<'a>,
    pub config: &'a LoopConfig,
    pub tracking: &'a TrackingConfig,
    pub seed: u64,
}

/// A merge, and the data that moves the past frames with it.
#[derive(Debug)]
pub(crate) struct Merged {
    pub report: MapMerge,
    pub absorbed: SubMap,
    pub ids: IdMap,
    pub into_from_absorbed: Pose3,
}

/// Another map that a keyframe shows.
struct RecognizedMap {
    /// Index among the inactive maps.
    index: usize,
    id: MapId,
    place: RecognizedPlace,
    other_from_active: Pose3,
}

impl MapMerger<'_> {
    /// Merges the active map with another one that its newest keyframe shows, once enough keyframes in a row show it at the same
    /// pose. The older map keeps its frame.
    pub fn merge(&self, atlas: &mut Atlas, keyframe: KeyframeId) -> Option<Merged> {
        let found_before = atlas.pending_merge.take();
        let other = self.recognize(atlas, keyframe)?;
        let pair = (other.id, atlas.active.id);
        if atlas.submap_link.is_some_and(|link| !link.allows(pair, other.other_from_active, self.config)) {
            return None;
        }
        let before = atlas.active.map.keyframe(keyframe).visual_from_camera;
        atlas.pending_merge = found_before;
        let poses = (other.place.visual_from_camera, before);
        let count = ConsistencyCheck::record(&mut atlas.pending_merge, other.id, poses, 0.0);
        if count < self.config.consistency {
            return None;
        }
        atlas.pending_merge = None;
        let mut merged = self.join(atlas, keyframe, other);
        let after = atlas.active.map.keyframe(merged.report.keyframe).visual_from_camera;
        merged.report.correction = after * before.inverse();
        Some(merged)
    }

    /// The first inactive map that the keyframe shows.
    fn recognize(&self, atlas: &Atlas, keyframe: KeyframeId) -> Option<RecognizedMap> {
        let Atlas { active, inactive, .. } = atlas;
        let own = active.place_index.frame_bow(&active.map, keyframe)?;
        let recognize = |other: &SubMap| {
            let SubMap { map, place_index, .. } = other;
            let candidates = place_index.similar_keyframes(map, own.bow, |_| true, self.config.candidates);
            let Self { mapper: LocalMapper { model, .. }, config, tracking, seed } = *self;
            PlaceVerifier { map, place_index, model, tracking, config, seed }.recognize(own, &candidates)
        };
        let place = |(index, other): (usize, &SubMap)| Some((index, other.id, recognize(other)?));
        let (index, id, place) = inactive.iter().enumerate().find_map(place)?;
        let here = active.map.keyframe(keyframe).visual_from_camera;
        let other_from_active = place.visual_from_camera * here.inverse();
        Some(RecognizedMap { index, id, place, other_from_active })
    }

    /// Moves the content of the newer map into the older one, which becomes the active map.
    fn join(&self, atlas: &mut Atlas, keyframe: KeyframeId, recognized: RecognizedMap) -> Merged {
        let RecognizedMap { index, mut place, other_from_active, .. } = recognized;
        let other = atlas.inactive.remove(index);
        let is_older = other.id < atlas.active.id;
        let covariance =
            other.map.keyframe(place.candidate).covariance + atlas.active.map.keyframe(keyframe).covariance;
        let (absorbed, into_from_absorbed) = if is_older {
            (std::mem::replace(&mut atlas.active, other), other_from_active)
        } else {
            (other, other_from_active.inverse())
        };
        let ids = atlas.active.absorb(&absorbed.map, into_from_absorbed, covariance);
        let keyframe = if is_older { ids.keyframes[&keyframe] } else { keyframe };
        if !is_older {
            place.candidate = ids.keyframes[&place.candidate];
            place.landmarks.iter_mut().for_each(|id| *id = ids.landmarks[id]);
        }
        atlas.active.map.add_loop_edge(place.candidate, keyframe);
        self.fuse(&mut atlas.active, keyframe, &place);
        let (from, into, correction) = (absorbed.id, atlas.active.id, Pose3::identity());
        let report = MapMerge { from, into, keyframe, points: place.points, correction };
        Merged { report, absorbed, ids, into_from_absorbed }
    }

    /// Fuses duplicate landmarks after the merge, and adjusts the keyframes around.
    fn fuse(&self, active: &mut SubMap, keyframe: KeyframeId, place: &RecognizedPlace) {
        let LocalMapper { model, config, .. } = self.mapper;
        self.mapper.fuse_around(&mut active.map, keyframe, &place.landmarks);
        let size = BundleSize { local: MERGE_BUNDLE_KEYFRAMES, fixed: MERGE_BUNDLE_KEYFRAMES };
        refine_around(&mut active.map, keyframe, model, size, &config.bundle);
        active.update_index();
    }
}
