//! Propagation of sparse filter poses to all odometry stamps.

use trundle_core::{Pose2, Stamp};

/// The poses at all stamps of `odometry` (odom_from_base, by rising stamps), from the poses at some of these stamps.
///
/// Between two processed scans the trajectory follows the odometry, and its error at the second scan is distributed over the time in
/// between. After the last scan the odometry continues the trajectory. Stamps before the first processed scan are left out.
pub fn propagate_trajectory(
    processed: &[(Stamp, Pose2)],
    odometry: &[(Stamp, Pose2)],
) -> Vec<(Stamp, Pose2)> {
    propagated_poses(processed, odometry).collect()
}

/// The poses of [`propagate_trajectory`], one at a time.
pub fn propagated_poses<'a>(
    processed: &'a [(Stamp, Pose2)],
    odometry: &'a [(Stamp, Pose2)],
) -> impl Iterator<Item = (Stamp, Pose2)> + 'a {
    let odometry_at = |stamp: Stamp| {
        let i = odometry.partition_point(|(s, _)| *s < stamp);
        odometry.get(i).filter(|(s, _)| *s == stamp).map(|(_, pose)| *pose)
    };
    let mut next = 0;
    odometry.iter().filter_map(move |&(stamp, odom_from_base)| {
        while next < processed.len() && processed[next].0 <= stamp {
            next += 1;
        }
        let before = processed[next.checked_sub(1)?];
        let odom_before = odometry_at(before.0)?;
        let led = before.1 * (odom_before.inverse() * odom_from_base);
        let corrected = processed.get(next).and_then(|after| {
            let odom_after = odometry_at(after.0)?;
            let expected = before.1 * (odom_before.inverse() * odom_after);
            let error = expected.inverse() * after.1;
            let fraction = (stamp - before.0) / (after.0 - before.0);
            Some(led * Pose2::exp(error.log() * fraction))
        });
        Some((stamp, corrected.unwrap_or(led)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meets_every_processed_pose_and_follows_the_odometry_between() {
        let stamp = |i: i64| Stamp::from_nanos(i * 100_000_000);
        let odometry: Vec<_> = (0..10).map(|i| (stamp(i), Pose2::new(0.1 * i as f64, 0.0, 0.0))).collect();
        let processed = [(stamp(2), Pose2::new(5.0, 0.0, 0.0)), (stamp(6), Pose2::new(5.4, 0.04, 0.0))];
        let carried = propagate_trajectory(&processed, &odometry);
        assert_eq!(carried.len(), 8);
        for known in processed {
            let found = carried.iter().find(|c| c.0 == known.0).unwrap();
            assert!(found.1.distance(&known.1) < 1e-12);
        }
        assert!((carried[2].1.y - 0.02).abs() < 1e-12 && (carried[2].1.x - 5.2).abs() < 1e-12);
        assert!((carried[7].1.x - 5.7).abs() < 1e-12 && (carried[7].1.y - 0.04).abs() < 1e-12);
    }
}
