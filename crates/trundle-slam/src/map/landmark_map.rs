//! Keyframes, landmarks, and the observations between them.

use crate::frame::observation_model::ObservationModel;
use crate::frame::rgbd_frame::Frame;
use crate::ids::{KeyframeId, LandmarkId};
use crate::map::arena::Arena;
use crate::map::keyframe::Keyframe;
use crate::map::keyframe_grid::KeyframeGrid;
use crate::map::landmark::Landmark;
use crate::map::tree_node::TreeNode;
use nalgebra::Matrix6;
use trundle_core::{Pose3, Vector3};

/// Keyframes and landmarks in two arenas, and the observations between them.
///
/// Invariant: feature `f` of keyframe `k` has landmark `l` exactly if both are alive and `l` has the observation `(k, f)`.
#[derive(Debug, Clone, Default)]
pub(crate) struct LandmarkMap {
    pub(crate) keyframes: Arena<Keyframe>,
    landmarks: Arena<Landmark>,
    /// The keyframes by position.
    pub(crate) grid: KeyframeGrid,
    /// The axis around which a camera on a floor turns, camera frame.
    pub(crate) floor: Option<Vector3>,
    /// Removed keyframes by id: the successor of each, and the pose relative to the successor.
    pub(crate) removed: std::collections::BTreeMap<KeyframeId, (KeyframeId, Pose3)>,
}

impl LandmarkMap {
    /// The keyframe. Panics if it was removed.
    pub fn keyframe(&self, id: KeyframeId) -> &Keyframe {
        self.keyframes.get(id.index()).expect("invariant: the keyframe is alive")
    }

    /// The keyframe, unless it was removed.
    pub fn live_keyframe(&self, id: KeyframeId) -> Option<&Keyframe> {
        self.keyframes.get(id.index())
    }

    /// The live keyframes, by rising id, which is the order of their creation.
    pub fn keyframes(&self) -> impl DoubleEndedIterator<Item = (KeyframeId, &Keyframe)> {
        self.keyframes.iter().map(|(i, k)| (KeyframeId::from_index(i), k))
    }

