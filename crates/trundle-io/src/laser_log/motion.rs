//! Interpolation of the odometry of a log over time.

use super::order::insert_in_order;
use trundle_core::{Pose2, Stamp};

/// The poses of the base by odometry, over time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Motion {
    poses: Vec<(Stamp, Pose2)>,
}

/// Largest time between two poses that are interpolated, s. In a longer gap the pose is unknown. Source: ours.
const LONGEST_GAP: f64 = 1.0;
/// Time before and after a pose for which it holds, s. Source: ours.
const POSE_HOLD_S: f64 = 0.1;

impl Motion {
    /// Adds a pose, at its place where its time is a little before the last one's. Of poses of one time the first counts.
    ///
    /// # Errors
    /// When it is not finite or its time goes back.
    pub(crate) fn push(&mut self, stamp: Stamp, pose: Pose2) -> Result<(), String> {
        if !pose.is_finite() {
            return Err("the pose is not finite, or its quaternion is none".to_owned());
        }
        if self.poses.binary_search_by_key(&stamp, |(at, _)| *at).is_ok() {
            return Ok(());
        }
        insert_in_order(&mut self.poses, (stamp, pose), |(stamp, _)| *stamp)
    }

    /// The poses, by rising stamps.
    pub(crate) fn into_poses(self) -> Vec<(Stamp, Pose2)> {
        self.poses
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// The problem where the odometry has no stamp within the scans, which are between `first` and `last`.
    pub(crate) fn other_clock(&self, (first, last): (Stamp, Stamp)) -> Option<String> {
        let scans = format!("scans from {first} s to {last} s");
        let (Some((from, _)), Some((to, _))) = (self.poses.first(), self.poses.last()) else {
            return Some(format!("{scans}, but no odometry in it"));
        };
        let overlaps = *from - last <= POSE_HOLD_S && first - *to <= POSE_HOLD_S;
        (!overlaps).then(|| {
            format!(
                "{scans}, odometry from {from} s to {to} s: their clocks differ, expected one clock for both"
            )
        })
    }

    /// The pose at a time.
    ///
    /// # Errors
    /// As [`pose_at`].
    pub(crate) fn at(&self, stamp: Stamp) -> Result<Pose2, String> {
        pose_at(&self.poses, stamp)
    }
}

/// The pose at a time, interpolated between those of `poses` (by rising stamps) before and after it.
///
/// # Errors
/// When no pose is near in time.
pub(crate) fn pose_at(poses: &[(Stamp, Pose2)], stamp: Stamp) -> Result<Pose2, String> {
    let after = poses.partition_point(|(at, _)| *at < stamp);
    let (before, next) = (after.checked_sub(1).and_then(|i| poses.get(i)), poses.get(after));
    let near = |pose: &&(Stamp, Pose2)| (pose.0 - stamp).abs() <= POSE_HOLD_S;
    match (before, next) {
        (Some((t0, a)), Some((t1, b))) if *t1 - *t0 <= LONGEST_GAP => {
            Ok(a.interpolate(b, (stamp - *t0) / (*t1 - *t0)))
        }
        (before, next) => {
            let held = next.filter(near).or(before.filter(near));
            held.map(|(_, pose)| *pose).ok_or_else(|| format!("no odometry about {stamp} s"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamp(ms: i64) -> Stamp {
        Stamp::from_nanos(ms * 1_000_000)
    }

    #[test]
    fn poses_between_and_none_in_gaps() {
        let mut motion = Motion::default();
        for (ms, x) in [(0, 0.0), (500, 1.0), (5000, 2.0)] {
            motion.push(stamp(ms), Pose2::new(x, 0.0, 0.0)).unwrap();
        }
        assert!((motion.at(stamp(250)).unwrap().x - 0.5).abs() < 1e-12);
        assert_eq!(motion.at(stamp(500)).unwrap().x, 1.0);
        assert_eq!(motion.at(stamp(-50)).unwrap().x, 0.0);
        assert_eq!(motion.at(stamp(5050)).unwrap().x, 2.0);
        assert_eq!(motion.at(stamp(2000)).unwrap_err(), "no odometry about 2.000000000 s");
        assert_eq!(motion.at(stamp(590)).unwrap().x, 1.0, "a pose holds for a moment");
        assert!(motion.push(stamp(4000), Pose2::IDENTITY).unwrap_err().starts_with("time goes back"));
        assert!(motion.push(stamp(6000), Pose2 { x: f64::NAN, ..Pose2::IDENTITY }).is_err());
    }
}
