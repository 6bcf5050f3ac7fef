use super::LoopConfig;
use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How far off keyframes may be against one of them: along the surest way of ties between them, each off by a part of its
/// length and turn.
///
/// Ties are the spanning tree where it is of common sight, loops, and the wheels' ways. What a loop has tied to an old place is as sure as that place,
/// however far the camera went between.
#[derive(Debug, Clone)]
pub(super) struct SurestWays {
    ids: Vec<KeyframeId>,
    ways: Vec<Option<Way>>,
}

/// Standard deviations along a way, m and rad.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Way {
    pub off: f64,
    pub turned: f64,
}

impl Way {
    fn and(self, next: Self) -> Self {
        Self { off: self.off + next.off, turned: self.turned + next.turned }
    }

    /// What ways are compared by, a metre like a radian: the bits of a number that is not negative, which are in its order.
    fn rank(self) -> u64 {
        (self.off + self.turned).to_bits()
    }
}

impl SurestWays {
    /// The ways from one keyframe to all that ties lead to, by Dijkstra's algorithm. Time: n log n in the keyframes.
    pub fn from(map: &LandmarkMap, start: KeyframeId, config: &LoopConfig) -> Self {
        let ids: Vec<KeyframeId> = map.keyframe_ids().collect();
        let ties = ties(map, &ids, config);
        let mut ways: Vec<Option<Way>> = vec![None; ids.len()];
        let mut open = BinaryHeap::new();
        if let Ok(start) = ids.binary_search(&start) {
            ways[start] = Some(Way::default());
            open.push(Reverse((Way::default().rank(), start)));
        }
        while let Some(Reverse((rank, at))) = open.pop() {
            let Some(way) = ways[at].filter(|way| way.rank() == rank) else { continue };
            for (to, tie) in &ties[at] {
                let on = way.and(*tie);
                if ways[*to].is_none_or(|before| on.rank() < before.rank()) {
                    ways[*to] = Some(on);
                    open.push(Reverse((on.rank(), *to)));
                }
            }
        }
        Self { ids, ways }
    }

    /// The way to a keyframe; `None` where no tie leads.
    pub fn to(&self, id: KeyframeId) -> Option<Way> {
        self.ways[self.ids.binary_search(&id).ok()?]
    }
}

/// The ties of each keyframe, there and back: to which place, and how far off.
fn ties(map: &LandmarkMap, ids: &[KeyframeId], config: &LoopConfig) -> Vec<Vec<(usize, Way)>> {
    let mut ties = vec![Vec::new(); ids.len()];
    for (at, (_, keyframe)) in map.keyframes().enumerate() {
        let parent = keyframe.tree.parent.iter().filter(|_| !keyframe.tree.is_astray);
        let seen = parent.chain(&keyframe.tree.loops).map(|id| (*id, config.drift_part));
        let rolled = keyframe.rolled.iter().map(|rolled| (rolled.from, config.drift_part_on_wheels));
        for (other, part) in seen.chain(rolled) {
            let Ok(to) = ids.binary_search(&other) else { continue };
            let step = keyframe.visual_from_camera.inverse() * map.keyframe(other).visual_from_camera;
            let way = Way { off: part * step.translation.norm(), turned: part * step.angle() };
            ties[at].push((to, way));
            ties[to].push((at, way));
        }
    }
    ties
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rolled::Rolled;
    use crate::testing::blank_frame;
    use trundle_core::{Pose3, Vector3};

    /// Keyframes along a line, each of which sees what the one before did.
    fn line(xs: &[f64]) -> (LandmarkMap, Vec<KeyframeId>) {
        let mut map = LandmarkMap::default();
        let along = |x: f64| Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * x);
        let ids: Vec<_> = xs.iter().map(|x| map.add_keyframe(blank_frame(1), along(*x))).collect();
        ids.windows(2).for_each(|pair| map.hang(pair[1], pair[0]));
        (map, ids)
    }

    /// How far off two keyframes may be, 1 % of what they see and 0.3 % on wheels.
    fn off(map: &LandmarkMap, a: KeyframeId, b: KeyframeId) -> f64 {
        let config = LoopConfig { drift_part: 0.01, drift_part_on_wheels: 0.003, ..Default::default() };
        let way = |from, to| SurestWays::from(map, from, &config).to(to).unwrap();
        let (there, back) = (way(a, b), way(b, a));
        assert!((there.off - back.off).abs() < 1e-12 && there.turned == 0.0);
        there.off
    }

    #[test]
    fn the_way_adds_up_and_wheels_are_surer() {
        let (mut map, ids) = line(&[0.0, 1.0, 3.0, 0.5]);
        assert!((off(&map, ids[0], ids[3]) - 0.055).abs() < 1e-12);
        map.keyframe_mut(ids[2]).rolled = Some(Rolled::at(ids[1]));
        assert!((off(&map, ids[0], ids[3]) - 0.041).abs() < 1e-12);
        assert!(map.forget_keyframe(ids[2]));
        assert!((off(&map, ids[0], ids[3]) - 0.015).abs() < 1e-12, "what hung under it hangs higher");
    }

    #[test]
    fn what_a_loop_has_tied_is_as_sure_as_the_place() {
        let (mut map, ids) = line(&[0.0, 10.0, 20.0, 10.0, 0.5, 10.0]);
        assert!((off(&map, ids[0], ids[5]) - 0.49).abs() < 1e-12);
        map.tie(ids[0], ids[4]);
        assert!((off(&map, ids[0], ids[5]) - 0.1).abs() < 1e-12);
        assert!((off(&map, ids[1], ids[3]) - 0.2).abs() < 1e-12, "as before where that is surer");
    }

    #[test]
    fn the_one_before_that_nothing_leads_to_is_no_tie() {
        let (mut map, ids) = line(&[0.0, 1.0, 2.0]);
        map.keyframe_mut(ids[1]).tree.is_astray = true;
        let config = LoopConfig::default();
        assert_eq!(SurestWays::from(&map, ids[0], &config).to(ids[2]), None);
        map.keyframe_mut(ids[1]).rolled = Some(Rolled::at(ids[0]));
        assert!((off(&map, ids[0], ids[2]) - 0.013).abs() < 1e-12);
        assert!(map.forget_keyframe(ids[1]));
        assert_eq!(SurestWays::from(&map, ids[0], &config).to(ids[2]), None, "nor to what hung under it");
    }

    #[test]
    fn nothing_is_said_of_what_is_not_tied() {
        let (map, ids) = line(&[0.0, 1.0]);
        let (nobody, config) = (KeyframeId::from_index(7), LoopConfig::default());
        assert_eq!(SurestWays::from(&map, ids[0], &config).to(nobody), None);
        assert_eq!(SurestWays::from(&map, nobody, &config).to(ids[0]), None);
    }
}
