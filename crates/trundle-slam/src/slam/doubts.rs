use crate::claim::Claim;
use crate::report::MapId;
use std::collections::BTreeMap;
use trundle_core::{Pose3, Stamp};

/// Places that look right and are not believed yet: of each map the one that was said last. Maps that show one place do not
/// contradict each other.
#[derive(Debug, Default)]
pub(super) struct Doubts {
    /// And how long nobody had told how the camera moves then, s.
    said: BTreeMap<MapId, (f64, Option<Claim<()>>)>,
    /// The last frame.
    now: Option<Stamp>,
    /// In all, s.
    untold: f64,
}

/// Of a camera that nobody tells about, what was said longer ago says nothing of where it is now, s: other maps take turns.
const LAST: f64 = 2.0;

impl Doubts {
    /// A frame: since the one before it `is_told` how the camera moved, or it may have moved as fast as it can.
    pub(super) fn pass(&mut self, now: Stamp, is_told: bool) {
        let since = self.now.replace(now).map_or(0.0, |before| now - before);
        if !is_told {
            self.untold += since.max(0.0);
        }
    }

    /// How many frames in a row have said of a map that a camera which should be at the second pose is at the first.
    pub(super) fn note(&mut self, map: MapId, poses: (Pose3, Pose3)) -> usize {
        let (at, claim) = self.said.entry(map).or_insert((self.untold, None));
        let untold = self.untold - *at;
        if untold > LAST {
            *claim = None;
        }
        *at = self.untold;
        Claim::note(claim, (), poses, untold)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector3;

    #[test]
    fn each_map_is_counted_for_itself_and_what_is_old_is_not() {
        let at =
            |x: f64| (Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * x), Pose3::identity());
        let mut doubts = Doubts::default();
        let mut say = |map: u32, time: f64, x: f64, is_told| {
            doubts.pass(Stamp::default().after(time), is_told);
            doubts.note(MapId(map), at(x))
        };
        assert_eq!([say(0, 0.0, 1.0, false), say(1, 0.0, 7.0, false)], [1, 1]);
        assert_eq!([say(0, 0.1, 1.2, false), say(1, 0.1, 7.2, false)], [2, 2]);
        assert_eq!(
            [say(0, 0.3, 1.8, false), say(0, 0.4, 3.0, false)],
            [3, 1],
            "slower than it walks, faster"
        );
        assert_eq!(
            [say(0, 2.5, 3.0, false), say(0, 60.0, 3.0, true)],
            [1, 2],
            "wheels tell for as long as they turn"
        );
        assert_eq!([say(1, 61.0, 7.2, true), say(1, 62.2, 7.2, false)], [1, 2], "maps take turns");
        doubts.pass(Stamp::default().after(122.0), false);
        doubts.pass(Stamp::default().after(122.1), true);
        assert_eq!(doubts.note(MapId(0), at(3.0)), 1, "a minute untold, and told of one step");
    }
}
