//! The active map and the inactive ones.

use crate::atlas::sub_map::SubMap;
use crate::atlas::submap_link::SubmapLink;
use crate::ids::MapId;
use crate::map::landmark_map::LandmarkMap;
use crate::motion::uncertain_pose::UncertainPose;
use crate::place_recognition::consistency_check::ConsistencyCheck;
use std::sync::Arc;
use trundle_vision::Vocabulary;

/// Fewest keyframes of a map that is kept when the camera gets lost in it: 4. A smaller map is dropped, since it would hardly be recognized
/// again. Source: ours.
const MIN_KEPT_KEYFRAMES: usize = 4;

/// All maps \[Campos21, sec. VI\].
#[derive(Debug)]
pub(crate) struct Atlas {
    /// The map that new frames are located in and extend.
    pub active: SubMap,
    /// The other maps, by rising id.
    pub inactive: Vec<SubMap>,
    /// The highest id that a map ever had.
    newest_map_id: u32,
    /// Pose of the newest map's origin in the map before it, if odometry measured it.
    pub submap_link: Option<SubmapLink>,
    /// Another map that the last keyframe showed, before the merge is confirmed.
    pub pending_merge: Option<ConsistencyCheck<MapId>>,
}

impl Atlas {
    /// One empty map.
    pub fn new(vocabulary: &Arc<Vocabulary>) -> Self {
        Self {
            active: SubMap::new(MapId(0), LandmarkMap::default(), vocabulary),
            inactive: vec![],
            newest_map_id: 0,
            submap_link: None,
            pending_merge: None,
        }
    }

    /// Replaces all maps; the first one becomes the active map. Returns false for an empty list.
    pub fn replace(&mut self, maps: Vec<(MapId, LandmarkMap)>) -> bool {
        let vocabulary = Arc::clone(self.active.place_index.vocabulary());
        let mut maps = maps.into_iter().map(|(id, map)| SubMap::new(id, map, &vocabulary));
        let Some(first) = maps.next() else { return false };
        self.active = first;
        self.inactive = maps.collect();
        true
    }

    /// Sets the vocabulary that describes places.
    pub fn set_vocabulary(&mut self, vocabulary: &Arc<Vocabulary>) {
        self.inactive.iter_mut().chain([&mut self.active]).for_each(|map| map.set_vocabulary(vocabulary));
    }

    /// All maps, by rising id.
    pub fn maps(&self) -> Vec<&SubMap> {
        let mut maps: Vec<&SubMap> = self.inactive.iter().chain([&self.active]).collect();
        maps.sort_unstable_by_key(|map| map.id);
        maps
    }

    /// Makes a map the active one. Returns whether the active map changed.
    pub fn enter(&mut self, map: MapId) -> bool {
        let Some(entered) = self.inactive.iter_mut().find(|inactive| inactive.id == map) else {
            return false;
        };
        std::mem::swap(entered, &mut self.active);
        self.inactive.sort_by_key(|inactive| inactive.id);
        self.pending_merge = None;
        true
    }

    /// Leaves the active map for an empty one; `before_from_map` is where the camera is in the active map, if odometry measured it.
    /// Returns the map that was left, if it is too small to be kept.
    pub fn start_new_map(&mut self, before_from_map: Option<UncertainPose>) -> Option<SubMap> {
        let before = self.active.id;
        let id = self.next_id();
        let empty = SubMap::new(id, LandmarkMap::default(), self.active.place_index.vocabulary());
        let left = std::mem::replace(&mut self.active, empty);
        let is_kept = left.map.keyframe_count() >= MIN_KEPT_KEYFRAMES;
        let mut dropped = Some(left);
        if is_kept {
            self.inactive.extend(dropped.take());
            self.inactive.sort_by_key(|map| map.id);
        }
        self.pending_merge = None;
        let link = before_from_map.map(|before_from_map| SubmapLink { map: id, before, before_from_map });
        // Without a dropped map, the link starts at the map before the dropped one.
        let joined = || self.submap_link.zip(link).and_then(|(first, second)| first.then(second));
        self.submap_link = if is_kept { link } else { joined() };
        dropped
    }

    /// An id that no map has had, since callers identify poses by the map's id.
    fn next_id(&mut self) -> MapId {
        let newest = self.inactive.iter().map(|map| map.id.0).fold(self.active.id.0, u32::max);
        self.newest_map_id = self.newest_map_id.max(newest).saturating_add(1);
        MapId(self.newest_map_id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::blank_frame;
    use nalgebra::{Matrix6, Vector6};
    use trundle_core::Pose3;

    fn with_keyframes(atlas: &mut Atlas, count: usize) {
        (0..count).for_each(|_| _ = atlas.active.map.add_keyframe(blank_frame(1), Pose3::identity()));
    }

    fn moved(x: f64) -> Option<UncertainPose> {
        let pose = Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, 0.0, 0.0));
        Some(UncertainPose { pose, covariance: Matrix6::identity() * 1e-4 })
    }

    #[test]
    fn ids_are_never_used_twice_and_small_maps_are_dropped() {
        let mut atlas = Atlas::new(&Vocabulary::builtin());
        with_keyframes(&mut atlas, MIN_KEPT_KEYFRAMES);
        assert!(atlas.start_new_map(None).is_none());
        with_keyframes(&mut atlas, MIN_KEPT_KEYFRAMES - 1);
        assert_eq!(atlas.start_new_map(None).map(|map| map.id), Some(MapId(1)));
        let ids: Vec<u32> = atlas.maps().iter().map(|map| map.id.number()).collect();
        assert_eq!(ids, [0, 2]);
        assert!(atlas.enter(MapId(0)) && !atlas.enter(MapId(0)) && !atlas.enter(MapId(1)));
        assert_eq!((atlas.active.id, atlas.inactive[0].id), (MapId(0), MapId(2)));
    }

    #[test]
    fn a_link_leads_over_a_dropped_map_unless_part_of_the_motion_is_unknown() {
        let mut atlas = Atlas::new(&Vocabulary::builtin());
        with_keyframes(&mut atlas, MIN_KEPT_KEYFRAMES);
        atlas.start_new_map(moved(1.0));
        atlas.start_new_map(moved(2.0));
        let link = atlas.submap_link.unwrap();
        assert_eq!((link.before, link.map), (MapId(0), MapId(2)));
        assert!((link.before_from_map.pose.translation.x - 3.0).abs() < 1e-12);
        atlas.start_new_map(None);
        assert!(atlas.submap_link.is_none());
    }
}
