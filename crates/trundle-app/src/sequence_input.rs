//! RGB-D images with odometry and truth for `slam` and `map`: a TUM RGB-D folder, a ROS bag, or the recording of a run. For the run of a
//! robot also the gyro and the laser of a bag.

mod frames;
mod gyro_check;
mod idle_options;
mod motion_events;
mod recorded_run;
mod topic_rows;

pub use frames::PendingFrame;
pub use motion_events::motion_events;
pub use recorded_run::RecordedRun;
pub use topic_rows::topic_rows;

use crate::{AppError, log_warnings};
use frames::SequenceFrames;
use gyro_check::gyro_problem;
use motion_events::fused_odometry;
use std::path::{Path, PathBuf};
use trundle_core::{GyroRate, Pose2, Pose3, Scan, Stamp};
use trundle_io::{
    CameraModel, DepthStatistics, FileKind, KINECT_V2_DEPTH_SCALE, LaserLogSources, RosImageTopics,
    RosSequence, RosSequenceOptions, RosTopics, SequenceCamera, TumSequence, Warnings,
};
use trundle_runtime::{CameraMount, RobotConfig};
use trundle_slam::ReadoutEstimate;

/// Input of a sequence.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SequenceOptions<'a> {
    /// A TUM RGB-D folder, a ROS bag or a recording of a run.
    pub path: &'a Path,
    /// A camera preset or a file of one; `None` for the input's own.
    pub camera: Option<&'a str>,
    /// Depth units per metre of a folder's images; `None` for the camera's own.
    pub depth_scale: Option<f64>,
    /// Whether a recording may be cut: it is read up to the cut.
    pub recover: bool,
    /// The topics of a bag.
    pub topics: RosSequenceOptions,
}

impl<'a> SequenceOptions<'a> {
    /// The images of `path` as the input describes them.
    #[must_use]
    pub fn new(path: &'a Path) -> Self {
        Self { path, camera: None, depth_scale: None, recover: false, topics: RosSequenceOptions::default() }
    }

    /// The images of `path` with these topics, by a camera (preset or file, depth units per metre); `None` for the input's own.
    #[must_use]
    pub fn of_camera(
        path: &'a Path,
        (camera, depth_scale): (Option<&'a str>, Option<f64>),
        topics: RosSequenceOptions,
    ) -> Self {
        Self { camera, depth_scale, topics, ..Self::new(path) }
    }

    /// The same input for the run of a robot: with the scans of a bag's laser, which then needs no images.
    #[must_use]
    pub fn for_robot(mut self) -> Self {
        self.topics.is_for_robot = true;
        self
    }
}

/// RGB-D images in the order of their stamps, with the input's other data.
pub struct SequenceInput {
    /// The folder or file.
    pub path: PathBuf,
    /// The camera.
    pub camera: SequenceCamera,
    /// The robot that carries the camera: the robot of a recording, else the default robot.
    pub robot: RobotConfig,
    /// Height, tilt and roll of the first camera by the floor in the images, if they were searched and show it.
    pub floor_mount: Option<CameraMount>,
    /// Readout time of the camera by the images, if it was searched and they show a rolling shutter.
    pub readout_by_images: Option<ReadoutEstimate>,
    source: Source,
}

enum Source {
    Folder(Box<TumSequence>),
    Recording(Box<RecordedRun>),
    Bag(Box<BagSource>),
}

/// A bag, with its odometry by wheels and gyro; empty without a gyro.
struct BagSource {
    sequence: RosSequence,
    fused: Vec<(Stamp, Pose2)>,
}

impl SequenceInput {
    fn new(path: &Path, camera: SequenceCamera, robot: RobotConfig, source: Source) -> Self {
        Self { path: path.to_owned(), camera, robot, floor_mount: None, readout_by_images: None, source }
    }

    /// Whether `path` is read as RGB-D images: a TUM RGB-D folder, a recording of trundle, or a bag with images and without scans of a
    /// laser. With `topics` given, any bag counts as images.
    #[must_use]
    pub fn is_sequence(path: &Path, topics: &RosSequenceOptions) -> bool {
        let names_images = topics.color_topic.is_some() || topics.depth_topic.is_some();
        match FileKind::of(path) {
            Ok(FileKind::SequenceFolder | FileKind::TrundleRecording) => true,
            Ok(kind) if kind.is_bag() => {
                names_images
                    || RosTopics::read(path).is_ok_and(|topics| topics.has_images() && !topics.has_scans())
            }
            _ => false,
        }
    }

