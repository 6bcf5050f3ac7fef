//! Tracking of a sequence, frame by frame.

use super::depth_check::DepthCheck;
use super::live_view::{SequenceFeed, Tracker};
use super::odometry_prior::OdometryPrior;
use super::recorder::SequenceRecorder;
use super::request::SequenceRequest;
use super::scan_motion::ScanMotion;
use super::trajectory::SequenceTrajectory;
use crate::laser_map::DepthLog;
use crate::operator::OperatorLink;
use crate::report::stage_rows;
use crate::sequence_input::SequenceInput;
use crate::{AppError, StepProgress, TrackCounts, stop};
use std::time::Instant;
use trundle_core::{CameraMotion, Invalid, Pose3, RgbdImage, Stamp};
use trundle_io::{FrameError, OutputFolder, Warnings};
use trundle_runtime::{LevelMap, Stage, StageTimes, base_below};
use trundle_slam::{Mode, RgbdSlam, TrackReport};

/// The result of tracking a sequence.
pub struct SequenceRun {
    /// The tracker with its map.
    pub slam: RgbdSlam,
    /// The floor map's scans.
    pub map: LevelMap,
    /// Frames by tracking state.
    pub counts: TrackCounts,
    /// The last frame that could be read.
    pub last_image: Option<RgbdImage>,
    /// The stamps of the first and the last frame that could be read.
    stamps: Option<(Stamp, Stamp)>,
    /// Frames that could not be read, in words.
    pub unreadable: Vec<String>,
    odometry: OdometryLog,
    /// The poses of the frames.
    pub trajectory: SequenceTrajectory,
    /// Wall-clock time of the stages.
    pub times: StageTimes,
    /// Wall-clock time of the whole, s.
    pub seconds: f64,
    /// Whether the user ended it before the last frame.
    pub is_interrupted: bool,
    depth: DepthCheck,
    /// Calibration issues that were logged.
    logged_issues: usize,
    /// Reason why frames could not be read.
    frame_problems: Warnings,
    /// The requested images that no pass of tracking used.
    left_out: LeftOut,
}

/// The odometry of a sequence.
struct OdometryLog {
    /// Motion to each tracked image from the one before.
    motions: Vec<Option<CameraMotion>>,
    /// Pose of the first camera above the floor, where the camera is on a robot with odometry.
    level_mount: Option<Pose3>,
}

/// Images of an input, and why some are left out before tracking.
#[derive(Debug, Clone, Copy)]
struct LeftOut {
    /// Number of requested images.
    asked: usize,
    /// Number of images without a depth image of their time.
    unpaired: usize,
}

impl LeftOut {
    fn of(request: &SequenceRequest, input: &SequenceInput) -> Self {
        let listed = input.listed();
        let asked = request.frames.map_or(listed, |frames| listed.min(frames));
        Self { asked, unpaired: input.unpaired() }
    }

    /// Reason why one image alone was used, with the first of those that could not be read.
    fn failure(self, unreadable: Option<&String>) -> String {
        let Self { asked, unpaired } = self;
        let cause = match unreadable {
            Some(first) => format!("the others cannot be read, first {first}"),
            None if unpaired > 0 => format!("{unpaired} have no depth image of their time"),
            None => "the others have the same timestamp, expected one timestamp an image".to_owned(),
        };
        format!("of {asked} images only 1 could be used: {cause}")
    }
}

/// Tracks a sequence and records every frame into `recording.mcap` of `folder`; `watch` receives the progress.
///
/// # Errors
/// When a setting is invalid or no frame can be read. If the disk is full, the recording ends and tracking continues.
pub fn track_sequence(
    request: &SequenceRequest,
    input: &SequenceInput,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
    watch: Option<OperatorLink>,
) -> Result<SequenceRun, AppError> {
    let mut run = SequenceRun::new(request, input)?;
    let mut recorder = SequenceRecorder::begin(request.record, folder, input.camera.model.camera)?;
    let mut feed =
        watch.map(|link| SequenceFeed::new(link, input.camera.model.camera, input.robot.mapping.clone()));
    let odometry = OdometryPrior::new(input);
    let frames = request.frames.map_or(input.len(), |frames| input.len().min(frames));
    progress.begin(Some(frames));
    let start = Instant::now();
    for (i, frame) in input.frames()?.take(frames).enumerate() {
        let frame = frame?;
        match frame.decode() {
            Ok(image) => {
                let is_needed = recorder.is_some() || feed.is_some();
                let encoded =
                    is_needed.then(|| frame.encoded(&image)).transpose().map_err(AppError::input)?;
                let report = run.step(image, &odometry);
                if let (Some(feed), Some(image), Some(encoded)) = (&mut feed, &run.last_image, &encoded) {
                    let tracker = Tracker { slam: &run.slam, map: &run.map, times: &run.times };
                    feed.note(image, &encoded.color_jpeg, &report, &tracker, (i + 1, frames));
                }
                if let (Some(recorder), Some(encoded)) = (&mut recorder, encoded) {
                    recorder.record(encoded, &report, &run.slam);
                }
                run.warn_of_calibration(progress);
            }
            Err(error) => run.skip(&error),
        }
        progress.advance();
        run.is_interrupted = i + 1 < frames && stop::is_requested(|| format!("{} of {frames} frames", i + 1));
        if run.is_interrupted {
            break;
        }
    }
    progress.end();
    run.frame_problems.iter().for_each(|warning| tracing::warn!("frames skipped: {warning}"));
    run.slam.finish_refining();
    if let Some(recorder) = recorder {
        recorder.finish(&run.slam, folder);
    }
    if let (None, Some(first)) = (&run.last_image, run.unreadable.first()) {
        let (path, camera) = (input.path.display(), &input.camera.name);
        let problem = format!("{path}: no frame can be read as one of camera {camera} (--camera); {first}");
        return Err(AppError::Input(problem));
    }
    if let (true, 0, Some(images)) =
        (input.odometry().is_some() && frames > 1, run.odometry_priors(), run.stamps)
    {
        let [source, _] = input.pose_sources();
        tracing::warn!("{source}: {}", odometry.why_no_motion(images));
    }
    run.depth.compare(input, &run.slam);
    run.trajectory = run.final_trajectory(request, input)?;
    run.seconds = start.elapsed().as_secs_f64();
    Ok(run)
}

