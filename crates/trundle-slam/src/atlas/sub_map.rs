//! One map with its own frame, its index of places and its optimisation.

use crate::ids::{KeyframeId, LandmarkId, MapId};
use crate::map::keyframe::Keyframe;
use crate::map::landmark::Landmark;
use crate::map::landmark_map::LandmarkMap;
use crate::map::odometry_factor::OdometryFactor;
use crate::optimisation::map_optimisation::MapOptimisation;
use crate::place_recognition::keyframe_index::KeyframeIndex;
use nalgebra::Matrix6;
use std::collections::BTreeMap;
use std::sync::Arc;
use trundle_core::Pose3;
use trundle_vision::Vocabulary;

/// A map with its own frame \[Campos21, sec. VI\].
#[derive(Debug, Clone)]
pub(crate) struct SubMap {
    pub id: MapId,
    pub map: LandmarkMap,
    pub place_index: KeyframeIndex,
    /// The running bundle adjustments.
    pub optimisation: MapOptimisation,
}

/// Ids of keyframes and landmarks in the map that absorbed them, by their old ids.
#[derive(Debug, Default)]
pub(crate) struct IdMap {
    pub keyframes: BTreeMap<KeyframeId, KeyframeId>,
    pub landmarks: BTreeMap<LandmarkId, LandmarkId>,
}

impl SubMap {
    pub fn new(id: MapId, map: LandmarkMap, vocabulary: &Arc<Vocabulary>) -> Self {
        let place_index = KeyframeIndex::new(Arc::clone(vocabulary));
        let mut sub_map = Self { id, map, place_index, optimisation: MapOptimisation::default() };
        sub_map.update_index();
        sub_map
    }

    /// Sets the vocabulary that describes the keyframes.
    pub fn set_vocabulary(&mut self, vocabulary: &Arc<Vocabulary>) {
        self.place_index = KeyframeIndex::new(Arc::clone(vocabulary));
        self.update_index();
    }

    /// Updates the place index to the map.
    pub fn update_index(&mut self) {
        self.place_index.update(&self.map);
    }

    /// Moves the content of a map at `own_from_other` into this one; `covariance` is that of the common keyframe's pose.
    pub fn absorb(&mut self, other: &LandmarkMap, own_from_other: Pose3, covariance: Matrix6<f64>) -> IdMap {
        let mut ids = IdMap::default();
        for (old, keyframe) in other.keyframes() {
            let new = self.absorb_keyframe(keyframe, own_from_other, covariance, &ids);
            ids.keyframes.insert(old, new);
        }
        for (old, landmark) in other.landmarks() {
            let new = self.absorb_landmark(landmark, own_from_other, &ids);
            ids.landmarks.insert(old, new);
        }
        ids.keyframes.values().for_each(|id| self.map.add_to_spanning_tree(*id));
        for (old, new) in other.loops() {
            self.map.add_loop_edge(ids.keyframes[&old], ids.keyframes[&new]);
        }
        self.update_index();
        ids
    }

    fn absorb_keyframe(
        &mut self,
        keyframe: &Keyframe,
        own_from_other: Pose3,
        covariance: Matrix6<f64>,
        ids: &IdMap,
    ) -> KeyframeId {
        let pose = (own_from_other * keyframe.visual_from_camera).renormalized();
        let new = self.map.add_keyframe(keyframe.frame.clone(), pose);
        let whole = keyframe.covariance + covariance;
        self.map.set_covariances(new, whole, keyframe.map_covariance + covariance);
        let moved = |factor: OdometryFactor| {
            Some(OdometryFactor { from: *ids.keyframes.get(&factor.from)?, ..factor })
        };
        self.map.keyframe_mut(new).odometry = keyframe.odometry.and_then(moved);
        new
    }

    fn absorb_landmark(&mut self, landmark: &Landmark, own_from_other: Pose3, ids: &IdMap) -> LandmarkId {
        let new = self.map.add_landmark(landmark.position);
        for (keyframe, feature) in &landmark.observations {
            self.map.observe(new, ids.keyframes[keyframe], *feature);
        }
        if let Some(absorbed) = self.map.landmark_mut(new) {
            let observations = std::mem::take(&mut absorbed.observations);
            *absorbed = Landmark { observations, ..landmark.clone() };
            absorbed.transform(&own_from_other);
        }
        new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::landmark_map::tests::assert_consistent;
    use crate::testing::map_of_one_view;
    use nalgebra::Vector6;

    #[test]
    fn an_absorbed_map_is_consistent_and_stands_at_its_pose() {
        let (map, _) = map_of_one_view(20);
        let (other, seen) = map_of_one_view(30);
        let mut sub_map = SubMap::new(MapId(0), map, &Vocabulary::builtin());
        let own_from_other = Pose3::exp(Vector6::new(1.0, 2.0, 0.5, 0.1, 0.4, 0.0));
        let ids = sub_map.absorb(&other, own_from_other, Matrix6::identity());
        assert_consistent(&sub_map.map);
        assert_eq!((sub_map.map.keyframe_count(), sub_map.map.landmark_count()), (2, 50));
        let absorbed = sub_map.map.keyframe(ids.keyframes[&seen]);
        assert!((absorbed.visual_from_camera.inverse() * own_from_other).log().norm() < 1e-12);
        assert_eq!(absorbed.covariance, Matrix6::identity(), "that of the common keyframe");
        for (old, landmark) in other.landmarks() {
            let new = sub_map.map.landmark(ids.landmarks[&old]).unwrap();
            assert!((new.position - own_from_other.transform(landmark.position)).norm() < 1e-12);
        }
    }
}
