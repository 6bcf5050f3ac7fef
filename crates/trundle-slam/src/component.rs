use crate::ids::{KeyframeId, LandmarkId};
use crate::map::LandmarkMap;
use crate::places::Places;
use crate::report::MapId;
use crate::rolled::Rolled;
use nalgebra::Matrix6;
use std::collections::BTreeMap;
use std::sync::Arc;
use trundle_core::Pose3;
use trundle_vision::Vocabulary;

/// A map with a frame of its own, and the places in it \[Campos21, sec. VI\].
#[derive(Debug, Clone)]
pub(crate) struct Component {
    pub id: MapId,
    pub map: LandmarkMap,
    pub places: Places,
}

/// What keyframes and landmarks are called in the map that took them over.
#[derive(Debug, Default)]
pub(crate) struct Renamed {
    pub keyframes: BTreeMap<KeyframeId, KeyframeId>,
    pub landmarks: BTreeMap<LandmarkId, LandmarkId>,
}

impl Component {
    pub fn new(id: MapId, map: LandmarkMap, vocabulary: &Arc<Vocabulary>) -> Self {
        let places = Places::new(Arc::clone(vocabulary));
        let mut component = Self { id, map, places };
        component.follow();
        component
    }

    /// Finds places by the words of another vocabulary from now on.
    pub fn describe_by(&mut self, vocabulary: &Arc<Vocabulary>) {
        self.places = Places::new(Arc::clone(vocabulary));
        self.follow();
    }

    /// Brings the places up to date with the map.
    pub fn follow(&mut self) {
        self.places.follow(&self.map);
    }

    /// Takes over another map that stands at `own_from_other`, known by a keyframe that is as uncertain as `seam`.
    pub fn absorb(&mut self, other: &LandmarkMap, own_from_other: Pose3, seam: Matrix6<f64>) -> Renamed {
        let mut renamed = Renamed::default();
        for (old, keyframe) in other.keyframes() {
            let pose = (own_from_other * keyframe.visual_from_camera).renormalized();
            let new = self.map.add_keyframe(keyframe.frame.clone(), pose);
            self.map.set_covariances(new, keyframe.covariance + seam, keyframe.ground + seam);
            let rolled = keyframe.rolled.filter(|rolled| renamed.keyframes.contains_key(&rolled.from));
            self.map.keyframe_mut(new).rolled =
                rolled.map(|rolled| Rolled { from: renamed.keyframes[&rolled.from], ..rolled });
            renamed.keyframes.insert(old, new);
        }
        for (old, landmark) in other.landmarks() {
            let new = self.map.add_landmark(landmark.position);
            for (keyframe, feature) in &landmark.observations {
                self.map.observe(new, renamed.keyframes[keyframe], *feature);
            }
            if let Some(taken) = self.map.landmark_mut(new) {
                taken.descriptor = landmark.descriptor;
                taken.toward_camera = landmark.toward_camera;
                taken.looks = landmark.looks.clone();
                taken.carry(&own_from_other);
                taken.distance_at_octave_0 = landmark.distance_at_octave_0;
                (taken.visible, taken.found) = (landmark.visible, landmark.found);
            }
            renamed.landmarks.insert(old, new);
        }
        renamed.keyframes.values().for_each(|id| self.map.enter_tree(*id));
        for (old, new) in other.loops() {
            self.map.tie(renamed.keyframes[&old], renamed.keyframes[&new]);
        }
        self.follow();
        renamed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::tests::assert_consistent;
    use crate::testing::map_of_one_view;
    use nalgebra::Vector6;

    #[test]
    fn what_is_taken_over_stands_where_it_should_and_is_whole() {
        let (map, _) = map_of_one_view(20);
        let (other, seen) = map_of_one_view(30);
        let mut component = Component::new(MapId(0), map, &Vocabulary::builtin());
        let moved = Pose3::exp(Vector6::new(1.0, 2.0, 0.5, 0.1, 0.4, 0.0));
        let renamed = component.absorb(&other, moved, Matrix6::identity());
        assert_consistent(&component.map);
        assert_eq!((component.map.keyframe_count(), component.map.landmark_count()), (2, 50));
        let taken = component.map.keyframe(renamed.keyframes[&seen]);
        assert!((taken.visual_from_camera.inverse() * moved).log().norm() < 1e-12);
        assert_eq!(taken.covariance, Matrix6::identity(), "as uncertain as the seam");
        for (old, landmark) in other.landmarks() {
            let new = component.map.landmark(renamed.landmarks[&old]).unwrap();
            assert!((new.position - moved.transform(landmark.position)).norm() < 1e-12);
        }
    }
}