impl SequenceRun {
    fn new(request: &SequenceRequest, input: &SequenceInput) -> Result<Self, AppError> {
        let robot = &input.robot;
        let has_odometry = input.odometry().is_some();
        let level_mount = has_odometry.then(|| request.level_from_first_camera(input)).transpose()?;
        Ok(Self {
            slam: request.slam(input)?,
            map: LevelMap::new(input.camera.model.camera, robot.scan.clone(), robot.schedule.map_hz)?,
            counts: TrackCounts::default(),
            last_image: None,
            stamps: None,
            unreadable: Vec::new(),
            odometry: OdometryLog { motions: Vec::new(), level_mount },
            trajectory: SequenceTrajectory::default(),
            times: StageTimes::default(),
            seconds: 0.0,
            is_interrupted: false,
            depth: DepthCheck::new(input.depth_scale()),
            logged_issues: 0,
            frame_problems: Warnings::default(),
            left_out: LeftOut::of(request, input),
        })
    }

    /// The requested trajectory.
    fn final_trajectory(
        &self,
        request: &SequenceRequest,
        input: &SequenceInput,
    ) -> Result<SequenceTrajectory, Invalid> {
        let (false, Some(mount)) = (request.visual_only, self.odometry.level_mount) else {
            return Ok(SequenceTrajectory::visual(&self.slam));
        };
        let robot = &input.robot;
        let (scan, blind_range) = (robot.scan.clone(), self.map.blind_range());
        let depth = DepthLog { scan, blind_range, by_wheels: true };
        let scans = base_below(&mount).map(|base| ScanMotion {
            map: &self.map,
            depth: &depth,
            base_from_camera: Pose3::from_pose2(base).inverse() * mount,
            noise: &robot.odometry,
            seed: request.seed,
        });
        SequenceTrajectory::fused(&self.slam, &self.odometry.motions, mount, scans.as_ref())
    }

    /// Reason why the run missed its goal or a limit, with the likely cause; `None` if it did not.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        if !self.is_located() {
            let unmatched = match self.slam.mode() {
                Mode::Mapping => "too few features of the images match",
                Mode::Localisation => {
                    "too few features of the images match the map: is it of this place, and are camera and depth_scale those of its images?"
                }
            };
            let cause = self.depth.unusable().unwrap_or_else(|| unmatched.to_owned());
            return Some(format!("no frame after the first was located: {cause}"));
        }
        if self.counts.total() == 1 && self.left_out.asked > 1 && !self.is_interrupted {
            return Some(self.left_out.failure(self.unreadable.first()));
        }
        self.depth.problem().or_else(|| self.trajectory.failure())
    }

    /// Number of images for which the odometry gave the motion since the image before.
    #[must_use]
    pub fn odometry_priors(&self) -> usize {
        self.odometry.motions.iter().flatten().count()
    }

    /// Wall-clock time of the whole, and of the stages.
    #[must_use]
    pub fn clock_tables(&self) -> [Vec<Vec<String>>; 2] {
        let whole = vec!["wall clock".to_owned(), format!("{:.1} s", self.seconds)];
        [vec![whole], stage_rows(&self.times)]
    }

    /// Whether any frame after the first, which defines the frame, was located by its features.
    fn is_located(&self) -> bool {
        self.counts.ok + self.counts.weak > 0 && self.slam.landmarks().next().is_some()
    }

    /// Notes why a frame cannot be read.
    fn skip(&mut self, error: &FrameError) {
        self.unreadable.push(error.to_string());
        self.frame_problems.add(&error.source.problem(), &error.source.path().display().to_string());
    }

    /// Logs each setting that is newly suspected.
    fn warn_of_calibration(&mut self, progress: &dyn StepProgress) {
        let issues = self.slam.calibration_issues();
        for issue in &issues[self.logged_issues..] {
            progress.pause(&|| tracing::warn!("{issue}"));
        }
        self.logged_issues = issues.len();
    }

    fn step(&mut self, image: RgbdImage, odometry: &OdometryPrior<'_>) -> TrackReport {
        self.depth.count(image.depth());
        self.stamps = Some((self.stamps.map_or(image.stamp(), |(first, _)| first), image.stamp()));
        let since = self.last_image.as_ref().map(RgbdImage::stamp);
        let prior = since.and_then(|since| odometry.motion(since, image.stamp()));
        let report = self.times.measure(Stage::Slam, || self.slam.step(&image, prior));
        self.counts.count(report.tracking);
        self.odometry.motions.push(prior);
        // A camera on a robot is level by its mount, whatever the images show.
        let located = report.tracking.is_located().then_some(report.visual_from_camera);
        if let Some(level_from_camera) = self.odometry.level_mount.or(located) {
            let map = &mut self.map;
            self.times.measure(Stage::Scan, || map.note(&image, level_from_camera));
        }
        self.last_image = Some(image);
        report
    }
}
