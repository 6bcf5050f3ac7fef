use crate::slam_recorder::SlamRecorder;
use crate::{Outcome, args::SlamArgs, console, slam_output};
use indicatif::ProgressBar;
use std::time::Instant;
use trundle::app::AppError;
use trundle::core::{CameraMotion, Pose2, Pose3, RgbdImage, Stamp};
use trundle::io::{CameraModel, EncodedRgbd, FrameError, IoError, OutputFolder, TumSequence};
use trundle::localization::OdometryConfig;
use trundle::runtime::{LevelMap, RobotConfig, Stage, StageTimes, level_from_first_camera};
use trundle::slam::{Mode, RgbdSlam, SlamConfig, TrackReport};

/// What tracking a sequence left.
pub struct SlamRun {
    /// The tracker with its map.
    pub slam: RgbdSlam,
    /// The floor map's scans.
    pub map: LevelMap,
    /// What tracking said of the frames.
    pub counts: trundle::app::TrackCounts,
    /// The last frame that could be read.
    pub last_image: Option<RgbdImage>,
    /// How many calibration issues were printed.
    warned: usize,
    /// Frames that could not be read, in words.
    pub unreadable: Vec<String>,
    /// What was wrong with them, each told once.
    problems: Vec<String>,
    /// Images between which and the one before the odometry told of the motion.
    pub told: usize,
    /// Wall-clock time of the stages.
    pub times: StageTimes,
    /// Wall-clock time of the whole, s.
    pub seconds: f64,
}

/// `trundle slam DIR`.
pub fn run(args: &SlamArgs) -> Result<Outcome, AppError> {
    let camera = CameraModel::named(&args.camera())?;
    let scale = args.depth_scale.unwrap_or(camera.depth_scale);
    let sequence = TumSequence::open(&args.dir, scale, TumSequence::MAX_DIFFERENCE)?
        .with_size(camera.camera.width(), camera.camera.height());
    let folder = OutputFolder::create(&args.out)?;
    let run = track(args, &camera, &sequence, &folder)?;
    slam_output::write(args, &sequence, &run, folder)
}

