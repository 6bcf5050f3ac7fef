//! The perception worker: camera pose by SLAM and scan, from an image.

use crate::{
    checkpoint::schedule::CheckpointSchedule,
    config::RobotConfig,
    global_localization::{GlobalLocalization, LocalizedPose},
    monitors::camera_health::CameraHealth,
    range_source::RangeSource,
    scan_pose_log::ScanPoseLog,
    stage::{Stage, StageTimes},
};
use std::sync::Arc;
use trundle_core::{CameraMotion, Invalid, Pose2, Pose3, RgbdImage, Scan, Stamp};
use trundle_estimation::OdometryState;
use trundle_mapping::DepthScanner;
use trundle_slam::{MapFileError, RgbdSlam, TrackReport};
use trundle_vision::Vocabulary;

/// Processing of images: the camera's pose by SLAM, and the scan.
///
/// The results depend only on the sequence of images and odometry, so the worker may run in parallel with the control loop.
#[derive(Debug)]
pub(crate) struct PerceptionWorker {
    range_source: RangeSource,
    base_from_camera: Pose3,
    slam: RgbdSlam,
    scanner: DepthScanner,
    camera_health: CameraHealth,
    /// Search for the pose by scans, while it is unknown.
    pub(crate) global_localization: GlobalLocalization,
    /// Odometry at the last image.
    last: Option<OdometryState>,
    /// Schedule of the checkpoints; `None` for no checkpoints.
    pub(crate) saving: Option<CheckpointSchedule>,
}

/// Result of an image.
#[derive(Debug)]
pub(crate) struct PerceptionResult {
    /// Odometry at the stamp of the image.
    pub(crate) odom_from_base: Pose2,
    pub(crate) track: TrackReport,
    /// Scan of the image, with the depth camera as range source.
    pub(crate) scan: Option<Scan>,
    /// Pose that global localization found, while the pose is unknown.
    pub(crate) place: Option<LocalizedPose>,
    /// All poses of the visual map, after a correction that tracking does not follow.
    pub(crate) corrected_trajectory: Option<Vec<(Stamp, Pose3)>>,
    /// The visual maps as bytes, if a checkpoint was due.
    pub(crate) visual_snapshot: Option<Vec<u8>>,
}

/// Correction of the visual map \[m, rad\] above which the grid is corrected. Source: ours.
const GRID_CORRECTION_THRESHOLD: f64 = 0.02;
/// Minimum number of features for locating an image. Source: ours.
pub(crate) const MIN_FEATURES_TO_LOCATE: usize = 200;

impl PerceptionWorker {
    pub(crate) fn new(config: &RobotConfig, base_from_camera: Pose3) -> Result<Self, Invalid> {
        let scanner = DepthScanner::new(config.camera, base_from_camera, config.scan.clone())?;
        let blind_range = blind_range(config.sight, &scanner);
        Ok(Self {
            range_source: config.sight,
            base_from_camera,
            slam: RgbdSlam::new(config.camera, config.slam.clone())?,
            scanner,
            global_localization: GlobalLocalization::new(config, blind_range)?,
            camera_health: CameraHealth::default(),
            last: None,
            saving: None,
        })
    }

    /// Loads saved visual maps. The camera's pose in them is unknown until a place is recognised.
    pub(crate) fn load_maps(&mut self, config: &RobotConfig, visual: &[u8]) -> Result<(), MapFileError> {
        self.slam = RgbdSlam::load(visual, config.camera, config.slam.clone())?;
        Ok(())
    }

    /// Sets the vocabulary of place recognition.
    pub(crate) fn set_vocabulary(&mut self, vocabulary: &Arc<Vocabulary>) {
        self.slam.set_vocabulary(vocabulary);
    }

    pub(crate) fn slam(&self) -> &RgbdSlam {
        &self.slam
    }

    /// Minimum range of a usable scan, m.
    pub(crate) fn blind_range(&self) -> f64 {
        blind_range(self.range_source, &self.scanner)
    }

