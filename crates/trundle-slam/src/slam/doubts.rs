use crate::claim::Claim;
use crate::report::MapId;
use std::collections::BTreeMap;
use trundle_core::{Pose3, Stamp};

/// Places that look right and are not believed yet: of each map the one that was said last. Maps that show one place do not
/// contradict each other.
#[derive(Debug, Default)]
pub(super) struct Doubts {
    said: BTreeMap<MapId, (Stamp, Option<Claim<()>>)>,
}

/// Of a camera that nobody tells about, what was said longer ago says nothing of where it is now, s.
const LAST: f64 = 1.0;

impl Doubts {
    /// How many frames in a row have said of a map that a camera which should be at the second pose is at the first. Between them
    /// `is_told` how it moved, or it may have moved as fast as it can.
    pub(super) fn note(&mut self, map: MapId, now: Stamp, poses: (Pose3, Pose3), is_told: bool) -> usize {
        let (stamp, claim) = self.said.entry(map).or_insert((now, None));
        let untold = if is_told { 0.0 } else { (now - *stamp).max(0.0) };
        if untold > LAST {
            *claim = None;
        }
        *stamp = now;
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
            doubts.note(MapId(map), Stamp::default().after(time), at(x), is_told)
        };
        assert_eq!([say(0, 0.0, 1.0, false), say(1, 0.0, 7.0, false)], [1, 1]);
        assert_eq!([say(0, 0.1, 1.2, false), say(1, 0.1, 7.2, false)], [2, 2]);
        assert_eq!(
            [say(0, 0.3, 1.8, false), say(0, 0.4, 3.0, false)],
            [3, 1],
            "slower than it walks, faster"
        );
        assert_eq!(
            [say(0, 1.5, 3.0, false), say(0, 60.0, 3.0, true)],
            [1, 2],
            "wheels tell for as long as they turn"
        );
    }
}
