//! Removes redundant keyframes.

use crate::ids::KeyframeId;
use crate::local_mapping::keyframe_policy::KeyframeConfig;
use crate::map::landmark::Landmark;
use crate::map::landmark_map::LandmarkMap;

/// Smallest number of other keyframes with a landmark at which a keyframe is not needed for it: 3. Source: \[MurArtal17\].
const MIN_OTHER_OBSERVERS: usize = 3;
/// Smallest fraction of redundant landmarks at which a keyframe is removed: 0.9. Source: \[MurArtal17\].
const MIN_REDUNDANT_RATIO: f64 = 0.9;
/// Number of newest keyframes that are never removed: 5. Tracking depends on these keyframes, and their landmarks are not yet confirmed.
/// Source: ours.
const KEPT_NEWEST_KEYFRAMES: usize = 5;
/// Maximum number of keyframes that are checked for each new one: 20. Source: ours.
const MAX_CHECKED_KEYFRAMES: usize = 20;

/// Removes keyframes around a new one that are redundant: those 90 % of whose landmarks are seen by three others at the same or a finer
/// scale \[MurArtal17\]. The first keyframe stays, as do the newest, those that close a loop, and those whose removal would cause a new
/// keyframe. Returns the number removed.
pub(crate) fn cull_keyframes(map: &mut LandmarkMap, new: KeyframeId, config: &KeyframeConfig) -> usize {
    let around = map.covisible(new, 1).into_iter().map(|(id, _)| id).take(MAX_CHECKED_KEYFRAMES);
    let Some(newest) = map.keyframe_ids().rev().nth(KEPT_NEWEST_KEYFRAMES) else { return 0 };
    let candidates: Vec<KeyframeId> = around.filter(|id| *id <= newest).collect();
    let mut removed = 0;
    for id in candidates {
        let is_tied = !map.keyframe(id).tree.loops.is_empty();
        if !is_tied && config.is_covered_without(map, id) && is_redundant(map, id) {
            removed += usize::from(map.remove_keyframe(id));
        }
    }
    removed
}

fn is_redundant(map: &LandmarkMap, id: KeyframeId) -> bool {
    let keyframe = map.keyframe(id);
    let seen = || keyframe.landmarks.iter().enumerate().filter_map(|(f, l)| Some((f, map.landmark((*l)?)?)));
    let max_needed = ((1.0 - MIN_REDUNDANT_RATIO) * seen().count() as f64).floor() as usize;
    let needed = seen().filter(|(feature, l)| is_needed(map, id, keyframe.frame.octave(*feature), l));
    needed.take(max_needed + 1).count() <= max_needed
}

/// Whether fewer than three other keyframes see a landmark at the same or a finer scale.
fn is_needed(map: &LandmarkMap, id: KeyframeId, octave: u8, landmark: &Landmark) -> bool {
    let as_fine = |(other, feature): &&(KeyframeId, usize)| {
        *other != id && map.keyframe(*other).frame.octave(*feature) <= octave
    };
    landmark.observations.len() <= MIN_OTHER_OBSERVERS
        || landmark.observations.iter().filter(as_fine).take(MIN_OTHER_OBSERVERS).count()
            < MIN_OTHER_OBSERVERS
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::landmark_map::tests::assert_consistent;
    use crate::testing::frame_with_depth;
    use nalgebra::Vector6;
    use trundle_core::{Pose3, Vector3};

    /// Keyframes a few cm apart with the same observations, except those of `own`.
    fn crowd(own: &[(usize, usize)]) -> (LandmarkMap, Vec<KeyframeId>) {
        let mut map = LandmarkMap::default();
        let ids: Vec<KeyframeId> = (0..12)
            .map(|i| {
                let pose = Pose3::exp(Vector6::new(0.04 * f64::from(i), 0.0, 0.0, 0.0, 0.0, 0.0));
                map.add_keyframe(frame_with_depth(40), pose)
            })
            .collect();
        for feature in 0..40 {
            let landmark = map.add_landmark(Vector3::z());
            let single_view_landmark_moves = own.iter().find(|(_, f)| *f == feature).map(|(k, _)| ids[*k]);
            for id in ids.iter().filter(|id| {
                single_view_landmark_moves
                    .is_none_or(|single_view_landmark_moves| single_view_landmark_moves == **id)
            }) {
                map.observe(landmark, *id, feature);
            }
        }
        ids.iter().for_each(|id| map.add_to_spanning_tree(*id));
        (map, ids)
    }

    #[test]
    fn redundant_keyframes_are_removed() {
        let config = KeyframeConfig::default();
        // Keyframe 3 alone observes 5 of its 40: more than a tenth. Keyframe 4 observes two alone.
        let own = [(3, 30), (3, 31), (3, 32), (3, 33), (3, 34), (4, 35), (4, 36)];
        let (mut map, ids) = crowd(&own);
        map.add_loop_edge(ids[2], ids[11]);
        let gone = cull_keyframes(&mut map, ids[11], &config);
        let left: Vec<usize> = map.keyframe_ids().map(KeyframeId::index).collect();
        // Left: the first, the one in a loop, the needed one, and the five newest before the last.
        assert_eq!((gone, left), (4, vec![0, 2, 3, 7, 8, 9, 10, 11]));
        assert_consistent(&map);
        assert_eq!(cull_keyframes(&mut map, ids[11], &config), 0);
    }

    #[test]
    fn a_place_keeps_at_least_one_keyframe() {
        let config = KeyframeConfig { min_translation: 0.01, max_translation: 0.015, ..Default::default() };
        let (mut map, ids) = crowd(&[]);
        assert_eq!(cull_keyframes(&mut map, ids[11], &config), 0);
    }
}
