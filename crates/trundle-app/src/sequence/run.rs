//! Tracking of a sequence, frame by frame.

use super::odometry_prior::OdometryPrior;
use super::recorder::SequenceRecorder;
use super::request::SequenceRequest;
use crate::{AppError, StepProgress, TrackCounts};
use std::time::Instant;
use trundle_core::RgbdImage;
use trundle_io::{CameraModel, EncodedRgbd, FrameError, IoError, OutputFolder, TumSequence};
use trundle_runtime::{LevelMap, RobotConfig, Stage, StageTimes};
use trundle_slam::{RgbdSlam, TrackReport};

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
    /// Frames that could not be read, in words.
    pub unreadable: Vec<String>,
    /// Images for which the odometry gave the motion since the image before.
    pub odometry_priors: usize,
    /// Wall-clock time of the stages.
    pub times: StageTimes,
    /// Wall-clock time of the whole, s.
    pub seconds: f64,
    warnings: Warnings,
}

/// Warnings that were logged.
#[derive(Default)]
struct Warnings {
    /// Calibration issues.
    calibration_issues: usize,
    /// Reasons for which frames could not be read, each once.
    frame_problems: Vec<String>,
}

/// Tracks a sequence and records every frame into `recording.mcap` of `folder`.
///
/// # Errors
/// When a setting cannot be accepted, no frame can be read, or the recording cannot be written.
pub fn track_sequence(
    request: &SequenceRequest,
    camera: &CameraModel,
    sequence: &TumSequence,
    folder: &OutputFolder,
    progress: &dyn StepProgress,
) -> Result<SequenceRun, AppError> {
    let mut run = SequenceRun::new(request, camera)?;
    let mut recorder = SequenceRecorder::new(folder.recorder("recording.mcap")?);
    let odometry = OdometryPrior::new(sequence);
    let frames = request.frames.map_or(sequence.len(), |frames| sequence.len().min(frames));
    progress.begin(Some(frames));
    let start = Instant::now();
    for i in 0..frames {
        match sequence.load(i) {
            Ok(image) => {
                let encoded = EncodedRgbd::encode(&image).map_err(AppError::input)?;
                let report = run.step(image, &odometry);
                recorder.record(encoded, &report, &run.slam)?;
                run.warn_of_calibration(progress);
            }
            Err(error) => run.skip(progress, &error),
        }
        progress.advance();
    }
    progress.end();
    run.slam.finish_refining();
    recorder.finish(&run.slam)?;
    if let (None, Some(first)) = (&run.last_image, run.unreadable.first()) {
        let (dir, camera) = (request.dir.display(), &request.camera);
        let problem = format!("{dir}: no frame can be read as one of camera {camera} (--camera); {first}");
        return Err(AppError::Input(problem));
    }
    if sequence.odometry().is_some() && run.odometry_priors == 0 && frames > 1 {
        tracing::warn!("odometry.txt holds no motion between images: is it empty, or of another clock?");
    }
    run.seconds = start.elapsed().as_secs_f64();
    Ok(run)
}

impl SequenceRun {
    fn new(request: &SequenceRequest, camera: &CameraModel) -> Result<Self, AppError> {
        let robot = RobotConfig::default();
        Ok(Self {
            slam: request.slam(camera)?,
            map: LevelMap::new(camera.camera, robot.scan, robot.schedule.map_hz)?,
            counts: TrackCounts::default(),
            last_image: None,
            unreadable: Vec::new(),
            odometry_priors: 0,
            times: StageTimes::default(),
            seconds: 0.0,
            warnings: Warnings::default(),
        })
    }

    /// Whether any frame after the first, which defines the frame, was located by its features.
    #[must_use]
    pub fn is_located(&self) -> bool {
        self.counts.ok + self.counts.weak > 0 && self.slam.landmarks().next().is_some()
    }

    /// Logs why a frame cannot be read; of frames with the same reason only the first.
    fn skip(&mut self, progress: &dyn StepProgress, error: &FrameError) {
        self.unreadable.push(error.to_string());
        let problem = match &error.source {
            IoError::Field { problem, .. } => problem.to_string(),
            _ => error.to_string(),
        };
        let problems = &mut self.warnings.frame_problems;
        if !problems.contains(&problem) {
            progress.pause(&|| tracing::warn!("{error}; skipped, and others like it"));
            problems.push(problem);
        }
    }

    /// Logs each setting that is newly suspected.
    fn warn_of_calibration(&mut self, progress: &dyn StepProgress) {
        let issues = self.slam.calibration_issues();
        for issue in &issues[self.warnings.calibration_issues..] {
            progress.pause(&|| tracing::warn!("{issue}"));
        }
        self.warnings.calibration_issues = issues.len();
    }

    fn step(&mut self, image: RgbdImage, odometry: &OdometryPrior<'_>) -> TrackReport {
        let since = self.last_image.as_ref().map(RgbdImage::stamp);
        let prior = since.and_then(|since| odometry.motion(since, image.stamp()));
        self.odometry_priors += usize::from(prior.is_some());
        let report = self.times.measure(Stage::Slam, || self.slam.step(&image, prior));
        self.counts.count(report.tracking);
        if report.tracking.is_located() {
            let map = &mut self.map;
            self.times.measure(Stage::Scan, || map.note(&image, report.visual_from_camera));
        }
        self.last_image = Some(image);
        report
    }
}