    /// Opens a folder, a bag or a recording. Warnings are logged.
    ///
    /// # Errors
    /// When the path is none of these, cannot be read, contains no images, or its camera is unknown.
    pub fn open(options: &SequenceOptions<'_>) -> Result<Self, AppError> {
        let kind = FileKind::of(options.path)?;
        options.refuse_idle(kind)?;
        match kind {
            FileKind::TrundleRecording => {
                Self::of_recording(options, RecordedRun::read(options.path, options.recover)?)
            }
            kind if kind.is_bag() => Self::of_bag(options),
            _ => Self::of_folder(options),
        }
    }

    fn of_bag(options: &SequenceOptions<'_>) -> Result<Self, AppError> {
        let path = options.path;
        options.refuse_unused_scans()?;
        let sequence = RosSequence::open(path, &options.topics, options.camera.is_none());
        let sequence = sequence.map_err(|error| with_laser_hint(error.into(), path))?;
        let mut camera = match sequence.camera() {
            None if sequence.is_empty() => camera_of(&RobotConfig::default(), path),
            Some(camera) => SequenceCamera {
                model: CameraModel { camera, depth_scale: KINECT_V2_DEPTH_SCALE },
                name: sequence.topics().info.clone(),
                is_readout_known: false,
                is_depth_scale_known: true,
                is_assumed: false,
                warnings: Warnings::default(),
            },
            None => SequenceCamera::choose(options.camera, path)?,
        };
        log_warnings(&camera.warnings);
        log_warnings(sequence.warnings());
        // Depth of ROS is in millimetres (REP 118), independent of the unit in folders of the same camera.
        camera.model.depth_scale = options.depth_scale.unwrap_or(KINECT_V2_DEPTH_SCALE);
        tracing::info!("{}", sequence.topics());
        if let Some(problem) = gyro_problem(sequence.odometry().unwrap_or_default(), sequence.gyro()) {
            tracing::warn!("{}: {}: {problem}", path.display(), sequence.topics().imu);
        }
        let mut robot = RobotConfig::default();
        robot.camera = camera.model.camera;
        match sequence.base_from_camera().map(|pose| CameraMount::of_pose(&pose)) {
            Some(Ok(mount)) => robot.mount = mount,
            Some(Err(invalid)) => {
                tracing::warn!("{}: {invalid}; the default robot's mount is taken", path.display())
            }
            None => {}
        }
        let source = BagSource { sequence, fused: Vec::new() };
        let mut input = Self::new(path, camera, RobotConfig::default(), Source::Bag(Box::new(source)));
        input.set_robot(robot)?;
        Ok(input)
    }

    /// Takes the robot that carries the sensors.
    ///
    /// # Errors
    /// When its settings are invalid.
    pub fn set_robot(&mut self, robot: RobotConfig) -> Result<(), AppError> {
        if let Source::Bag(bag) = &mut self.source
            && let (Some(odometry), false) = (bag.sequence.odometry(), bag.sequence.gyro().is_empty())
        {
            bag.fused = fused_odometry(odometry, bag.sequence.gyro(), &robot)?;
        }
        self.robot = robot;
        Ok(())
    }

    fn of_folder(options: &SequenceOptions<'_>) -> Result<Self, AppError> {
        let mut camera = SequenceCamera::choose(options.camera, options.path)?;
        log_warnings(&camera.warnings);
        let CameraModel { camera: lens, depth_scale } = &mut camera.model;
        if let Some(scale) = options.depth_scale {
            (*depth_scale, camera.is_depth_scale_known) = (scale, true);
        }
        let mut sequence = TumSequence::open(options.path, *depth_scale, TumSequence::MAX_DIFFERENCE)?;
        log_warnings(sequence.warnings());
        if !camera.is_depth_scale_known {
            *depth_scale = assumed_depth_scale(&sequence, &camera.name, *depth_scale);
            sequence = sequence.with_depth_scale(*depth_scale);
        }
        let source = Source::Folder(Box::new(sequence.with_size(lens.width(), lens.height())));
        Ok(Self::new(options.path, camera, RobotConfig::default(), source))
    }

