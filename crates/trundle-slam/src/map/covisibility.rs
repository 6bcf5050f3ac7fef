//! Which keyframes see the same landmarks.

use crate::ids::KeyframeId;
use crate::map::landmark_map::LandmarkMap;
use trundle_core::Pose3;

/// Fewest landmarks that two keyframes share to count as neighbours: 15. Source: \[MurArtal17\].
pub(crate) const MIN_SHARED_LANDMARKS: usize = 15;

/// The keyframes that a camera at a pose may share landmarks with: near keyframes with a similar direction, the nearest first, and the
/// keyframes covisible with the nearest ones.
pub(crate) fn keyframes_around(map: &LandmarkMap, visual_from_camera: Pose3) -> Vec<KeyframeId> {
    let nearest = nearest_keyframes(map, visual_from_camera, MAX_NEAR_KEYFRAMES);
    let mut around = nearest.clone();
    for id in nearest.into_iter().take(EXPANDED_KEYFRAMES) {
        let neighbours = map.covisible(id, MIN_SHARED_LANDMARKS).into_iter().map(|(id, _)| id);
        around.extend(neighbours.take(MAX_NEIGHBOURS));
    }
    around.sort_unstable();
    around.dedup();
    around
}

/// The keyframes near a camera pose with a similar direction, the nearest first.
pub(crate) fn nearest_keyframes(
    map: &LandmarkMap,
    visual_from_camera: Pose3,
    max_count: usize,
) -> Vec<KeyframeId> {
    let inverse = visual_from_camera.inverse();
    let rank = |id: KeyframeId| {
        let offset = inverse * map.keyframe(id).visual_from_camera;
        (offset.translation.norm() / NEAR_KEYFRAME_M + offset.angle() / NEAR_KEYFRAME_RAD, id)
    };
    let near = map.keyframes_near(visual_from_camera.translation, NEAR_KEYFRAME_M);
    let mut ranked: Vec<(f64, KeyframeId)> = near.into_iter().map(rank).filter(|(r, _)| *r <= 2.0).collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    ranked.into_iter().take(max_count).map(|(_, id)| id).collect()
}

/// Largest distance of a keyframe that may show the same landmarks: 3 m, most of a room. The allowed rotation grows with proximity. Source:
/// ours.
const NEAR_KEYFRAME_M: f64 = 3.0;
/// Largest rotation of a keyframe that may show the same landmarks: 1.2 rad, the field of view of a Kinect. Source: as [`NEAR_KEYFRAME_M`].
const NEAR_KEYFRAME_RAD: f64 = 1.2;
/// Maximum number of near keyframes: 20. Source: ours.
const MAX_NEAR_KEYFRAMES: usize = 20;
/// Number of nearest keyframes whose covisible keyframes are added: 3. Source: ours.
const EXPANDED_KEYFRAMES: usize = 3;
/// Maximum number of covisible keyframes of each nearest one: 15. Source: ours.
const MAX_NEIGHBOURS: usize = 15;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::blank_frame;
    use nalgebra::Vector6;
    use trundle_core::Vector3;

    #[test]
    fn neighbours_are_ordered_by_shared_landmarks() {
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
    fn keyframes_around_are_near_with_a_similar_direction_or_covisible_with_these() {
        let mut map = LandmarkMap::default();
        let mut at = |x: f64, turn: f64| {
            map.add_keyframe(blank_frame(20), Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, turn, 0.0)))
        };
        let (near, behind, far, connected) = (at(0.1, 0.1), at(0.1, 3.0), at(9.0, 0.0), at(7.0, 0.5));
        for feature in 0..20 {
            let landmark = map.add_landmark(Vector3::zeros());
            assert!(map.observe(landmark, near, feature) && map.observe(landmark, connected, feature));
        }
        assert_eq!(keyframes_around(&map, Pose3::identity()), vec![near, connected]);
        assert!(!keyframes_around(&map, Pose3::identity()).contains(&behind));
        assert_eq!(keyframes_around(&map, map.keyframe(far).visual_from_camera), vec![near, far, connected]);
    }
}
