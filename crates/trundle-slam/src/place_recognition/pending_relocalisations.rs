//! Relocalisations that wait for a second frame to confirm them.

use crate::ids::MapId;
use crate::place_recognition::consistency_check::ConsistencyCheck;
use std::collections::BTreeMap;
use trundle_core::{Pose3, Stamp};

/// Longest time without odometry after which a relocalisation still counts: 2 s. Beyond it the count restarts, since the camera may be
/// anywhere. Inactive maps take turns, so that two tries in one map are some frames apart. Source: ours.
const MAX_UNOBSERVED_S: f64 = 2.0;

/// Unconfirmed relocalisations, the last one of each map. Two maps of one place do not contradict each other.
#[derive(Debug, Default)]
pub(crate) struct PendingRelocalisations {
    /// The last relocalisation in each map, and `unobserved_s` at its time.
    of_map: BTreeMap<MapId, (f64, Option<ConsistencyCheck<()>>)>,
    last_frame: Option<Stamp>,
    /// Total time without odometry, s.
    unobserved_s: f64,
}

impl PendingRelocalisations {
    /// Records a frame, and whether odometry measured the motion since the previous frame.
    pub fn record_frame(&mut self, now: Stamp, has_odometry: bool) {
        let since = self.last_frame.replace(now).map_or(0.0, |before| now - before);
        if !has_odometry {
            self.unobserved_s += since.max(0.0);
        }
    }

    /// Records the found and the predicted pose of a camera in a map; returns the number of successive frames that agree.
    pub fn record(&mut self, map: MapId, poses: (Pose3, Pose3)) -> usize {
        let (at, check) = self.of_map.entry(map).or_insert((self.unobserved_s, None));
        let unobserved_s = self.unobserved_s - *at;
        if unobserved_s > MAX_UNOBSERVED_S {
            *check = None;
        }
        *at = self.unobserved_s;
        ConsistencyCheck::record(check, (), poses, unobserved_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector3;

    #[test]
    fn each_map_is_counted_for_itself_and_old_relocalisations_expire() {
        let at =
            |x: f64| (Pose3::new(nalgebra::UnitQuaternion::identity(), Vector3::x() * x), Pose3::identity());
        let mut pending = PendingRelocalisations::default();
        let mut found = |map: u32, time: f64, x: f64, has_odometry| {
            pending.record_frame(Stamp::default().after(time), has_odometry);
            pending.record(MapId(map), at(x))
        };
        assert_eq!([found(0, 0.0, 1.0, false), found(1, 0.0, 7.0, false)], [1, 1]);
        assert_eq!([found(0, 0.1, 1.2, false), found(1, 0.1, 7.2, false)], [2, 2]);
        assert_eq!([found(0, 0.3, 1.8, false), found(0, 0.4, 3.0, false)], [3, 1], "possible, too fast");
        assert_eq!([found(0, 2.5, 3.0, false), found(0, 60.0, 3.0, true)], [1, 2], "odometry for a minute");
        assert_eq!([found(1, 61.0, 7.2, true), found(1, 62.2, 7.2, false)], [1, 2], "maps take turns");
        pending.record_frame(Stamp::default().after(122.0), false);
        pending.record_frame(Stamp::default().after(122.1), true);
        assert_eq!(pending.record(MapId(0), at(3.0)), 1, "a minute without odometry");
    }
}