    /// The images of a recording that was read before.
    ///
    /// # Errors
    /// As [`SequenceInput::open`].
    pub fn of_recording(options: &SequenceOptions<'_>, run: RecordedRun) -> Result<Self, AppError> {
        let name = options.path.display();
        if options.depth_scale.is_some() {
            let problem = format!("--depth-scale is about a TUM folder; {name} is a recording, in metres");
            return Err(AppError::Input(problem));
        }
        run.require_images()?;
        let camera = match (options.camera, run.robot()) {
            (Some(_), _) => SequenceCamera::choose(options.camera, options.path)?,
            (None, Some(robot)) => camera_of(robot, options.path),
            (None, None) => {
                let problem = format!(
                    "{name}: no robot is named in the recording, so its camera is unknown, expected --camera"
                );
                return Err(AppError::Input(problem));
            }
        };
        log_warnings(&camera.warnings);
        run.warn_of_cut();
        let robot = run.robot().cloned().unwrap_or_default();
        Ok(Self::new(options.path, camera, robot, Source::Recording(Box::new(run))))
    }

    /// Depth units per metre in the images.
    #[must_use]
    pub fn depth_scale(&self) -> f64 {
        self.camera.model.depth_scale
    }

    /// Number of images.
    #[must_use]
    pub fn len(&self) -> usize {
        match &self.source {
            Source::Folder(sequence) => sequence.len(),
            Source::Recording(run) => run.image_count(),
            Source::Bag(bag) => bag.sequence.len(),
        }
    }

    /// Whether the sequence has no image: the bag of a robot with a laser.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Colour images without a depth image near enough in time.
    #[must_use]
    pub fn unpaired(&self) -> usize {
        match &self.source {
            Source::Folder(sequence) => sequence.unpaired(),
            Source::Recording(_) => 0,
            Source::Bag(bag) => bag.sequence.unpaired(),
        }
    }

    /// Number of colour images in the input, including those left out.
    #[must_use]
    pub fn listed(&self) -> usize {
        match &self.source {
            Source::Folder(sequence) => sequence.listed(),
            Source::Recording(run) => run.image_count(),
            Source::Bag(bag) => bag.sequence.listed(),
        }
    }

    /// `world_from_camera`, without images `world_from_base`, for evaluation, if it is known.
    #[must_use]
    pub fn ground_truth(&self) -> Option<&[(Stamp, Pose3)]> {
        match &self.source {
            Source::Folder(sequence) => sequence.ground_truth(),
            Source::Recording(run) => run.ground_truth(),
            Source::Bag(bag) => bag.sequence.ground_truth(),
        }
    }

    /// `odom_from_base`, if it is known; with a gyro the heading is the gyro's.
    #[must_use]
    pub fn odometry(&self) -> Option<&[(Stamp, Pose2)]> {
        match &self.source {
            Source::Bag(bag) if !bag.fused.is_empty() => Some(&bag.fused),
            _ => self.odometry_of_base(),
        }
    }

    /// `odom_from_base` as the base of a bag or a folder computed it, if it is known.
    #[must_use]
    pub fn odometry_of_base(&self) -> Option<&[(Stamp, Pose2)]> {
        match &self.source {
            Source::Folder(sequence) => sequence.odometry(),
            Source::Recording(run) => run.odometry(),
            Source::Bag(bag) => bag.sequence.odometry(),
        }
    }

    /// The turn rates of a bag's gyro around the base's vertical, by rising stamps; empty for other inputs.
    #[must_use]
    pub fn gyro(&self) -> &[GyroRate] {
        match &self.source {
            Source::Bag(bag) => bag.sequence.gyro(),
            _ => &[],
        }
    }

    /// Times of the first and of the last beam of each scan of a bag's laser, by rising stamps; empty for other inputs.
    #[must_use]
    pub fn scan_times(&self) -> Vec<(Stamp, Stamp)> {
        match &self.source {
            Source::Bag(bag) => bag.sequence.scan_times().collect(),
            _ => Vec::new(),
        }
    }

    /// Stamps of the scans of the laser of a bag or a recording.
    #[must_use]
    pub fn scan_stamps(&self) -> Vec<Stamp> {
        match &self.source {
            Source::Folder(_) => Vec::new(),
            Source::Recording(run) => run.scans().iter().map(Scan::stamp).collect(),
            Source::Bag(bag) => bag.sequence.scan_times().map(|(first, _)| first).collect(),
        }
    }

    /// A scan of the laser of a bag or a recording, base frame.
    #[must_use]
    pub fn scan(&self, index: usize) -> Option<Scan> {
        match &self.source {
            Source::Folder(_) => None,
            Source::Recording(run) => run.scans().get(index).cloned(),
            Source::Bag(bag) => bag.sequence.scan(index),
        }
    }

