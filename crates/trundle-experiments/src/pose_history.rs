//! Poses by time.

use trundle_core::{Pose2, Stamp};

/// The pose at a time, interpolated between those of `poses` (by rising stamps); after the last one the last, before the first none.
pub(crate) fn pose_at(poses: &[(Stamp, Pose2)], stamp: Stamp) -> Option<Pose2> {
    let after = poses.partition_point(|(at, _)| *at <= stamp);
    let (t0, a) = *poses.get(after.checked_sub(1)?)?;
    let Some((t1, b)) = poses.get(after) else { return Some(a) };
    Some(a.interpolate(b, (stamp - t0) / (*t1 - t0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_between_two_after_the_last_and_before_the_first() {
        let at = |ms: i64| Stamp::from_nanos(ms * 1_000_000);
        let poses = [(at(100), Pose2::new(1.0, 0.0, 0.0)), (at(200), Pose2::new(2.0, 0.0, 0.2))];
        assert_eq!(pose_at(&poses, at(99)), None);
        assert!(pose_at(&poses, at(150)).unwrap().distance(&Pose2::new(1.5, 0.0, 0.1)) < 1e-3);
        assert_eq!(pose_at(&poses, at(900)), Some(poses[1].1));
        assert_eq!(pose_at(&[], at(0)), None);
    }
}
