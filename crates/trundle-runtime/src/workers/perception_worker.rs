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

/// All that is done with an image alone: the camera's pose by SLAM, and the scan.
///
/// Its results depend only on its images and odometry, in their order. It may therefore run beside the control loop.
#[derive(Debug)]
pub(crate) struct PerceptionWorker {
    range_source: RangeSource,
    base_from_camera: Pose3,
    slam: RgbdSlam,
    scanner: DepthScanner,
    camera_health: CameraHealth,
    /// The place by scans, while it is not known.
    pub(crate) global_localization: GlobalLocalization,
    /// Whether scans gave the last pose.
    is_placed_by_scans: bool,
    /// Odometry at the last image.
    last: Option<OdometryState>,
    /// Since when images that show enough have not been located.
    unlocated: Option<Stamp>,
    /// Stamp at which global localization last began in that time.
    searched: Option<Stamp>,
    /// Schedule of the checkpoints; none: never.
    pub(crate) saving: Option<CheckpointSchedule>,
}

/// Result of an image.
#[derive(Debug)]
pub(crate) struct PerceptionResult {
    /// When the image was taken.
    pub(crate) odom_from_base: Pose2,
    pub(crate) track: TrackReport,
    /// Scan of the image, with the depth camera as range source.
    pub(crate) scan: Option<Scan>,
    /// Pose that global localization found, while the pose is unknown.
    pub(crate) place: Option<LocalizedPose>,
    /// Since when images that show enough have not been located.
    pub(crate) unlocated: Option<Stamp>,
    /// All poses of the visual map, after a correction that tracking does not follow.
    pub(crate) corrected_trajectory: Option<Vec<(Stamp, Pose3)>>,
    /// Whether the robot was carried away: global localization begins.
    pub(crate) is_carried_away: bool,
    /// The visual maps, when it was time to save them.
    pub(crate) visual_snapshot: Option<Vec<u8>>,
}

/// Correction of the visual map \[m, rad\] above which the grid is corrected. Source: ours.
const GRID_CORRECTION_THRESHOLD: f64 = 0.02;
/// Number of features of an image that suffices to locate it. Source: ours.
const MIN_FEATURES_TO_LOCATE: usize = 200;
/// Time without a located image \[s\] after which images with enough features show another place than the estimate. Source: ours.
const KIDNAPPED_AFTER_S: f64 = 1.5;
/// Time without a located image \[s\] after which the pose is unknown; images with few features do not change that. Source: ours.
pub(crate) const POSE_UNKNOWN_AFTER_S: f64 = 0.7;

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
            is_placed_by_scans: false,
            last: None,
            unlocated: None,
            searched: None,
            saving: None,
        })
    }

    /// Goes on with saved visual maps; where in them the camera is it has to recognise.
    pub(crate) fn load_maps(&mut self, config: &RobotConfig, visual: &[u8]) -> Result<(), MapFileError> {
        self.slam = RgbdSlam::load(visual, config.camera, config.slam.clone())?;
        Ok(())
    }

    /// Recognises places by this vocabulary.
    pub(crate) fn set_vocabulary(&mut self, vocabulary: &Arc<Vocabulary>) {
        self.slam.set_vocabulary(vocabulary);
    }

    pub(crate) fn slam(&self) -> &RgbdSlam {
        &self.slam
    }

    /// Nearer than this its scans show nothing, m.
    pub(crate) fn blind_range(&self) -> f64 {
        blind_range(self.range_source, &self.scanner)
    }

    /// Processes an image that was taken at this odometry; none for an image of a frozen camera.
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
        let is_carried_away = self.is_carried_away(&track);
        if is_carried_away {
            self.slam.kidnapped();
        }
        let corrected_trajectory = is_corrected(&track).then(|| self.slam.trajectory());
        let scan = match self.range_source {
            RangeSource::DepthCamera => Some(times.measure(Stage::Scan, || self.scanner.scan(image))),
            RangeSource::Laser => None,
        };
        let in_the_dark = track.features < MIN_FEATURES_TO_LOCATE;
        let place = scan.as_ref().and_then(|scan| self.search_pose(odom_from_base, scan, in_the_dark, times));
        let visual_snapshot = self.save(image.stamp(), times);
        let unlocated = self.unlocated;
        Some(PerceptionResult {
            odom_from_base,
            track,
            scan,
            place,
            unlocated,
            is_carried_away,
            corrected_trajectory,
            visual_snapshot,
        })
    }

    /// Poses are wanted from now on of frames whose scans may still move.
    pub(crate) fn forget_frames(&mut self, scan_poses: &ScanPoseLog) {
        self.slam.forget_frames(|stamp| scan_poses.has(stamp));
    }

    /// The visual maps, when it is time to save them.
    fn save(&mut self, now: Stamp, times: &mut StageTimes) -> Option<Vec<u8>> {
        let saving = self.saving.as_mut().filter(|saving| saving.is_due(now))?;
        let visual_snapshot = times.measure(Stage::Checkpoint, || self.slam.save());
        saving.saved(now, visual_snapshot.len());
        Some(visual_snapshot)
    }

    /// Searches the pose by a scan, while it is unknown.
    pub(crate) fn search_pose(
        &mut self,
        odom_from_base: Pose2,
        scan: &Scan,
        in_the_dark: bool,
        times: &mut StageTimes,
    ) -> Option<LocalizedPose> {
        let global_localization = &mut self.global_localization;
        let is_sought = global_localization.is_sought();
        let look = || global_localization.look(odom_from_base, scan, in_the_dark);
        is_sought.then(|| times.measure(Stage::Search, look)).flatten()
    }

    /// It was carried away, as others have found out: where images show the place again, it may be anywhere.
    pub(crate) fn kidnapped(&mut self) {
        self.slam.kidnapped();
    }

    /// Scans gave the pose. Images that are not recognised do not make it unknown again until one is located.
    pub(crate) fn localized_by_scans(&mut self) {
        self.is_placed_by_scans = true;
        (self.unlocated, self.searched) = (None, None);
    }

    /// `previous_camera_from_camera` by wheels and gyro.
    fn camera_motion_since_last_image(&mut self, odometer: OdometryState) -> Option<CameraMotion> {
        let previous = self.last.replace(odometer)?;
        Some(CameraMotion::of_base(odometer.since(&previous), self.base_from_camera))
    }

    /// Whether global localization is due: no image was located for a while.
    fn is_carried_away(&mut self, track: &TrackReport) -> bool {
        let shows_enough = track.features >= MIN_FEATURES_TO_LOCATE;
        self.is_placed_by_scans &= !track.tracking.is_located();
        if self.is_placed_by_scans {
            return false;
        }
        if track.tracking.is_located() || !shows_enough && !self.is_unplaced_for_long(track.stamp) {
            (self.unlocated, self.searched) = (None, None);
        }
        if track.tracking.is_located() || !shows_enough {
            return false;
        }
        let since = *self.unlocated.get_or_insert(track.stamp);
        let is_time = track.stamp - self.searched.unwrap_or(since) > KIDNAPPED_AFTER_S;
        if is_time {
            self.searched = Some(track.stamp);
        }
        is_time
    }

    /// With an unknown pose, a view without features does not restart the time.
    fn is_unplaced_for_long(&self, now: Stamp) -> bool {
        self.unlocated.is_some_and(|since| now - since > POSE_UNKNOWN_AFTER_S)
    }
}

