//! What the lines of one laser show together: mount, limit of the ranges, order.

use super::line::LaserLine;
use super::ranges::RangeLimit;
use crate::laser_log::{LaserLogSkip, OrderBuffer};
use trundle_core::{Pose2, Stamp};

/// Largest distance of a laser from the base that poses of lines give \[m\]. Source: ours.
const MAX_MOUNT_DISTANCE_M: f64 = 2.0;
/// Largest difference of two equal mounts \[m, rad\]. Source: ours.
const MAX_MOUNT_DIFFERENCE: f64 = 0.01;
/// Smallest difference of a mount from the base's pose \[m, rad\]. Source: ours.
const MIN_MOUNT_OFFSET: f64 = 1e-6;

/// The lines of one laser, surveyed as they come.
#[derive(Debug, Default)]
pub(super) struct LaserSurvey {
    /// base_from_laser of the lines, if they have poses.
    mounts: OrderBuffer<Option<Pose2>>,
    first_mount: Option<Option<Pose2>>,
    has_other_mount: bool,
    limit: RangeLimit,
    /// Stamps of the first and the last line.
    times: Option<(Stamp, Stamp)>,
    /// Whether a line has poses.
    pub(super) has_poses: bool,
    /// Number of lines in order.
    pub(super) count: usize,
    /// Lines whose times go back.
    late: Vec<LaserLogSkip>,
}

impl LaserSurvey {
    /// Surveys the next line.
    pub(super) fn take(&mut self, number: usize, laser: &LaserLine) {
        self.has_poses |= laser.poses.is_some();
        let mount =
            laser.poses.map(|[odom_from_laser, odom_from_base]| odom_from_base.inverse() * odom_from_laser);
        if let Err(problem) = self.mounts.push(laser.stamp, mount) {
            self.late.push(LaserLogSkip { line: number, problem });
            return;
        }
        laser.ranges.iter().for_each(|range| self.limit.count(*range));
        while let Some((stamp, mount)) = self.mounts.pop() {
            self.take_in_order(stamp, mount);
        }
    }

    /// Surveys the lines that wait for their order.
    pub(super) fn finish(&mut self) {
        while let Some((stamp, mount)) = self.mounts.pop_last() {
            self.take_in_order(stamp, mount);
        }
    }

    fn take_in_order(&mut self, stamp: Stamp, mount: Option<Pose2>) {
        self.count += 1;
        self.times = Some((self.times.map_or(stamp, |(first, _)| first), stamp));
        let first = *self.first_mount.get_or_insert(mount);
        let agrees = first.zip(mount).is_some_and(|(first, mount)| {
            let off = first.inverse() * mount;
            off.position().norm() < MAX_MOUNT_DIFFERENCE && off.theta.abs() < MAX_MOUNT_DIFFERENCE
        });
        self.has_other_mount |= !agrees;
    }

    /// Mount of the laser by the poses of the lines, when all agree and it is at most 2 m from the base.
    pub(super) fn mount(&self) -> Option<Pose2> {
        let mount = self.first_mount.flatten().filter(|_| !self.has_other_mount)?;
        let distance = mount.position().norm();
        let is_away = distance > MIN_MOUNT_OFFSET || mount.theta.abs() > MIN_MOUNT_OFFSET;
        (is_away && distance < MAX_MOUNT_DISTANCE_M).then_some(mount)
    }

    /// The range that beams without a return have, m.
    pub(super) fn limit(&self) -> Option<f64> {
        self.limit.limit()
    }

    /// Stamps of the first and the last line in order.
    pub(super) fn times(&self) -> Option<(Stamp, Stamp)> {
        self.times
    }

    /// Lines whose times go back.
    pub(super) fn into_late(self) -> Vec<LaserLogSkip> {
        self.late
    }
}