    /// Ids of the live keyframes, by rising id.
    pub fn keyframe_ids(&self) -> impl DoubleEndedIterator<Item = KeyframeId> + '_ {
        self.keyframes().map(|(id, _)| id)
    }

    /// Number of live keyframes.
    pub fn keyframe_count(&self) -> usize {
        self.keyframes.len()
    }

    /// Upper bound of all keyframe indices, exclusive.
    pub fn keyframe_bound(&self) -> usize {
        self.keyframes.bound()
    }

    /// The oldest keyframe, which holds the map in place; `None` for an empty map.
    pub fn first_keyframe(&self) -> Option<KeyframeId> {
        self.keyframe_ids().next()
    }

    /// The newest keyframe; `None` for an empty map.
    pub fn newest_keyframe(&self) -> Option<KeyframeId> {
        self.keyframe_ids().next_back()
    }

    /// The landmark, unless it was removed.
    pub fn landmark(&self, id: LandmarkId) -> Option<&Landmark> {
        self.landmarks.get(id.index())
    }

    pub fn landmark_mut(&mut self, id: LandmarkId) -> Option<&mut Landmark> {
        self.landmarks.get_mut(id.index())
    }

    pub fn landmarks(&self) -> impl Iterator<Item = (LandmarkId, &Landmark)> {
        self.landmarks.iter().map(|(i, l)| (LandmarkId::from_index(i), l))
    }

    pub fn landmark_count(&self) -> usize {
        self.landmarks.len()
    }

    /// Upper bound of all landmark indices, exclusive.
    pub fn landmark_bound(&self) -> usize {
        self.landmarks.bound()
    }

    /// The keyframes within a cube of about twice `reach` (m) around a position, by rising id.
    pub fn keyframes_near(&self, position: Vector3, reach: f64) -> Vec<KeyframeId> {
        self.grid.near(position, reach)
    }

    /// A new keyframe without observations.
    pub fn add_keyframe(&mut self, frame: Frame, visual_from_camera: Pose3) -> KeyframeId {
        let landmarks = vec![None; frame.len()];
        let (covariance, map_covariance, tree) = (Matrix6::zeros(), Matrix6::zeros(), TreeNode::default());
        let odometry = None;
        let keyframe =
            Keyframe { frame, visual_from_camera, covariance, map_covariance, landmarks, tree, odometry };
        let id = KeyframeId::from_index(self.keyframes.insert(keyframe));
        self.grid.insert(id, visual_from_camera.translation);
        id
    }

    /// Moves a keyframe, but not its landmarks.
    pub fn move_keyframe(&mut self, id: KeyframeId, visual_from_camera: Pose3) {
        let before = self.keyframe(id).visual_from_camera.translation;
        self.grid.remove(id, before);
        self.grid.insert(id, visual_from_camera.translation);
        self.keyframe_mut(id).visual_from_camera = visual_from_camera;
    }

    /// Sets the same covariance for a keyframe's pose and for its landmarks.
    pub fn set_covariance(&mut self, id: KeyframeId, covariance: Matrix6<f64>) {
        self.set_covariances(id, covariance, covariance);
    }

    /// Sets the covariance of a keyframe's pose, and that of its landmarks.
    pub fn set_covariances(
        &mut self,
        id: KeyframeId,
        covariance: Matrix6<f64>,
        map_covariance: Matrix6<f64>,
    ) {
        let keyframe = self.keyframe_mut(id);
        (keyframe.covariance, keyframe.map_covariance) = (covariance, map_covariance);
    }

    pub(crate) fn keyframe_mut(&mut self, id: KeyframeId) -> &mut Keyframe {
        self.keyframes.get_mut(id.index()).expect("invariant: the keyframe is alive")
    }

    /// A new landmark at `position` (visual frame, m), without observations.
    pub fn add_landmark(&mut self, position: Vector3) -> LandmarkId {
        LandmarkId::from_index(self.landmarks.insert(Landmark::new(position)))
    }

    /// Records that feature `feature` of `keyframe` is of `landmark`. An existing match of the feature or of the landmark in this keyframe
    /// stays. Returns whether the observation was recorded.
    pub fn observe(&mut self, landmark: LandmarkId, keyframe: KeyframeId, feature: usize) -> bool {
        let Some(observer) = self.keyframes.get_mut(keyframe.index()) else { return false };
        let Some(seen) = self.landmarks.get_mut(landmark.index()) else { return false };
        let slot = &mut observer.landmarks[feature];
        if slot.is_some() || seen.observation_in(keyframe).is_some() {
            return false;
        }
        *slot = Some(landmark);
        seen.observations.push((keyframe, feature));
        true
    }

    /// Removes an observation; a landmark without observations is removed.
    pub fn unobserve(&mut self, landmark: LandmarkId, keyframe: KeyframeId) {
        let Some(seen) = self.landmarks.get_mut(landmark.index()) else { return };
        let Some(at) = seen.observations.iter().position(|(k, _)| *k == keyframe) else { return };
        let (_, feature) = seen.observations.remove(at);
        if seen.observations.is_empty() {
            self.landmarks.remove(landmark.index());
        }
        self.keyframe_mut(keyframe).landmarks[feature] = None;
    }

    /// Removes a landmark and all its observations.
    pub fn forget(&mut self, landmark: LandmarkId) {
        let Some(gone) = self.landmarks.remove(landmark.index()) else { return };
        for (keyframe, feature) in gone.observations {
            self.keyframe_mut(keyframe).landmarks[feature] = None;
        }
    }

    /// Moves landmarks with their reference patches, `new_from_old` in the visual frame.
    pub fn transform_landmarks(&mut self, moves: Vec<(LandmarkId, Pose3)>) {
        for (id, new_from_old) in moves {
            if let Some(landmark) = self.landmark_mut(id) {
                landmark.transform(&new_from_old);
            }
        }
    }

    /// Merges two landmarks: `kept` gets the observations of `gone` in keyframes where it has none.
    pub fn merge(&mut self, kept: LandmarkId, gone: LandmarkId) {
        if kept == gone || self.landmark(kept).is_none() {
            return;
        }
        let Some(merged) = self.landmark(gone).cloned() else { return };
        self.forget(gone);
        for (keyframe, feature) in merged.observations {
            self.observe(kept, keyframe, feature);
        }
        if let Some(kept) = self.landmark_mut(kept) {
            if kept.reference_patches.is_empty() {
                kept.reference_patches = merged.reference_patches;
            }
            kept.visible = kept.visible.saturating_add(merged.visible);
            kept.found = kept.found.saturating_add(merged.found);
        }
    }

    /// Counts the landmarks that were expected in a frame, and those found.
    pub fn count_observations(
        &mut self,
        expected: impl Iterator<Item = LandmarkId>,
        found: &[Option<LandmarkId>],
    ) {
        for id in expected {
            if let Some(landmark) = self.landmark_mut(id) {
                landmark.visible = landmark.visible.saturating_add(1);
            }
        }
        for id in found.iter().flatten() {
            if let Some(landmark) = self.landmark_mut(*id) {
                landmark.found = landmark.found.saturating_add(1);
            }
        }
    }

    /// The keyframes that see any of these landmarks, each with its number of them; the largest number first, then the newest.
    pub fn keyframes_seeing(&self, landmarks: impl Iterator<Item = LandmarkId>) -> Vec<(KeyframeId, usize)> {
        let mut counts = vec![0; self.keyframe_bound()];
        for landmark in landmarks.filter_map(|id| self.landmark(id)) {
            for (keyframe, _) in &landmark.observations {
                counts[keyframe.index()] += 1;
            }
        }
        let mut seeing: Vec<(KeyframeId, usize)> = counts
            .into_iter()
            .enumerate()
            .filter(|(_, count)| *count > 0)
            .map(|(i, count)| (KeyframeId::from_index(i), count))
            .collect();
        seeing.sort_by_key(|(id, count)| std::cmp::Reverse((*count, *id)));
        seeing
    }

    /// The other keyframes that share at least `min` landmarks with `keyframe`, the largest number first: its neighbours in
    /// the covisibility graph.
    pub fn covisible(&self, keyframe: KeyframeId, min: usize) -> Vec<(KeyframeId, usize)> {
        let mut others = self.keyframes_seeing(self.keyframe(keyframe).landmarks.iter().flatten().copied());
        others.retain(|(id, shared)| *id != keyframe && *shared >= min);
        others
    }

    /// Updates descriptor, direction and scale of a landmark from its observations.
    pub fn refresh(&mut self, id: LandmarkId, model: &ObservationModel) {
        if let Some(landmark) = self.landmarks.get_mut(id.index()) {
            landmark.refresh(&self.keyframes, model);
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::testing::blank_frame;

    fn map_of(keyframes: usize) -> (LandmarkMap, Vec<KeyframeId>) {
        let mut map = LandmarkMap::default();
        let ids = (0..keyframes).map(|_| map.add_keyframe(blank_frame(5), Pose3::identity())).collect();
        (map, ids)
    }

    pub(crate) fn assert_consistent(map: &LandmarkMap) {
        for (id, landmark) in map.landmarks() {
            assert!(!landmark.observations.is_empty());
            for (keyframe, feature) in &landmark.observations {
                assert_eq!(map.keyframe(*keyframe).landmarks[*feature], Some(id));
            }
        }
        let slots = map.keyframes().flat_map(|(_, k)| &k.landmarks).flatten().count();
        assert_eq!(slots, map.landmarks().map(|(_, l)| l.observations.len()).sum::<usize>());
        assert_eq!(map.landmark_count(), map.landmarks().count());
    }

    #[test]
    fn observations_are_kept_on_both_sides() {
        let (mut map, k) = map_of(2);
        let (a, b) = (map.add_landmark(Vector3::x()), map.add_landmark(Vector3::y()));
        assert!(map.observe(a, k[0], 3) && map.observe(a, k[1], 0) && map.observe(b, k[1], 1));
        assert!(!map.observe(b, k[0], 3), "the feature is taken");
        assert!(!map.observe(a, k[0], 4), "the landmark is seen here already");
        assert_consistent(&map);
        map.unobserve(b, k[1]);
        assert!(map.landmark(b).is_none());
        assert_consistent(&map);
        map.forget(a);
        assert_eq!(map.landmark_count(), 0);
        assert_consistent(&map);
    }

    #[test]
    fn merging_keeps_every_observation_once() {
        let (mut map, k) = map_of(3);
        let (a, b) = (map.add_landmark(Vector3::x()), map.add_landmark(Vector3::x()));
        map.observe(a, k[0], 0);
        map.observe(a, k[1], 1);
        map.observe(b, k[1], 2);
        map.observe(b, k[2], 3);
        map.merge(a, b);
        map.merge(a, a);
        assert!(map.landmark(b).is_none());
        assert_eq!(map.landmark(a).unwrap().observations, vec![(k[0], 0), (k[1], 1), (k[2], 3)]);
        assert_consistent(&map);
    }
}