fn track(
    args: &SlamArgs,
    camera: &CameraModel,
    sequence: &TumSequence,
    folder: &OutputFolder,
) -> Result<SlamRun, AppError> {
    let robot = RobotConfig::default();
    let mut run = SlamRun {
        slam: begin(args, camera)?,
        map: LevelMap::new(camera.camera, robot.scan, robot.schedule.map_hz)?,
        counts: Default::default(),
        last_image: None,
        warned: 0,
        unreadable: Vec::new(),
        problems: Vec::new(),
        told: 0,
        times: StageTimes::default(),
        seconds: 0.0,
    };
    let mut recorder = SlamRecorder::new(folder.recorder("recording.mcap")?);
    let odometry = OdometryPrior::new(sequence);
    let frames = args.frames.map_or(sequence.len(), |frames| sequence.len().min(frames as usize));
    let bar = console::bar(args.common.quiet, frames);
    let start = Instant::now();
    for i in 0..frames {
        match sequence.load(i) {
            Ok(image) => {
                let encoded = encoded(&image)?;
                let report = run.step(image, &odometry);
                recorder.note(encoded, &report, &run.slam)?;
                run.warn_of_settings(&bar);
            }
            Err(error) => run.skip(&bar, &error),
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    run.slam.finish_refining();
    recorder.finish(&run.slam)?;
    if let (None, Some(first)) = (&run.last_image, run.unreadable.first()) {
        let (dir, camera) = (args.dir.display(), args.camera());
        let problem = format!("{dir}: no frame can be read as one of camera {camera} (--camera); {first}");
        return Err(AppError::Input(problem));
    }
    if sequence.odometry().is_some() && run.told == 0 && frames > 1 {
        console::warn("odometry.txt tells of no motion between images: is it empty, or of another clock?");
    }
    run.seconds = start.elapsed().as_secs_f64();
    Ok(run)
}

/// An empty map, or the one that was asked for.
fn begin(args: &SlamArgs, model: &CameraModel) -> Result<RgbdSlam, AppError> {
    // A recording is judged whole.
    let config = SlamConfig { seed: args.seed, kept_frames: usize::MAX, ..SlamConfig::default() };
    let camera = model.camera;
    let Some(file) = &args.map else {
        let level_from_camera = level_from_first_camera(args.height, args.tilt, args.roll)?;
        return Ok(RgbdSlam::new(camera, config)?.starting_at(level_from_camera));
    };
    let refused = |problem: &dyn std::fmt::Display| AppError::Input(format!("{}: {problem}", file.display()));
    let bytes = std::fs::read(file).map_err(|error| refused(&error))?;
    let mut slam = RgbdSlam::load(&bytes, camera, config).map_err(|error| refused(&error))?;
    slam.set_mode(if args.localise { Mode::Localisation } else { Mode::Mapping });
    Ok(slam)
}

fn encoded(image: &RgbdImage) -> Result<EncodedRgbd, AppError> {
    EncodedRgbd::encode(image).map_err(|error| AppError::Input(error.to_string()))
}

impl SlamRun {
    /// Whether any frame but the first, which only lays the frame, was located by sight.
    pub fn is_located(&self) -> bool {
        self.counts.ok + self.counts.weak > 0 && self.slam.landmarks().next().is_some()
    }

    /// Says of a frame that cannot be read why; of many whose files say the same, an image of another size, once.
    fn skip(&mut self, bar: &ProgressBar, error: &FrameError) {
        self.unreadable.push(error.to_string());
        let problem = match &error.source {
            IoError::Field { problem, .. } => problem.to_string(),
            _ => error.to_string(),
        };
        if !self.problems.contains(&problem) {
            bar.suspend(|| console::warn(&format!("{error}; skipped, and others like it")));
            self.problems.push(problem);
        }
    }

    /// Says of each setting that is newly suspected why.
    fn warn_of_settings(&mut self, bar: &ProgressBar) {
        for issue in &self.slam.calibration_issues()[self.warned..] {
            bar.suspend(|| console::warn(&issue.to_string()));
        }
        self.warned = self.slam.calibration_issues().len();
    }

    fn step(&mut self, image: RgbdImage, odometry: &OdometryPrior) -> TrackReport {
        let since = self.last_image.as_ref().map(RgbdImage::stamp);
        let prior = since.and_then(|since| odometry.motion(since, image.stamp()));
        self.told += usize::from(prior.is_some());
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

/// The camera's motion by the sequence's odometry, where it has one.
struct OdometryPrior<'a> {
    poses: &'a [(Stamp, Pose2)],
    base_from_camera: Pose3,
    noise: OdometryConfig,
}

impl<'a> OdometryPrior<'a> {
    fn new(sequence: &'a TumSequence) -> Self {
        let robot = RobotConfig::default();
        let base_from_camera = robot.mount.base_from_camera();
        Self { poses: sequence.odometry().unwrap_or(&[]), base_from_camera, noise: robot.odometry }
    }

    /// `earlier_camera_from_later_camera`; `None` where the odometry does not tell it: in its holes, and where it jumps.
    fn motion(&self, earlier: Stamp, later: Stamp) -> Option<CameraMotion> {
        let base_motion = self.at(earlier)?.inverse() * self.at(later)?;
        let farthest = self.noise.max_speed * (later - earlier);
        if base_motion.x.hypot(base_motion.y) > farthest {
            return None;
        }
        let noise = self.noise.by_wheels(&base_motion);
        Some(CameraMotion::of_base((base_motion, noise), self.base_from_camera))
    }

    fn at(&self, stamp: Stamp) -> Option<Pose2> {
        let after = self.poses.partition_point(|(at, _)| *at <= stamp);
        let (t0, a) = self.poses.get(after.checked_sub(1)?)?;
        let (t1, b) = self.poses.get(after).filter(|(t1, _)| *t1 - *t0 <= self.noise.max_gap)?;
        Some(a.interpolate(b, (stamp - *t0) / (*t1 - *t0)))
    }
}