/// Nearer than this its scans show nothing, m.
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
    use trundle_slam::Tracking;

    fn worker() -> PerceptionWorker {
        let config = RobotConfig::default();
        PerceptionWorker::new(&config, config.mount.base_from_camera()).unwrap()
    }

    /// The report on a grey image, which shows nothing to locate it by.
    fn blank() -> TrackReport {
        let config = RobotConfig::default();
        let (width, height) = (config.camera.width(), config.camera.height());
        let grey = Image::filled(width, height, [90; 3]);
        let image = RgbdImage::new(Stamp::default(), grey, DepthImage::filled(width, height, 2.0)).unwrap();
        let slam = RgbdSlam::new(config.camera, config.slam);
        slam.unwrap().step(&image, None)
    }

    /// The seconds at which the robot counts as carried away. Images come every 0.1 s, show `features`, and are located where
    /// `is_located` is true.
    fn carried_away(
        worker: &mut PerceptionWorker,
        features: impl Fn(u32) -> usize,
        is_located: impl Fn(u32) -> bool,
    ) -> Vec<f64> {
        let blank = blank();
        let is_carried_away = |i: &u32| {
            let tracking = if is_located(*i) { Tracking::Ok } else { Tracking::Lost };
            let stamp = Stamp::default().after(0.1 * f64::from(*i));
            worker.is_carried_away(&TrackReport { stamp, tracking, features: features(*i), ..blank.clone() })
        };
        (0..60).filter(is_carried_away).map(|i| 0.1 * f64::from(i)).collect()
    }

    #[test]
    fn images_that_show_enough_and_are_not_located_show_another_place_after_a_while_and_again() {
        let seconds = carried_away(&mut worker(), |_| MIN_FEATURES_TO_LOCATE, |_| false);
        assert_eq!(seconds.len(), 3, "{seconds:?}");
        assert!((seconds[0] - KIDNAPPED_AFTER_S).abs() < 0.11, "{seconds:?}");
        let pauses = seconds.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(pauses.into_iter().all(|pause| (pause - KIDNAPPED_AFTER_S).abs() < 0.11), "{seconds:?}");
    }

    #[test]
    fn a_located_image_now_and_then_is_enough_and_a_bare_wall_proves_nothing() {
        assert!(carried_away(&mut worker(), |_| 1000, |i| i % 14 == 0).is_empty());
        assert!(carried_away(&mut worker(), |_| MIN_FEATURES_TO_LOCATE - 1, |_| false).is_empty());
    }

    #[test]
    fn before_a_bare_wall_an_unknown_place_stays_unknown_and_a_short_mismatch_ends() {
        let unplaced_after = |doubt: u32| {
            let mut worker = worker();
            carried_away(&mut worker, |i| if i < doubt { 1000 } else { 0 }, |_| false);
            worker.unlocated
        };
        assert_eq!(unplaced_after(5), None);
        assert_eq!(unplaced_after(12), Some(Stamp::default()));
    }

    #[test]
    fn a_place_found_by_scans_holds_until_an_image_is_located_again() {
        let mut worker = worker();
        worker.localized_by_scans();
        assert!(carried_away(&mut worker, |_| 1000, |_| false).is_empty());
        assert_eq!(worker.unlocated, None);
        let seconds = carried_away(&mut worker, |_| 1000, |i| i == 0);
        assert!(!seconds.is_empty(), "images count again");
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
