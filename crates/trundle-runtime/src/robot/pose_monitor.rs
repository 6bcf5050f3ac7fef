//! Detection of an unknown pose, and global localization by scans.

use super::{Robot, event_log};
use crate::{
    behaviour::navigator::position_sigma, global_localization::LocalizedPose, range_source::RangeSource,
    workers::perception_worker::shows_enough,
};
use nalgebra::Matrix3;
use trundle_core::{Pose2, PoseEstimate, Scan, Stamp};
use trundle_estimation::{Correction, Localizer, PoseDecision, PoseSource, PoseState};
use trundle_slam::TrackReport;

/// Distance of a visual pose from the estimate within which the localizer alone decides \[m\]. Source: ours.
const NEAR_M: f64 = 0.25;
/// The same for the heading \[rad\]: 6 deg. Source: ours.
const NEAR_RAD: f64 = 0.1;
/// Distance that the estimate may have drifted without a sign of it \[m\]. Source: ours.
const DRIFT_M: f64 = 1.0;
/// The same for the heading \[rad\]: 20 deg. Source: ours.
const DRIFT_RAD: f64 = 0.35;
/// Log-likelihood ratio of the scans for the estimate above which they object to a visual pose within the drift \[nats\]. Source: ours.
const OBJECTION_NATS: f64 = 6.0;

/// Why scans object to a visual pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Objection {
    /// An image recognises a place where the robot is not.
    FalseRecognition,
    /// The visual map followed something that moves: its frame lies elsewhere.
    FrameMoved,
}

impl Robot {
    /// A scan of a laser that is the range source.
    pub(super) fn on_laser(&mut self, scan: &Scan) {
        let odometer = self.odometry_at(scan.stamp());
        if let (Some(perception), Some(odometer)) = (&mut self.perception, odometer) {
            let place = perception.search_pose(odometer.pose, scan, true, &mut self.times);
            self.apply_global_localization(place);
        }
        self.on_scan(scan.clone());
    }

    /// While the pose is unknown, applies the pose that global localization found, or begins the search.
    pub(super) fn apply_global_localization(&mut self, place: Option<LocalizedPose>) {
        let lost_sigma = self.lost_sigma;
        let is_lost = |localizer: &Localizer| position_sigma(&localizer.estimate()) >= lost_sigma;
        if let Some(place) = place
            && is_lost(&self.localizer)
        {
            self.take_found_pose(&place);
        }
        let is_lost = is_lost(&self.localizer);
        let Some(perception) = &mut self.perception else { return };
        match (is_lost, perception.global_localization.is_sought()) {
            (true, false) if self.mapper.is_redrawing() => {}
            (true, false) => perception.global_localization.search_pose(self.mapper.grid().clone()),
            (false, true) => perception.global_localization.end(),
            _ => {}
        }
    }

    /// Takes a found pose over where it agrees with the estimate, or is far more probable than the estimate and any other place.
    fn take_found_pose(&mut self, found: &LocalizedPose) {
        let now = found.stamp;
        let Some(odometer) = self.odometry_at(now) else { return };
        if self.is_far_more_probable(now, found.map_from_base, odometer.pose, PoseSource::Scans) {
            self.set_pose(now, found.map_from_base, &found.covariance, "global localization");
        }
    }

    /// Whether a found pose of the base is far more probable than the estimate and any other place.
    fn is_far_more_probable(&self, now: Stamp, found: Pose2, odometer: Pose2, source: PoseSource) -> bool {
        let map_from_odom = |pose: Pose2| pose * odometer.inverse();
        let here = self.localizer.pose_at(now).map_or(Pose2::IDENTITY, map_from_odom);
        let found_odom = map_from_odom(found);
        let probability =
            self.pose_monitor.probability_of(self.mapper.grid(), (found_odom, source), here, now);
        let is_enough = self.pose_monitor.is_enough(probability);
        if !is_enough {
            event_log::found_pose_refused(now, found, probability);
        }
        is_enough
    }

