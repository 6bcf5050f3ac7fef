use crate::ids::KeyframeId;
use crate::map::LandmarkMap;
use std::collections::BTreeMap;
use trundle_core::Pose3;

/// How far the camera went and turned up to each keyframe, from keyframe to keyframe.
#[derive(Debug, Clone, Default)]
pub(crate) struct Odometer {
    ways: BTreeMap<KeyframeId, Ways>,
}

/// What the camera went alone, and where wheels tie each keyframe to the one before.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Ways {
    pub alone: Way,
    pub on_wheels: Way,
}

/// A length and a turn, m and rad.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Way {
    pub length: f64,
    pub turn: f64,
}

impl Way {
    fn after(self, step: Pose3) -> Self {
        Self { length: self.length + step.translation.norm(), turn: self.turn + step.angle() }
    }

    fn since(self, other: Self) -> Self {
        Self { length: (self.length - other.length).abs(), turn: (self.turn - other.turn).abs() }
    }
}

impl Odometer {
    /// Takes in the keyframes that are new in `map`, and forgets those that it has no more.
    pub fn follow(&mut self, map: &LandmarkMap) {
        for (id, keyframe) in map.keyframes() {
            if self.ways.contains_key(&id) {
                continue;
            }
            let before = self.ways.last_key_value().map(|(last, ways)| (*last, *ways));
            let ways = before.map_or(Ways::default(), |(last, mut ways)| {
                let step = map.visual_from_keyframe(last).inverse() * keyframe.visual_from_camera;
                let way = if keyframe.rolled.is_some() { &mut ways.on_wheels } else { &mut ways.alone };
                *way = way.after(step);
                ways
            });
            self.ways.insert(id, ways);
        }
        let newest = self.ways.last_key_value().map(|(id, _)| *id);
        self.ways.retain(|id, _| Some(*id) == newest || map.live_keyframe(*id).is_some());
    }

    /// The ways between two keyframes.
    pub(super) fn between(&self, a: KeyframeId, b: KeyframeId) -> Ways {
        let at = |id: &KeyframeId| self.ways.get(id).copied().unwrap_or_default();
        let (a, b) = (at(&a), at(&b));
        Ways { alone: a.alone.since(b.alone), on_wheels: a.on_wheels.since(b.on_wheels) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rolled::Rolled;
    use crate::testing::blank_frame;
    use trundle_core::Vector3;

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
        let alone = |length: f64| Ways { alone: Way { length, turn: 0.0 }, ..Ways::default() };
        assert_eq!(odometer.between(ids[0], ids[3]), alone(5.5));
        assert!(map.forget_keyframe(ids[2]));
        odometer.follow(&map);
        assert_eq!(odometer.between(ids[1], ids[3]), alone(4.5));
        let on_wheels = map.add_keyframe(blank_frame(1), along(2.5));
        map.keyframe_mut(on_wheels).rolled = Some(Rolled::at(ids[3]));
        odometer.follow(&map);
        let ways = odometer.between(ids[1], on_wheels);
        assert_eq!((ways.alone.length, ways.on_wheels.length), (4.5, 2.0));
    }
}
