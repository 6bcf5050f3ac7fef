//! Use of scans: correction of the estimate, map, dynamic obstacles.

use super::{Robot, event_log};
use crate::report::StepReport;
use crate::stage::Stage;
use trundle_core::Scan;
use trundle_estimation::{PlanarMeasurement, ScanPose};

impl Robot {
    /// Processes a scan for safety and, at the map's rate, for estimate and map. Returns whether the scan was drawn.
    pub(super) fn on_scan(&mut self, scan: Scan, report: &mut StepReport) -> bool {
        self.confirm_pose(&scan);
        let is_due = self.mapping.is_due(scan.stamp()) && self.is_pose_known(scan.stamp());
        let is_due = is_due && self.is_consistent_with_map(&scan);
        if is_due {
            report.measurements.scan = self.correct_by_scan(&scan);
            self.integrate_scan(&scan);
        }
        self.track_dynamic_obstacles(&scan);
        // The safety monitor keeps the last scan with content.
        if self.latest.camera_health.note(&scan) || self.latest.camera_health.seen().is_none() {
            self.latest.scan_odometry = self.odometry_at(scan.stamp()).map(|odometer| odometer.pose);
            self.latest.scan = Some(scan);
        }
        is_due
    }

    /// Ends a contradiction of scans and odometry, if the scans since then fit the map at the estimate.
    fn confirm_pose(&mut self, scan: &Scan) {
        if !self.latest.pose_monitor.is_contradicted() {
            return;
        }
        let (pose, odometer) =
            (self.localizer.pose_at(scan.stamp()), self.localizer.odometry_at(scan.stamp()));
        if let (Ok(pose), Ok(odometer)) = (pose, odometer) {
            self.latest.pose_monitor.confirm_by_scans(self.mapping.grid(), pose, odometer.pose);
        }
    }

    /// Tracks dynamic obstacles with the newest scan.
    fn track_dynamic_obstacles(&mut self, scan: &Scan) {
        let now = scan.stamp();
        if !self.is_pose_known(now) {
            return self.obstacles.skip_scan(now, self.localizer.estimate().pose.position());
        }
        let Ok(pose) = self.localizer.pose_at(now) else { return };
        let (obstacles, grid) = (&mut self.obstacles, self.mapping.grid());
        self.times.measure(Stage::DynamicObstacles, || obstacles.add_scan(pose, scan, grid));
    }

    /// Corrects the estimate by a scan match; returns the measurement.
    fn correct_by_scan(&mut self, scan: &Scan) -> Option<PlanarMeasurement> {
        let stamp = scan.stamp();
        let guess = self.localizer.pose_at(stamp).ok()?;
        let found = self.times.measure(Stage::ScanMatch, || self.mapping.matched(scan, guess))?;
        let map = self.mapping.uncertainty_at(found.pose, scan)?;
        let before = self.localizer.estimate().pose;
        let (map_from_base, covariance) = (found.pose, found.covariance);
        self.localizer.correct_scan(&ScanPose { stamp, map_from_base, covariance, map });
        event_log::correction(stamp, "the scan match", before, self.localizer.estimate().pose);
        Some(PlanarMeasurement { stamp, pose: found.pose, covariance: found.covariance })
    }

    /// Draws the scan and the floor under the robot into the map, if a pose is known for its stamp.
    fn integrate_scan(&mut self, scan: &Scan) {
        let stamp = scan.stamp();
        let (Ok(pose), Ok(drawn)) = (self.localizer.pose_at(stamp), self.localizer.uncertainty_at(stamp))
        else {
            return;
        };
        self.times.measure(Stage::Mapping, || self.mapping.integrate_scan(pose, &drawn, scan));
    }
}
