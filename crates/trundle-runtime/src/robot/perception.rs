//! Processing of images: the visual pose corrects the estimate, and the scan of the depth image enters the grid.

use super::{Robot, event_log, event_log::DroppedImage};
use crate::{
    report::StepReport, scan_pose_log::ScanPoseLog, stage::Stage,
    workers::perception_worker::PerceptionResult,
};
use std::sync::Arc;
use trundle_core::{Pose3, RgbdImage, Stamp};
use trundle_estimation::{Correction, VisualPose, VisualQuality};
use trundle_slam::{TrackReport, Tracking};

/// Correction of the pose \[m\] above which obstacle tracks restart: motion is not measured from scans on both sides of a jump. Source: ours.
const JUMP_M: f64 = 0.1;
/// Correction of the heading above which obstacle tracks restart \[rad\]. Source: ours.
const JUMP_RAD: f64 = 0.1;

impl Robot {
    /// Processes an image, or queues it for a job.
    pub(super) fn on_image(&mut self, image: &RgbdImage, report: &mut StepReport) {
        if self.steering.background.is_used() {
            return self.images.push(image.clone().into());
        }
        let Some(odometer) = self.odometry_at(image.stamp()) else { return };
        let Some(perception) = &mut self.perception else { return };
        report.image = Some(image.stamp());
        match perception.process(image, odometer, &mut self.times) {
            Some(result) => self.apply_perception(result, report),
            None => self.drop_frozen(image.stamp()),
        }
    }

    /// Applies the result of an image: the visual pose corrects the estimate. At the grid's rate the scan corrects it too and enters the
    /// grid.
    pub(super) fn apply_perception(&mut self, result: PerceptionResult, report: &mut StepReport) {
        let PerceptionResult { odom_from_base, track, scan, place, corrected_trajectory, visual_snapshot } =
            result;
        if let Some(scan) = &scan {
            self.latest.pose_monitor.add_scan(odom_from_base, scan);
        }
        let is_corrected = corrected_trajectory.is_some();
        let visual = visual_pose(&track, is_corrected);
        let judge = |visual| self.judge_visual_pose(visual, is_corrected, scan.as_ref());
        let verdict = visual.as_ref().map(judge);
        let before = self.localizer.estimate().pose;
        let correction =
            visual.as_ref().zip(verdict).map(|(visual, verdict)| self.correct_by_image(visual, verdict));
        self.add_image_evidence(&track, verdict, correction, odom_from_base);
        report.measurements.visual = visual;
        event_log::correction(track.stamp, "the visual pose", before, self.localizer.estimate().pose);
        if correction == Some(Correction::Reanchored) {
            // The scans already drawn are not moved: their visual poses are in a frame that has moved.
            self.mapping.scan_poses = ScanPoseLog::default();
        }
        let continues = track.tracking == Tracking::Ok && !is_corrected && !track.relocalised;
        let continues = continues && matches!(correction, Some(Correction::Applied { .. }));
        let base = track.visual_from_camera * self.base_from_camera.inverse();
        if continues {
            self.odometry.add_visual_pose(track.stamp, odom_from_base, base);
        } else {
            self.odometry.break_visual_track(track.stamp);
        }
        let is_followed = correction != Some(Correction::Reanchored);
        if let Some(trajectory) = corrected_trajectory.filter(|_| is_followed) {
            self.redraw_from_visual_map(&trajectory);
        }
        self.apply_global_localization(place);
        let jump = before.inverse() * self.localizer.estimate().pose;
        if jump.position().norm() > JUMP_M || jump.theta.abs() > JUMP_RAD {
            self.obstacles.clear();
        }
        if let Some(scan) = scan {
            let stamp = scan.stamp();
            let is_drawn = self.on_scan(scan, report);
            if is_drawn
                && track.tracking.is_located()
                && self.mapping.note_scan_pose(stamp, track.visual_from_camera)
            {
                self.perception
                    .iter_mut()
                    .for_each(|perception| perception.forget_frames(&self.mapping.scan_poses));
            }
        }
        // During a redraw the grid does not agree with the corrected visual map.
        let fits = self.is_pose_known(track.stamp) && !self.mapping.mapper.is_redrawing();
        let visual_snapshot = visual_snapshot.filter(|_| fits);
        let checkpoint = visual_snapshot.map(|visual| Arc::new(self.checkpoint_with(visual)));
        report.checkpoint = checkpoint.or(report.checkpoint.take());
        report.track = Some(track);
    }

    /// Counts an image of a frozen camera.
    pub(super) fn drop_frozen(&mut self, stamp: Stamp) {
        self.latest.frozen += 1;
        event_log::dropped_image(stamp, DroppedImage::Frozen);
    }

    /// Applies a correction of the visual map: the grid is redrawn from the corrected poses of its scans.
    fn redraw_from_visual_map(&mut self, trajectory: &[(Stamp, Pose3)]) {
        let Self { mapping, localizer, base_from_camera, times, .. } = self;
        let camera_from_base = base_from_camera.inverse();
        let visual_base = |visual_from_camera: &Pose3| {
            Some((localizer.map_from_visual()? * *visual_from_camera * camera_from_base).to_pose2())
        };
        if times.measure(Stage::Mapping, || mapping.correct(trajectory, visual_base)) {
            // A search in the old grid is void and restarts in the new one.
            self.perception.iter_mut().for_each(|perception| perception.global_localization.end());
        }
    }
}

/// The visual pose of a located image. A pose in a map that was just corrected counts as recognised.
fn visual_pose(track: &TrackReport, is_corrected: bool) -> Option<VisualPose> {
    let quality = match track.tracking {
        Tracking::Ok => VisualQuality::Ok,
        Tracking::Weak => VisualQuality::Weak,
        Tracking::DeadReckoning | Tracking::Lost => return None,
    };
    Some(VisualPose {
        stamp: track.stamp,
        visual_from_camera: track.visual_from_camera,
        covariance: track.covariance,
        quality,
        map: track.map.number(),
        recognised: track.relocalised || is_corrected,
    })
}
