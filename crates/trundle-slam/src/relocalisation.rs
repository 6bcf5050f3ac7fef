use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use trundle_core::Pose3;

/// The keyframes that a lost camera should be compared with at its `attempt`-th frame (from 0), best first, at most
/// `most`: those near where it is believed to be, and each time others of the rest, so that all have their turn.
///
/// This is the seam for place recognition: with a bag of words \[GalvezLopez12\] the candidates come by likeness instead.
pub(crate) fn candidates(map: &LandmarkMap, believed: Pose3, attempt: usize, most: usize) -> Vec<KeyframeId> {
    let mut ranked: Vec<(f64, KeyframeId)> = map
        .keyframes()
        .map(|(id, keyframe)| {
            let offset = keyframe.visual_from_camera.inverse() * believed;
            (offset.translation.norm() + offset.angle(), id)
        })
        .collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    let near = most.div_ceil(2).min(ranked.len());
    let rest = ranked.split_off(near);
    let turn = attempt * (most - most.div_ceil(2)) % rest.len().max(1);
    let others = rest.iter().cycle().skip(turn).take((most - near).min(rest.len()));
    ranked.iter().chain(others).map(|(_, id)| *id).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::blank_frame;
    use trundle_core::Vector3;

    #[test]
    fn the_nearest_come_first_and_all_have_their_turn() {
        let mut map = LandmarkMap::default();
        let along = |i: usize| Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * i as f64);
        let ids: Vec<_> = (0..9).map(|i| map.add_keyframe(blank_frame(1), along(i))).collect();
        let mut seen = std::collections::BTreeSet::new();
        for attempt in 0..4 {
            let chosen = candidates(&map, along(4), attempt, 5);
            assert_eq!((chosen.len(), chosen[0]), (5, ids[4]));
            seen.extend(chosen);
        }
        assert_eq!(seen.len(), 9);
        assert_eq!(candidates(&LandmarkMap::default(), along(0), 3, 5), vec![]);
    }
}
