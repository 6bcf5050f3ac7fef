//! The least uncertain path of constraints between two keyframes.

use crate::ids::KeyframeId;
use crate::loop_closing::config::LoopConfig;
use crate::map::landmark_map::LandmarkMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Drift between one keyframe and all others, along the least uncertain path of constraints; each constraint drifts by a
/// fraction of its length and rotation.
///
/// Constraints are the edges of the spanning tree with common landmarks, loops, and odometry. A loop makes a keyframe as certain as the old
/// place, whatever the distance in between.
#[derive(Debug, Clone)]
pub(crate) struct UncertaintyPaths {
    ids: Vec<KeyframeId>,
    paths: Vec<Option<PathUncertainty>>,
}

/// Standard deviations along a path, m and rad.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct PathUncertainty {
    pub translation_sigma: f64,
    pub rotation_sigma: f64,
}

impl PathUncertainty {
    fn plus(self, next: Self) -> Self {
        Self {
            translation_sigma: self.translation_sigma + next.translation_sigma,
            rotation_sigma: self.rotation_sigma + next.rotation_sigma,
        }
    }

    /// The order of paths; a metre counts as a radian. The bits of a non-negative number have the same order as the number.
    fn rank(self) -> u64 {
        (self.translation_sigma + self.rotation_sigma).to_bits()
    }
}

impl UncertaintyPaths {
    /// The paths from one keyframe to all connected ones, by Dijkstra's algorithm. Time: n log n in the keyframes.
    pub fn from(map: &LandmarkMap, start: KeyframeId, config: &LoopConfig) -> Self {
        let ids: Vec<KeyframeId> = map.keyframe_ids().collect();
        let edges = edges(map, &ids, config);
        let mut paths: Vec<Option<PathUncertainty>> = vec![None; ids.len()];
        let mut open = BinaryHeap::new();
        if let Ok(start) = ids.binary_search(&start) {
            paths[start] = Some(PathUncertainty::default());
            open.push(Reverse((PathUncertainty::default().rank(), start)));
        }
        while let Some(Reverse((rank, at))) = open.pop() {
            let Some(path) = paths[at].filter(|path| path.rank() == rank) else { continue };
            for (to, edge) in &edges[at] {
                let extended = path.plus(*edge);
                if paths[*to].is_none_or(|before| extended.rank() < before.rank()) {
                    paths[*to] = Some(extended);
                    open.push(Reverse((extended.rank(), *to)));
                }
            }
        }
        Self { ids, paths }
    }

    /// The path to a keyframe; `None` if constraints do not connect it.
    pub fn to(&self, id: KeyframeId) -> Option<PathUncertainty> {
        self.paths[self.ids.binary_search(&id).ok()?]
    }
}

/// The constraints of each keyframe, in both directions: index of the other keyframe, and drift.
fn edges(map: &LandmarkMap, ids: &[KeyframeId], config: &LoopConfig) -> Vec<Vec<(usize, PathUncertainty)>> {
    let mut edges = vec![Vec::new(); ids.len()];
    for (at, (_, keyframe)) in map.keyframes().enumerate() {
        let parent = keyframe.tree.parent.iter().filter(|_| !keyframe.tree.shares_no_landmark);
        let seen = parent.chain(&keyframe.tree.loops).map(|id| (*id, config.drift_part));
        let odometry = keyframe.odometry.iter().map(|odometry| (odometry.from, config.drift_part_on_wheels));
        for (other, part) in seen.chain(odometry) {
            let Ok(to) = ids.binary_search(&other) else { continue };
            let step = keyframe.visual_from_camera.inverse() * map.keyframe(other).visual_from_camera;
            let path = PathUncertainty {
                translation_sigma: part * step.translation.norm(),
                rotation_sigma: part * step.angle(),
            };
            edges[at].push((to, path));
            edges[to].push((at, path));
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::odometry_factor::OdometryFactor;
    use crate::testing::blank_frame;
    use trundle_core::{Pose3, Vector3};

    /// Keyframes along a line; each observes the landmarks of the keyframe before.
    fn line(xs: &[f64]) -> (LandmarkMap, Vec<KeyframeId>) {
        let mut map = LandmarkMap::default();
        let along = |x: f64| Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * x);
        let ids: Vec<_> = xs.iter().map(|x| map.add_keyframe(blank_frame(1), along(*x))).collect();
        ids.windows(2).for_each(|pair| map.set_parent(pair[1], pair[0]));
        (map, ids)
    }

    /// Drift between two keyframes: 1 % along common landmarks and 0.3 % along odometry.
    fn off(map: &LandmarkMap, a: KeyframeId, b: KeyframeId) -> f64 {
        let config = LoopConfig { drift_part: 0.01, drift_part_on_wheels: 0.003, ..Default::default() };
        let path = |from, to| UncertaintyPaths::from(map, from, &config).to(to).unwrap();
        let (there, back) = (path(a, b), path(b, a));
        assert!(
            (there.translation_sigma - back.translation_sigma).abs() < 1e-12 && there.rotation_sigma == 0.0
        );
        there.translation_sigma
    }

    #[test]
    fn drift_adds_up_along_a_path_and_odometry_drifts_less() {
        let (mut map, ids) = line(&[0.0, 1.0, 3.0, 0.5]);
        assert!((off(&map, ids[0], ids[3]) - 0.055).abs() < 1e-12);
        map.keyframe_mut(ids[2]).odometry = Some(OdometryFactor::at(ids[1]));
        assert!((off(&map, ids[0], ids[3]) - 0.041).abs() < 1e-12);
        assert!(map.remove_keyframe(ids[2]));
        assert!((off(&map, ids[0], ids[3]) - 0.015).abs() < 1e-12, "what hung under it hangs higher");
    }

    #[test]
    fn a_loop_makes_a_keyframe_as_certain_as_the_place() {
        let (mut map, ids) = line(&[0.0, 10.0, 20.0, 10.0, 0.5, 10.0]);
        assert!((off(&map, ids[0], ids[5]) - 0.49).abs() < 1e-12);
        map.add_loop_edge(ids[0], ids[4]);
        assert!((off(&map, ids[0], ids[5]) - 0.1).abs() < 1e-12);
        assert!((off(&map, ids[1], ids[3]) - 0.2).abs() < 1e-12, "as before where that is surer");
    }

    #[test]
    fn a_parent_without_common_landmarks_is_not_a_constraint() {
        let (mut map, ids) = line(&[0.0, 1.0, 2.0]);
        map.keyframe_mut(ids[1]).tree.shares_no_landmark = true;
        let config = LoopConfig::default();
        assert_eq!(UncertaintyPaths::from(&map, ids[0], &config).to(ids[2]), None);
        map.keyframe_mut(ids[1]).odometry = Some(OdometryFactor::at(ids[0]));
        assert!((off(&map, ids[0], ids[2]) - 0.013).abs() < 1e-12);
        assert!(map.remove_keyframe(ids[1]));
        assert_eq!(
            UncertaintyPaths::from(&map, ids[0], &config).to(ids[2]),
            None,
            "nor to what hung under it"
        );
    }

    #[test]
    fn without_a_path_there_is_no_drift() {
        let (map, ids) = line(&[0.0, 1.0]);
        let (nobody, config) = (KeyframeId::from_index(7), LoopConfig::default());
        assert_eq!(UncertaintyPaths::from(&map, ids[0], &config).to(nobody), None);
        assert_eq!(UncertaintyPaths::from(&map, nobody, &config).to(ids[0]), None);
    }
}
