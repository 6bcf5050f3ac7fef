//! Request to track a sequence: camera, first pose, map, seed.

use super::first_camera::{DEFAULT_CAMERA_HEIGHT_M, FirstCamera};
use super::floor_log::log_choice;
use super::floor_mount::floor_evidence;
use super::readout::find_readout;
use crate::sequence_input::{SequenceInput, SequenceOptions};
use crate::vocabulary_file::vocabulary_or_builtin;
use crate::{AppError, RecordingContent};
use std::path::PathBuf;
use trundle_core::{Invalid, Pose3};
use trundle_io::{Expected, MapImage, RosSequenceOptions};
use trundle_runtime::{CameraMount, RobotConfig, level_from_first_camera};
use trundle_slam::{Mode, RgbdSlam};

/// A recorded sequence and how to track it.
#[derive(Debug, Clone)]
pub struct SequenceRequest {
    /// A TUM RGB-D folder, a ROS bag or a recording of a run.
    pub path: PathBuf,
    /// The topics of a bag.
    pub topics: RosSequenceOptions,
    /// A camera preset or a file of one; `None` for the input's own.
    pub camera: Option<String>,
    /// Depth units per metre; `None` for the camera's own.
    pub depth_scale: Option<f64>,
    /// Frames to track; `None` for all.
    pub frames: Option<usize>,
    /// Whether a recording may be cut: it is tracked up to the cut.
    pub recover: bool,
    /// Pose of the first camera above the floor.
    pub first_camera: FirstCamera,
    /// The visual map of an earlier run, in which the camera is localized first.
    pub map: Option<PathBuf>,
    /// Whether that map is fixed.
    pub localize_only: bool,
    /// The vocabulary by which places are recognised; `None` for the built-in one.
    pub vocabulary: Option<PathBuf>,
    /// Seed of the random sampling.
    pub seed: u64,
    /// Format of the picture of the map that is written.
    pub map_image: MapImage,
    /// Content of `recording.mcap`; `Events` is tracking without images.
    pub record: RecordingContent,
    /// Settings of tracking, odometry, mount, scans and map; `None` for the input's own, else the default ones.
    pub robot: Option<Box<RobotConfig>>,
    /// Whether only the frames of the last visual map are written; else all frames that odometry places as well, if there is odometry.
    pub visual_only: bool,
}

impl SequenceRequest {
    /// A request for all frames of `options`, with the settings of `robot` if given, from an empty map.
    #[must_use]
    pub fn of_options(options: &SequenceOptions<'_>, robot: Option<RobotConfig>) -> Self {
        Self {
            path: options.path.to_owned(),
            topics: options.topics.clone(),
            camera: options.camera.map(str::to_owned),
            depth_scale: options.depth_scale,
            frames: None,
            recover: options.recover,
            first_camera: FirstCamera::default(),
            map: None,
            localize_only: false,
            vocabulary: None,
            seed: 1,
            map_image: MapImage::Pgm,
            record: RecordingContent::All,
            robot: robot.map(Box::new),
            visual_only: false,
        }
    }

    /// The images. Warnings are logged.
    ///
    /// # Errors
    /// When they cannot be read, or there is no such camera.
    pub fn open(&self) -> Result<SequenceInput, AppError> {
        let mut input = SequenceInput::open(&SequenceOptions {
            path: &self.path,
            camera: self.camera.as_deref(),
            depth_scale: self.depth_scale,
            recover: self.recover,
            topics: self.topics.clone(),
        })?;
        if let Some(robot) = &self.robot {
            // The input's mount, unless the robot file has one.
            let mut own = RobotConfig::clone(robot);
            own.mount = self.given_mount().unwrap_or(input.robot.mount);
            own.camera = input.camera.model.camera;
            input.set_robot(own)?;
        }
        if input.is_empty() {
            return Ok(input);
        }
        find_readout(&mut input, self.frames)?;
        if self.map.is_some() {
            if self.first_camera.is_asked() {
                take_mount(&mut input, &self.first_camera.mount());
            }
        } else if self.first_camera.is_asked() || self.known_first_camera(&input)?.is_none() {
            self.find_floor(&mut input)?;
        } else if let Some(mount) = self.given_mount() {
            check_robot_file(&input, &mount)?;
        }
        Ok(input)
    }

