use crate::ids::{KeyframeId, LandmarkId};
use crate::map::LandmarkMap;

impl LandmarkMap {
    /// The keyframes that see any of these landmarks, and how many each; most first, then newest first.
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

    /// The other keyframes that share at least `least` landmarks with `keyframe`, most shared first: its neighbours in
    /// the covisibility graph, read off the observations.
    pub fn covisible(&self, keyframe: KeyframeId, least: usize) -> Vec<(KeyframeId, usize)> {
        let mut others = self.keyframes_seeing(self.keyframe(keyframe).landmarks.iter().flatten().copied());
        others.retain(|(id, shared)| *id != keyframe && *shared >= least);
        others
    }
}

#[cfg(test)]
mod tests {
    use crate::map::LandmarkMap;
    use crate::testing::blank_frame;
    use trundle_core::{Pose3, Vector3};

    #[test]
    fn neighbours_come_by_shared_landmarks() {
        let mut map = LandmarkMap::default();
        let k: Vec<_> = (0..4).map(|_| map.add_keyframe(blank_frame(8), Pose3::identity())).collect();
        for (feature, seen_by) in [vec![0, 1], vec![0, 2], vec![0, 2], vec![3]].iter().enumerate() {
            let landmark = map.add_landmark(Vector3::zeros());
            seen_by.iter().for_each(|i| assert!(map.observe(landmark, k[*i], feature)));
        }
        assert_eq!(map.covisible(k[0], 1), vec![(k[2], 2), (k[1], 1)]);
        assert_eq!(map.covisible(k[0], 2), vec![(k[2], 2)]);
        assert_eq!(map.covisible(k[3], 1), vec![]);
    }
}