    /// Processes an image taken at this odometry; `None` for an image of a frozen camera.
    pub(crate) fn process(
        &mut self,
        image: &RgbdImage,
        odometer: OdometryState,
        times: &mut StageTimes,
    ) -> Option<PerceptionResult> {
        let odom_from_base = odometer.pose;
        if self.camera_health.is_frozen(image, odom_from_base) {
            return None;
        }
        let prior = self.camera_motion_since_last_image(odometer);
        let track = times.measure(Stage::Slam, || self.slam.step(image, prior));
        let corrected_trajectory = is_corrected(&track).then(|| self.slam.trajectory());
        let scan = match self.range_source {
            RangeSource::DepthCamera => Some(times.measure(Stage::Scan, || self.scanner.scan(image))),
            RangeSource::Laser => None,
        };
        let in_the_dark = track.features < MIN_FEATURES_TO_LOCATE;
        let place = scan.as_ref().and_then(|scan| self.search_pose(odom_from_base, scan, in_the_dark, times));
        let visual_snapshot = self.save(image.stamp(), times);
        Some(PerceptionResult { odom_from_base, track, scan, place, corrected_trajectory, visual_snapshot })
    }

    /// Drops the poses of frames whose scans can no longer move.
    pub(crate) fn forget_frames(&mut self, scan_poses: &ScanPoseLog) {
        self.slam.forget_frames(|stamp| scan_poses.has(stamp));
    }

    /// The visual maps as bytes, if a checkpoint is due.
    fn save(&mut self, now: Stamp, times: &mut StageTimes) -> Option<Vec<u8>> {
        let saving = self.saving.as_mut().filter(|saving| saving.is_due(now))?;
        let visual_snapshot = times.measure(Stage::Checkpoint, || self.slam.save());
        saving.saved(now, visual_snapshot.len());
        Some(visual_snapshot)
    }

    /// Continues the search for an unknown pose with a scan.
    pub(crate) fn search_pose(
        &mut self,
        odom_from_base: Pose2,
        scan: &Scan,
        in_the_dark: bool,
        times: &mut StageTimes,
    ) -> Option<LocalizedPose> {
        let global_localization = &mut self.global_localization;
        let is_sought = global_localization.is_sought();
        let look = || global_localization.on_scan(odom_from_base, scan, in_the_dark);
        is_sought.then(|| times.measure(Stage::Search, look)).flatten()
    }

    /// Resets the tracker after a displacement was detected, so that a recognised place may be at any pose.
    pub(crate) fn kidnapped(&mut self) {
        self.slam.kidnapped();
    }

    /// `previous_camera_from_camera` by wheels and gyro.
    fn camera_motion_since_last_image(&mut self, odometer: OdometryState) -> Option<CameraMotion> {
        let previous = self.last.replace(odometer)?;
        Some(CameraMotion::of_base(odometer.since(&previous), self.base_from_camera))
    }
}

/// Minimum range of a usable scan, m.
fn blind_range(sight: RangeSource, scanner: &DepthScanner) -> f64 {
    match sight {
        RangeSource::DepthCamera => scanner.blind_range(),
        RangeSource::Laser => 0.0,
    }
}

/// Whether the visual map had a correction that tracking does not follow.
fn is_corrected(track: &TrackReport) -> bool {
    let is_large = |correction: &Pose3| {
        correction.translation.norm() > GRID_CORRECTION_THRESHOLD
            || correction.log().norm() > GRID_CORRECTION_THRESHOLD
    };
    track.closed_loop.is_some() || track.merged.is_some() || track.refined.as_ref().is_some_and(is_large)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{DepthImage, Image};

    /// The report on a grey image without usable features.
    fn blank() -> TrackReport {
        let config = RobotConfig::default();
        let (width, height) = (config.camera.width(), config.camera.height());
        let grey = Image::filled(width, height, [90; 3]);
        let image = RgbdImage::new(Stamp::default(), grey, DepthImage::filled(width, height, 2.0)).unwrap();
        let slam = RgbdSlam::new(config.camera, config.slam);
        slam.unwrap().step(&image, None)
    }

    #[test]
    fn only_a_correction_that_tracking_does_not_go_along_with_bends_the_map() {
        let refined = |metres: f64| {
            let moved = Pose3::from_pose2(Pose2::new(0.0, metres, 0.0));
            is_corrected(&TrackReport { refined: Some(moved), ..blank() })
        };
        assert!(!is_corrected(&blank()));
        assert!(!refined(0.9 * GRID_CORRECTION_THRESHOLD) && refined(1.1 * GRID_CORRECTION_THRESHOLD));
    }
}
