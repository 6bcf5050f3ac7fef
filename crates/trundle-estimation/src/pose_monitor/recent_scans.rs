//! The scans of the last seconds, from different poses.

use crate::pose_monitor::scan_likelihood::scan_log_likelihood;
use std::collections::VecDeque;
use trundle_core::{OccupancyGrid, Pose2, Scan};

/// Scans from different poses, joined by odometry.
///
/// A person can fill one scan. A drifted estimate is wrong for all scans of the last seconds, so that all together decide between two
/// poses.
#[derive(Debug, Clone, Default)]
pub(crate) struct RecentScans(VecDeque<(Pose2, Scan)>);

/// Maximum age of a scan \[s\]: odometry hardly drifts in this time. Source: ours.
const MAX_AGE_S: f64 = 20.0;
/// Largest number of scans. Source: ours, the cost of a comparison.
const MAX_SCANS: usize = 12;
/// Smallest distance between the poses of two scans \[m\]. Source: ours.
const SPACING_M: f64 = 0.3;
/// Smallest turn between the poses of two scans \[rad\]: 10 deg. Source: ours.
const SPACING_RAD: f64 = 0.175;

impl RecentScans {
    /// Records a scan taken at `odom_from_base`.
    pub(crate) fn add(&mut self, odom_from_base: Pose2, scan: &Scan) {
        self.0.retain(|(_, kept)| scan.stamp() - kept.stamp() <= MAX_AGE_S);
        let is_elsewhere = |(last, _): &(Pose2, Scan)| {
            let motion = last.inverse() * odom_from_base;
            motion.position().norm() >= SPACING_M || motion.theta.abs() >= SPACING_RAD
        };
        if self.0.back().is_none_or(is_elsewhere) {
            if self.0.len() == MAX_SCANS {
                self.0.pop_front();
            }
            self.0.push_back((odom_from_base, scan.clone()));
        }
    }

    /// Drops all scans, when odometry was wrong between them, and restarts with `scan`, taken at `odom_from_base`.
    pub(crate) fn restart(&mut self, odom_from_base: Pose2, scan: Option<&Scan>) {
        self.0.clear();
        self.0.extend(scan.map(|scan| (odom_from_base, scan.clone())));
    }

    /// Number of scans.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// Log-likelihood of the scans for a robot at `map_from_base`, with the odometry at `odom_from_base` \[nats\].
    pub(crate) fn log_likelihood(
        &self,
        grid: &OccupancyGrid,
        map_from_base: Pose2,
        odom_from_base: Pose2,
    ) -> f64 {
        let map_from_odom = map_from_base * odom_from_base.inverse();
        let at = |(odom, scan): &(Pose2, Scan)| scan_log_likelihood(grid, map_from_odom * *odom, scan);
        self.0.iter().map(at).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose_monitor::testing::Room;
    use trundle_core::Vector2;

    #[test]
    fn a_person_who_fills_one_scan_does_not_outweigh_the_others() {
        let room = Room::with_corner_box();
        let near = room.clone().with_person(Vector2::new(0.4, 0.0)).with_person(Vector2::new(0.4, 0.3));
        let mut recent = RecentScans::default();
        let at = |i: u32| Pose2::new(-0.6, 0.2, 0.3 * f64::from(i));
        for i in 0..6 {
            let scanned = if i == 5 { &near } else { &room };
            recent.add(at(i), &scanned.scan(at(i), f64::from(i)));
        }
        let nats = |pose| recent.log_likelihood(&room.map(), pose, at(5));
        for off in [Pose2::new(0.4, 0.0, 0.0), Pose2::new(0.0, 0.3, 0.2), Pose2::new(0.1, 0.0, -0.8)] {
            assert!(nats(at(5)) - nats(at(5) * off) > 10.0, "{off:?}");
        }
    }

    #[test]
    fn scans_of_a_standing_robot_count_once_and_old_ones_not() {
        let room = Room::with_corner_box();
        let mut recent = RecentScans::default();
        for i in 0..100 {
            recent.add(Pose2::IDENTITY, &room.scan(Pose2::IDENTITY, 0.1 * f64::from(i)));
        }
        assert_eq!(recent.0.len(), 1);
        for i in 0..30 {
            let pose = Pose2::new(0.0, 0.0, 0.2 * f64::from(i));
            recent.add(pose, &room.scan(pose, 10.0 + 0.1 * f64::from(i)));
        }
        assert_eq!(recent.0.len(), MAX_SCANS);
        recent.add(Pose2::IDENTITY, &room.scan(Pose2::IDENTITY, 100.0));
        assert_eq!(recent.0.len(), 1);
    }
}
