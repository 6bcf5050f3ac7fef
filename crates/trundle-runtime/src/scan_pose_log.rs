//! Poses of the scans in the grid, for a redraw after a correction.

use std::collections::{BTreeMap, BTreeSet};
use trundle_core::{Pose2, Pose3, Stamp};

/// The camera pose in the visual map at each drawn scan. The grid follows a correction of these poses.
#[derive(Debug, Default)]
pub(crate) struct ScanPoseLog {
    visual: BTreeMap<Stamp, Pose3>,
    /// Number of poses at which the log is thinned; 0 means [`MIN_KEPT_POSES`].
    max: usize,
}

/// Number of stored scan poses above which the log is thinned. Source: ours.
const MIN_KEPT_POSES: usize = 2048;

impl ScanPoseLog {
    /// Records a scan drawn with the camera at `visual_from_camera`. At intervals the log drops scans that are not `kept`, and then returns
    /// true. The log therefore grows only with the kept scans.
    pub(crate) fn note<I: Iterator<Item = Stamp>>(
        &mut self,
        stamp: Stamp,
        visual_from_camera: Pose3,
        kept: impl FnOnce() -> I,
    ) -> bool {
        let is_thinned = self.visual.len() >= self.max.max(MIN_KEPT_POSES);
        if is_thinned {
            let kept: BTreeSet<Stamp> = kept().collect();
            self.visual.retain(|stamp, _| kept.contains(stamp));
            self.max = 2 * self.visual.len();
        }
        self.visual.insert(stamp, visual_from_camera);
        is_thinned
    }

    /// Whether the log has a scan with this stamp.
    pub(crate) fn has(&self, stamp: Stamp) -> bool {
        self.visual.contains_key(&stamp)
    }

    /// Applies the corrected poses of the visual map; returns `new_from_old` (map frame) of every drawn scan with a corrected pose. `base`
    /// converts a camera pose to the base's pose in the map frame.
    pub(crate) fn follow(
        &mut self,
        now: &[(Stamp, Pose3)],
        base: impl Fn(&Pose3) -> Option<Pose2>,
    ) -> BTreeMap<Stamp, Pose2> {
        let mut moved = BTreeMap::new();
        for (stamp, new) in now {
            let Some(old) = self.visual.get_mut(stamp) else { continue };
            if let (Some(new_base), Some(old_base)) = (base(new), base(old)) {
                moved.insert(*stamp, new_base * old_base.inverse());
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
    fn poses_that_are_not_kept_are_dropped() {
        let mut scan_poses = ScanPoseLog::default();
        let at = Stamp::from_nanos;
        let thinned = (0..20_000)
            .filter(|i| {
                let is_thinned =
                    scan_poses.note(at(*i), Pose3::identity(), || (0..20_000).step_by(100).map(at));
                assert!(scan_poses.visual.len() <= MIN_KEPT_POSES);
                is_thinned
            })
            .count();
        assert!((9..=12).contains(&thinned), "{thinned} times");
        assert!((0..20_000).step_by(100).all(|i| scan_poses.has(at(i))));
    }

    #[test]
    fn a_scan_moves_as_its_visual_pose_does_and_only_once() {
        let mut scan_poses = ScanPoseLog::default();
        let (stamp, forgotten) = (Stamp::from_nanos(1), Stamp::from_nanos(2));
        let (old, new) = (Pose2::new(1.0, 0.0, 0.0), Pose2::new(1.0, 0.5, 0.1));
        let base = |pose: &Pose3| Some(pose.to_pose2());
        scan_poses.note(stamp, Pose3::from_pose2(old), std::iter::empty);
        scan_poses.note(forgotten, Pose3::from_pose2(old), std::iter::empty);
        let moved = scan_poses.follow(&[(stamp, Pose3::from_pose2(new))], base);
        assert_eq!(moved.len(), 1);
        // The scan was drawn 2 cm from the base's position in the visual map; the offset remains.
        let beside = Pose2::new(0.0, 0.02, 0.0);
        let off = (moved[&stamp] * (old * beside)).inverse() * (new * beside);
        assert!(off.log().norm() < 1e-12, "{off:?}");
        let again = scan_poses.follow(&[(stamp, Pose3::from_pose2(new))], base);
        assert!(again[&stamp].log().norm() < 1e-12);
    }
}
