//! Detection of an unknown pose, and global localization by scans.

use super::{MAX_VISUAL_MOTION_AGE_S, Robot, event_log};
use crate::{
    global_localization::LocalizedPose,
    monitors::scan_map_consistency::Fit,
    pose_status::{PoseCertainty, PoseStatus},
    range_source::RangeSource,
    report::StepReport,
};
use trundle_core::{Scan, Stamp};
use trundle_estimation::{Correction, PoseUncertainty, ScanPose};

impl Robot {
    /// Processes a laser scan, if the laser is the range source.
    pub(super) fn on_laser(&mut self, scan: &Scan, report: &mut StepReport) {
        let scan = self.deskewed(scan);
        let odometer = self.odometry_at(scan.stamp());
        if let Some(odometer) = odometer {
            self.latest.pose_monitor.add_scan(odometer.pose, &scan);
            let (perception, times) = (self.perception.as_mut(), &mut self.times);
            let place =
                perception.and_then(|perception| perception.search_pose(odometer.pose, &scan, true, times));
            self.apply_global_localization(place);
        }
        self.on_scan(scan, report);
    }

    /// The scan with its beams corrected by the odometry for the motion during the sweep.
    fn deskewed(&self, scan: &Scan) -> Scan {
        let odom_from_base = |stamp| self.localizer.odometry_at(stamp).ok().map(|odometer| odometer.pose);
        if self.range_sensor.deskews {
            trundle_core::deskewed(scan.clone(), odom_from_base)
        } else {
            scan.clone()
        }
    }

    /// While the pose is unknown, applies the result of global localization, or begins the search.
    pub(super) fn apply_global_localization(&mut self, place: Option<LocalizedPose>) {
        if let Some(LocalizedPose { stamp, map_from_base, covariance }) = place
            && self.is_lost()
        {
            let before = self.localizer.estimate().pose;
            // The search compares with the whole grid: the error of one part of it is not the error of the pose.
            let map = PoseUncertainty::default();
            let scan = ScanPose { stamp, map_from_base, covariance, map };
            let correction = self.localizer.correct_scan(&scan);
            event_log::correction(stamp, "global localization", before, self.localizer.estimate().pose);
            match correction {
                Correction::Applied { .. } => {
                    self.latest.pose_monitor.localized_by_scans();
                }
                // After a displacement the found pose replaces the estimate, independent of its uncertainty.
                _ if self.latest.pose_monitor.is_displaced() => self.localizer.set_pose_unknown(),
                // The found place is a look-alike: the search restarts.
                _ => self.perception.iter_mut().for_each(|perception| perception.global_localization.end()),
            }
        }
        let is_lost = self.is_lost();
        let Some(perception) = &mut self.perception else { return };
        match (is_lost, perception.global_localization.is_sought()) {
            (true, false) if self.mapping.mapper.is_redrawing() => {}
            (true, false) => perception.global_localization.search_pose(self.mapping.grid().clone()),
            (false, true) => perception.global_localization.end(),
            _ => {}
        }
    }

    /// Whether a scan is consistent with the map at the estimated pose. While images are located, it counts as consistent. Without a
    /// located image for 0.8 s, a contradiction means that the robot was carried away.
    pub(super) fn is_consistent_with_map(&mut self, scan: &Scan) -> bool {
        let (now, watch) = (scan.stamp(), &mut self.latest.scan_map_consistency);
        if self.range_sensor.source == RangeSource::Laser {
            return true;
        }
        if self.latest.located.is_some_and(|located| now - located <= MAX_VISUAL_MOTION_AGE_S) {
            watch.forget();
            return true;
        }
        let Ok(pose) = self.localizer.pose_at(now) else { return true };
        let fit = watch.judge(self.mapping.grid(), pose, scan);
        if fit == Fit::Elsewhere && self.latest.pose_monitor.is_displaced() {
            self.carried_away();
        }
        fit == Fit::Fits
    }

    /// The status of the pose at `now`.
    pub(super) fn pose_status(&self, now: Stamp) -> PoseStatus {
        let monitor = &self.latest.pose_monitor;
        PoseStatus {
            certainty: self.pose_certainty(),
            is_contradicted: monitor.is_contradicted(),
            is_doubtful: monitor.is_doubtful(now) || self.latest.body.is_lifted(),
        }
    }

    fn pose_certainty(&self) -> PoseCertainty {
        PoseCertainty::of(&self.localizer.estimate(), self.lost_sigma)
    }

    /// Whether the pose is too uncertain to drive, or unknown.
    pub(super) fn is_lost(&self) -> bool {
        self.pose_certainty().is_lost()
    }

    /// Handles a displacement: the pose is unknown, and the search includes the visual maps.
    pub(super) fn carried_away(&mut self) {
        self.lose_pose();
        self.perception.iter_mut().for_each(|perception| perception.kidnapped());
    }

    /// Sets the pose unknown.
    pub(super) fn lose_pose(&mut self) {
        self.localizer.set_pose_unknown();
        self.latest.scan_map_consistency.forget();
        self.obstacles.clear();
    }
}
