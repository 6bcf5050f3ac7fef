use crate::ids::KeyframeId;
use crate::ids::LandmarkId;
use crate::map::landmark_map::LandmarkMap;
use trundle_core::Pose3;

/// Landmarks that tie two keyframes to one place \[MurArtal17\].
pub(crate) const MIN_SHARED_LANDMARKS: usize = 15;

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

    /// The keyframes that a camera at a pose may share landmarks with: those near by that look about the same way, the
    /// nearest first, and what is covisible with the first of them.
    pub fn around(&self, visual_from_camera: Pose3) -> Vec<KeyframeId> {
        let inverse = visual_from_camera.inverse();
        let rank = |id: KeyframeId| {
            let offset = inverse * self.keyframe(id).visual_from_camera;
            (offset.translation.norm() / REACH + offset.angle() / TURN, id)
        };
        let near = self.keyframes_near(visual_from_camera.translation, REACH);
        let mut ranked: Vec<(f64, KeyframeId)> =
            near.into_iter().map(rank).filter(|(r, _)| *r <= 2.0).collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let nearest = |most: usize| ranked.iter().take(most).map(|(_, id)| *id);
        let mut around: Vec<KeyframeId> = nearest(NEAREST).collect();
        for id in nearest(ASKED) {
            let neighbours = self.covisible(id, MIN_SHARED_LANDMARKS).into_iter().map(|(id, _)| id);
            around.extend(neighbours.take(NEIGHBOURS));
        }
        around.sort_unstable();
        around.dedup();
        around
    }
}

/// How far away (m) and how much turned (rad) a keyframe may be to show a good part of the same things: most of a room, and a
/// Kinect's field of view. What is near may be turned by as much again, and the other way round.
const REACH: f64 = 3.0;
const TURN: f64 = 1.2;
/// Keyframes that are looked at because they are near.
const NEAREST: usize = 20;
/// Of how many of these the covisible ones are looked at as well, and how many of each, if they share this many landmarks.
const ASKED: usize = 3;
const NEIGHBOURS: usize = 15;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::blank_frame;
    use nalgebra::Vector6;
    use trundle_core::Vector3;

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
    #[test]
    fn what_is_around_is_near_and_looks_the_same_way_or_is_tied_to_that() {
        let mut map = LandmarkMap::default();
        let mut at = |x: f64, turn: f64| {
            map.add_keyframe(blank_frame(20), Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, turn, 0.0)))
        };
        let (near, behind, far, connected) = (at(0.1, 0.1), at(0.1, 3.0), at(9.0, 0.0), at(7.0, 0.5));
        for feature in 0..20 {
            let landmark = map.add_landmark(Vector3::zeros());
            assert!(map.observe(landmark, near, feature) && map.observe(landmark, connected, feature));
        }
        assert_eq!(map.around(Pose3::identity()), vec![near, connected]);
        assert!(!map.around(Pose3::identity()).contains(&behind));
        assert_eq!(map.around(map.keyframe(far).visual_from_camera), vec![near, far, connected]);
    }
}
