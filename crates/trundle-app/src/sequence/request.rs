//! Request to track a sequence: camera, first pose, map, seed.

use super::floor_mount::{FoundFloor, found_floor};
use crate::sequence_input::{SequenceInput, SequenceOptions};
use crate::vocabulary_file::vocabulary_or_builtin;
use crate::{AppError, RecordingContent};
use std::path::PathBuf;
use trundle_core::{Invalid, Pose3};
use trundle_io::{Expected, MapImage, RosSequenceOptions};
use trundle_runtime::{CameraMount, RobotConfig, level_from_first_camera};
use trundle_slam::{Mode, RgbdSlam, SlamConfig};

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

/// Pose of the first camera above the floor; `None` everywhere for the input's own.
#[derive(Debug, Clone, Copy, Default)]
pub struct FirstCamera {
    /// Height above the floor, m; default that of the floor in the images, else 1 m.
    pub height: Option<f64>,
    /// Downward tilt, deg; default as the height, else 0.
    pub tilt_deg: Option<f64>,
    /// Roll to its right, deg; default as the height, else 0.
    pub roll_deg: Option<f64>,
}

impl FirstCamera {
    /// Whether a part of the pose is requested; the whole pose is then set.
    fn is_asked(&self) -> bool {
        self.height.or(self.tilt_deg).or(self.roll_deg).is_some()
    }

    /// Requested height (m), tilt and roll (deg).
    fn asked(&self) -> (f64, f64, f64) {
        let height = self.height.unwrap_or(DEFAULT_CAMERA_HEIGHT_M);
        (height, self.tilt_deg.unwrap_or_default(), self.roll_deg.unwrap_or_default())
    }
}

/// Default height of a first camera \[m\]. Source: ours, a hand-held camera.
const DEFAULT_CAMERA_HEIGHT_M: f64 = 1.0;

impl SequenceRequest {
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
            input.robot = RobotConfig::clone(robot);
            input.robot.camera = input.camera.model.camera;
        }
        if self.first_camera.is_asked() {
            let mount = &mut input.robot.mount;
            (mount.z, mount.pitch_deg, mount.roll_deg) = self.first_camera.asked();
        } else if self.map.is_none() && self.known_first_camera(&input)?.is_none() {
            self.find_floor(&mut input)?;
        }
        Ok(input)
    }

    /// Takes the first camera's height, tilt and roll from the floor in the images.
    fn find_floor(&self, input: &mut SequenceInput) -> Result<(), AppError> {
        let path = self.path.display();
        let (found, searched) = found_floor(input)?;
        let Some(FoundFloor { mount: found, images: seen }) = found else {
            if searched == 0 {
                return Ok(());
            }
            tracing::warn!(
                "{path}: the first images show no floor, so the height of the first camera is taken as {DEFAULT_CAMERA_HEIGHT_M} m and its \
                 tilt as 0 deg: give --height (m), --tilt and --roll (deg) for a level map"
            );
            return Ok(());
        };
        let pose =
            format!("{:.3} m, tilt {:.2} deg, roll {:.2} deg", found.z, found.pitch_deg, found.roll_deg);
        if input.odometry().is_some() {
            tracing::info!("{path}: first camera at {pose}, by the floor in {seen} of {searched} images");
        } else {
            tracing::warn!(
                "{path}: first camera at {pose}, by the lowest plane in the first {searched} images: give --height (m), --tilt and --roll \
                 (deg) if this plane is a table"
            );
        }
        let mount = &mut input.robot.mount;
        (mount.z, mount.pitch_deg, mount.roll_deg) = (found.z, found.pitch_deg, found.roll_deg);
        input.floor_mount = Some(found);
        Ok(())
    }

    /// The mount of the robot file, if it has one that is not the default robot's.
    fn given_mount(&self) -> Option<CameraMount> {
        self.robot.as_ref().map(|robot| robot.mount).filter(|mount| *mount != CameraMount::default())
    }

    /// The pose of the first camera above the floor by the request, the robot file, or the input; `None` if none of them has it.
    fn known_first_camera(&self, input: &SequenceInput) -> Result<Option<Pose3>, Invalid> {
        if self.first_camera.is_asked() {
            let (height, tilt_deg, roll_deg) = self.first_camera.asked();
            return level_from_first_camera(height, tilt_deg, roll_deg).map(Some);
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
        let config = SlamConfig { seed: self.seed, kept_frames: usize::MAX, ..input.robot.slam.clone() };
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