    /// The objection of the scans to a visual pose far from an estimate that is believed.
    pub(super) fn objection(&self, track: &TrackReport, odom_from_base: Pose2) -> Option<Objection> {
        let now = track.stamp;
        if !track.tracking.is_located() || !self.pose_monitor.status(now).is_believed() {
            return None;
        }
        let anchor = *self.localizer.visual_maps().get(&track.map.number())?;
        let here = self.localizer.pose_at(now).ok()?;
        let camera_from_base = self.base_from_camera.inverse();
        let found = (anchor.map_from_visual * track.visual_from_camera * camera_from_base).to_pose2();
        let off = here.inverse() * found;
        let is_within =
            |distance: f64, turn: f64| off.position().norm() <= distance && off.theta.abs() <= turn;
        if is_within(NEAR_M, NEAR_RAD) {
            return None;
        }
        let kind = if track.relocalised { Objection::FalseRecognition } else { Objection::FrameMoved };
        let is_refused = if is_within(DRIFT_M, DRIFT_RAD) {
            let nats_at = |pose: Pose2| {
                self.pose_monitor.scan_nats_at(self.mapper.grid(), pose * odom_from_base.inverse())
            };
            nats_at(here) - nats_at(found) > OBJECTION_NATS
        } else {
            !self.is_far_more_probable(now, found, odom_from_base, PoseSource::Images)
        };
        is_refused.then_some(kind)
    }

    /// A pose in place of the estimate.
    pub(super) fn set_pose(&mut self, at: Stamp, pose: Pose2, covariance: &Matrix3<f64>, source: &str) {
        let before = self.localizer.estimate().pose;
        self.localizer.set_pose_unknown();
        self.localizer.correct_scan(at, pose, covariance);
        self.pose_monitor.set_pose();
        event_log::correction(at, source, before, self.localizer.estimate().pose);
    }

    /// An image as evidence for the estimate, or against it. A located image gives an unknown pose.
    pub(super) fn add_image_evidence(&mut self, track: &TrackReport, correction: Option<Correction>) {
        let is_applied = correction.is_some_and(|correction| correction.is_applied());
        let is_located =
            is_applied || matches!(correction, Some(Correction::Anchored | Correction::Reanchored));
        let state = self.pose_monitor.status(track.stamp).state;
        if is_applied && matches!(state, PoseState::Displaced | PoseState::Unknown) {
            self.pose_monitor.set_pose();
        }
        self.pose_monitor.add_image(track.stamp, shows_enough(track), is_located);
        self.review_pose(track.stamp);
    }

    /// A scan as evidence for the estimate, or against it.
    pub(super) fn add_scan_evidence(&mut self, scan: &Scan) {
        let now = scan.stamp();
        if self.range_source == RangeSource::Laser {
            return;
        }
        let (Ok(pose), Some(odometer)) = (self.localizer.pose_at(now), self.odometry_at(now)) else { return };
        let estimate = PoseEstimate { stamp: now, pose, ..self.localizer.estimate() };
        self.pose_monitor.add_scan(self.mapper.grid(), &estimate, odometer.pose, scan);
        self.review_pose(now);
    }

    /// Keeps the estimate, gives it up, or restores it.
    fn review_pose(&mut self, now: Stamp) {
        let (Ok(pose), Some(odometer)) = (self.localizer.pose_at(now), self.odometry_at(now)) else { return };
        match self.pose_monitor.review(now, pose * odometer.pose.inverse()) {
            PoseDecision::Keep => {}
            PoseDecision::GiveUp => self.lose_pose(),
            PoseDecision::Restore { map_from_odom, covariance } => {
                self.localizer.set_pose_unknown();
                self.localizer.correct_scan(now, map_from_odom * odometer.pose, &covariance);
                event_log::pose_restored(now);
            }
        }
    }

    /// It was carried away.
    pub(super) fn lose_pose(&mut self) {
        event_log::pose_given_up(self.latest.sensors.newest());
        self.localizer.set_pose_unknown();
        self.clear_dynamic_obstacles();
        self.perception.iter_mut().for_each(|perception| perception.kidnapped());
    }
}
