use std::collections::BTreeMap;
use trundle_core::{Pose2, Stamp};

/// Where the visual map said that the base was when each scan was drawn, so that the grid can follow when it says otherwise.
#[derive(Debug, Default)]
pub(crate) struct DrawnPoses {
    visual: BTreeMap<Stamp, Pose2>,
}

impl DrawnPoses {
    /// Notes a scan that was drawn while the visual map had the base at `map_from_base`.
    pub(crate) fn note(&mut self, stamp: Stamp, map_from_base: Pose2) {
        self.visual.insert(stamp, map_from_base);
    }

    /// Takes over where the visual map has the base by now: `new_from_old` (map frame) of every scan drawn that it still knows.
    pub(crate) fn follow(&mut self, now: &BTreeMap<Stamp, Pose2>) -> BTreeMap<Stamp, Pose2> {
        let mut moved = BTreeMap::new();
        for (stamp, old) in &mut self.visual {
            if let Some(new) = now.get(stamp) {
                moved.insert(*stamp, *new * old.inverse());
                *old = *new;
            }
        }
        moved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scan_moves_as_its_visual_pose_does_and_only_once() {
        let mut drawn = DrawnPoses::default();
        let (stamp, forgotten) = (Stamp::from_nanos(1), Stamp::from_nanos(2));
        let (old, new) = (Pose2::new(1.0, 0.0, 0.0), Pose2::new(1.0, 0.5, 0.1));
        drawn.note(stamp, old);
        drawn.note(forgotten, old);
        let moved = drawn.follow(&BTreeMap::from([(stamp, new)]));
        assert_eq!(moved.len(), 1);
        // The scan was drawn 2 cm beside where the visual map had the base; it stays so.
        let beside = Pose2::new(0.0, 0.02, 0.0);
        let off = (moved[&stamp] * (old * beside)).inverse() * (new * beside);
        assert!(off.log().norm() < 1e-12, "{off:?}");
        let again = drawn.follow(&BTreeMap::from([(stamp, new)]));
        assert!(again[&stamp].log().norm() < 1e-12);
    }
}