    /// Whether the input is a recording of trundle.
    #[must_use]
    pub fn is_recording(&self) -> bool {
        matches!(self.source, Source::Recording(_))
    }

    /// Names of odometry and ground truth in the input, for messages.
    #[must_use]
    pub fn pose_sources(&self) -> [&'static str; 2] {
        match self.source {
            Source::Folder(_) => ["odometry.txt", "groundtruth.txt"],
            Source::Recording(_) => ["wheels", "truth"],
            Source::Bag(_) => ["odometry", "ground truth"],
        }
    }

    /// Position of the cut in a recording, in one sentence; `None` for a complete recording and for a folder.
    #[must_use]
    pub fn cut_report(&self) -> Option<&str> {
        match &self.source {
            Source::Folder(_) | Source::Bag(_) => None,
            Source::Recording(run) => run.cut_report(),
        }
    }

    /// The topics of a bag: of the depth images that become scans, of the odometry, and those unused. Empty for other inputs.
    #[must_use]
    pub fn laser_sources(&self) -> LaserLogSources {
        let Source::Bag(bag) = &self.source else { return LaserLogSources::default() };
        let RosImageTopics { depth, odometry, left, .. } = bag.sequence.topics().clone();
        LaserLogSources { scans: depth, odometry, left }
    }

    /// Mount of the camera on the robot, the pose of a level first camera: by the input, else by the floor in its images. `None` if neither
    /// is known.
    #[must_use]
    pub fn level_from_first_camera(&self) -> Option<Pose3> {
        let given = match &self.source {
            Source::Folder(_) => None,
            Source::Recording(run) => run.robot().map(|robot| robot.mount.base_from_camera()),
            Source::Bag(bag) => bag.sequence.base_from_camera(),
        };
        given.or_else(|| self.floor_mount.map(|mount| mount.base_from_camera()))
    }

    /// The images in order, not decoded.
    ///
    /// # Errors
    /// When the recording cannot be opened again.
    pub fn frames(&self) -> Result<impl Iterator<Item = Result<PendingFrame<'_>, AppError>>, AppError> {
        match &self.source {
            Source::Folder(sequence) => Ok(SequenceFrames::of_folder(sequence)),
            Source::Recording(run) => {
                let delay = self.robot.image_delay;
                Ok(SequenceFrames::of_recording(&self.path, run.open()?, self.size(), delay))
            }
            Source::Bag(bag) => {
                let frames = bag.sequence.frames(self.depth_scale())?;
                Ok(SequenceFrames::of_bag(&self.path, frames, self.size()))
            }
        }
    }

    /// Width and height of the camera's images, px.
    fn size(&self) -> (usize, usize) {
        let camera = &self.camera.model.camera;
        (camera.width(), camera.height())
    }
}

/// The problem of a bag without images, with the commands that read its laser if it has one.
fn with_laser_hint(problem: AppError, path: &Path) -> AppError {
    let is_of_laser = RosTopics::read(path).is_ok_and(|topics| topics.has_scans() && !topics.has_images());
    let hint = "the bag has scans of a laser, which `trundle map` and `trundle replay` read";
    if is_of_laser { AppError::Input(format!("{problem}; {hint}")) } else { problem }
}

/// The depth scale for a camera file without one: `usual`, or another one in use if the first images are unusable with it. A warning names
/// it.
fn assumed_depth_scale(sequence: &TumSequence, camera: &str, usual: f64) -> f64 {
    let mut statistics = DepthStatistics::default();
    sequence.frames().take(MAX_TRIED_IMAGES).flatten().for_each(|image| statistics.count(image.depth()));
    let by_images = statistics.fitting_scale(usual);
    let (scale, reason) = match by_images {
        Some(scale) => (scale, format!(" by the images: with {usual}, much of their depth is beyond 8 m")),
        None => (usual, String::new()),
    };
    tracing::warn!(
        "{camera}: no depth scale in the camera file: {scale} units per metre are assumed{reason}; --depth-scale N sets another"
    );
    scale
}

/// Number of images by which the depth scale is assumed. Source: ours.
const MAX_TRIED_IMAGES: usize = 5;

/// The camera of a recording's robot.
fn camera_of(robot: &RobotConfig, recording: &Path) -> SequenceCamera {
    SequenceCamera {
        model: CameraModel { camera: robot.camera, depth_scale: KINECT_V2_DEPTH_SCALE },
        name: recording.display().to_string(),
        is_readout_known: true,
        is_depth_scale_known: true,
        is_assumed: false,
        warnings: Warnings::default(),
    }
}