    /// Takes the first camera's height, tilt and roll as given, and from the floor in the images where they are not given or wrong.
    fn find_floor(&self, input: &mut SequenceInput) -> Result<(), AppError> {
        let given = &self.first_camera;
        given.mount().validated()?;
        let evidence = floor_evidence(input, given.search_start())?;
        let choice = given.completed_by(&evidence);
        log_choice(input, given, &choice, &evidence);
        let is_default = !given.is_asked() && evidence.found.is_none();
        if !is_default {
            take_mount(input, &choice.mount);
        }
        input.floor_mount = choice.is_by_floor.then_some(choice.mount);
        Ok(())
    }

    /// The mount of the robot file, if it has one that is not the default robot's.
    fn given_mount(&self) -> Option<CameraMount> {
        self.robot.as_ref().map(|robot| robot.mount).filter(|mount| *mount != CameraMount::default())
    }

    /// The pose of the first camera above the floor by the request, the robot file, or the input; `None` if none of them has it.
    fn known_first_camera(&self, input: &SequenceInput) -> Result<Option<Pose3>, Invalid> {
        if self.first_camera.is_asked() {
            let mount = input.floor_mount.unwrap_or_else(|| self.first_camera.mount());
            return level_from_first_camera(mount.z, mount.pitch_deg, mount.roll_deg).map(Some);
        }
        let by_file = self.given_mount().map(|mount| mount.base_from_camera());
        Ok(by_file.or_else(|| input.level_from_first_camera()))
    }

    /// The pose of the first camera above the floor: the known one, else the default robot's if there is a robot file, else a level
    /// camera's.
    pub(super) fn level_from_first_camera(&self, input: &SequenceInput) -> Result<Pose3, Invalid> {
        match (self.known_first_camera(input)?, &self.robot) {
            (Some(known), _) => Ok(known),
            (None, Some(robot)) => Ok(robot.mount.base_from_camera()),
            (None, None) => level_from_first_camera(DEFAULT_CAMERA_HEIGHT_M, 0.0, 0.0),
        }
    }

    /// A tracker with an empty map, or with the requested one.
    pub(super) fn slam(&self, input: &SequenceInput) -> Result<RgbdSlam, AppError> {
        // The error of a recording is taken over all of its frames.
        let mut config = input.robot.slam.clone();
        config.seed = self.seed;
        config.kept_frames = usize::MAX;
        let camera = input.camera.model.camera;
        let vocabulary = vocabulary_or_builtin(self.vocabulary.as_deref())?;
        let Some(file) = &self.map else {
            let level_from_camera = self.level_from_first_camera(input)?;
            let slam = RgbdSlam::new(camera, config)?.with_vocabulary(&vocabulary);
            return Ok(slam.starting_at(level_from_camera));
        };
        let refused =
            |problem: &dyn std::fmt::Display| AppError::Input(format!("{}: {problem}", file.display()));
        Expected::VisualMap.check(file)?;
        let bytes = std::fs::read(file).map_err(|error| refused(&error))?;
        let mut slam = RgbdSlam::load(&bytes, camera, config).map_err(|error| refused(&error))?;
        slam.set_vocabulary(&vocabulary);
        slam.set_mode(if self.localize_only { Mode::Localisation } else { Mode::Mapping });
        Ok(slam)
    }
}

/// Takes height, tilt and roll of the camera.
fn take_mount(input: &mut SequenceInput, found: &CameraMount) {
    let mount = &mut input.robot.mount;
    (mount.z, mount.pitch_deg, mount.roll_deg) = (found.z, found.pitch_deg, found.roll_deg);
}

/// Warns of a robot file whose mount contradicts the floor in the images; the robot file's is used.
fn check_robot_file(input: &SequenceInput, mount: &CameraMount) -> Result<(), AppError> {
    let given = FirstCamera::of_mount(mount);
    let evidence = floor_evidence(input, given.search_start())?;
    if let Some(found) = evidence.found.filter(|_| evidence.is_under_wheels)
        && let Some(contradiction) = given.contradiction(&found, evidence.searched, false)
    {
        tracing::warn!("{}: mount of the robot file: {contradiction}", input.path.display());
    }
    Ok(())
}
