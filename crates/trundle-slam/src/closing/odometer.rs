use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use std::collections::BTreeMap;

/// How far the camera went and turned up to each keyframe, from keyframe to keyframe: m and rad.
#[derive(Debug, Clone, Default)]
pub(crate) struct Odometer {
    ways: BTreeMap<KeyframeId, Way>,
}

/// A length and a turn, m and rad.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Way {
    pub length: f64,
    pub turn: f64,
}

impl Odometer {
    /// Takes in the keyframes that are new in `map`, and forgets those that it has no more.
    pub fn follow(&mut self, map: &LandmarkMap) {
        for (id, keyframe) in map.keyframes() {
            if self.ways.contains_key(&id) {
                continue;
            }
            let before = self.ways.last_key_value().map(|(last, way)| (*last, *way));
            let way = before.map_or(Way::default(), |(last, way)| {
                let step = map.visual_from_keyframe(last).inverse() * keyframe.visual_from_camera;
                Way { length: way.length + step.translation.norm(), turn: way.turn + step.angle() }
            });
            self.ways.insert(id, way);
        }
        let newest = self.ways.last_key_value().map(|(id, _)| *id);
        self.ways.retain(|id, _| Some(*id) == newest || map.live_keyframe(*id).is_some());
    }

    /// The way between two keyframes.
    pub(super) fn between(&self, a: KeyframeId, b: KeyframeId) -> Way {
        let at = |id: &KeyframeId| self.ways.get(id).copied().unwrap_or_default();
        let (a, b) = (at(&a), at(&b));
        Way { length: (a.length - b.length).abs(), turn: (a.turn - b.turn).abs() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::blank_frame;
    use trundle_core::{Pose3, Vector3};

    #[test]
    fn the_way_adds_up_and_outlasts_what_is_forgotten() {
        let (mut map, mut odometer) = (LandmarkMap::default(), Odometer::default());
        let along = |x: f64| Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * x);
        let ids: Vec<_> = [0.0, 1.0, 3.0, 0.5]
            .map(|x| {
                let id = map.add_keyframe(blank_frame(1), along(x));
                map.enter_tree(id);
                odometer.follow(&map);
                id
            })
            .to_vec();
        assert_eq!(odometer.between(ids[0], ids[3]), Way { length: 5.5, turn: 0.0 });
        assert!(map.forget_keyframe(ids[2]));
        odometer.follow(&map);
        assert_eq!(odometer.between(ids[1], ids[3]), Way { length: 4.5, turn: 0.0 });
    }
}
