//! The RGB-D sequence of a bag, or the sensors of a robot: topics, camera, mount, poses, gyro, scans; the images remain on disk.

use super::chosen_images::ChosenImages;
use super::frames::RosFrames;
use super::options::RosSequenceOptions;
use super::sensors::{Sensors, without_images};
use super::sequence_topics::RosImageTopics;
use super::survey::Survey;
use crate::ros::frames::NoTransform;
use crate::ros::robot_sensors::{RosScans, bases};
use crate::{IoError, Warnings};
use std::path::{Path, PathBuf};
use trundle_core::{GyroRate, PinholeCamera, Pose2, Pose3, Scan, Stamp};

/// An RGB-D sequence of a ROS bag, or the sensors of a robot, whose bag may have a laser instead of images.
pub struct RosSequence {
    path: PathBuf,
    topics: RosImageTopics,
    camera: Option<PinholeCamera>,
    base_from_camera: Option<Pose3>,
    /// Stamps of colour and depth.
    pairs: Vec<(Stamp, Stamp)>,
    listed: usize,
    odometry: Vec<(Stamp, Pose2)>,
    gyro: Vec<GyroRate>,
    scans: RosScans,
    ground_truth: Vec<(Stamp, Pose3)>,
    warnings: Warnings,
}

impl RosSequence {
    /// Reads a bag without its pixels: topics, camera, mount, odometry, gyro, scans, ground truth. `needs_camera`: whether the bag must
    /// contain the camera's intrinsics.
    ///
    /// # Errors
    /// When the bag cannot be read, colour or depth is missing or ambiguous, depth is not registered to colour, no image can be paired, or
    /// the camera is missing or invalid. For a robot with a laser, images without a requested topic may be missing.
    pub fn open(path: &Path, options: &RosSequenceOptions, needs_camera: bool) -> Result<Self, IoError> {
        let survey = Survey::read(path, options.is_for_robot)?;
        Self::of(path, survey, options, needs_camera).map_err(|problem| IoError::malformed(path, problem))
    }

    fn of(
        path: &Path,
        mut survey: Survey,
        options: &RosSequenceOptions,
        needs_camera: bool,
    ) -> Result<Self, String> {
        let images = ChosenImages::of(&mut survey, options, needs_camera);
        if let (Err(problem), false) = (&images, options.is_for_robot && !options.names_images()) {
            return Err(problem.clone());
        }
        let (odometry_topic, base, odometry) = motion(&mut survey, options.odometry_topic.as_deref())?;
        let sensors = Sensors::of(&mut survey, options, (base.as_deref(), &odometry))?;
        let images = match images {
            Ok(images) => Some(images),
            Err(problem) => {
                without_images(&mut survey, problem, &sensors)?;
                None
            }
        };
        let camera_frame = images.as_ref().map(|images| images.color.frame.clone());
        let base_from_camera = camera_frame.as_ref().and_then(|frame| mount(&mut survey, &base, frame));
        let ground_truth =
            ground_truth(&mut survey, base.as_deref(), camera_frame.as_deref(), base_from_camera);
        let topics = RosImageTopics {
            odometry: odometry_topic,
            imu: sensors.imu_topic,
            scans: sensors.scan_topic,
            ..RosImageTopics::of(images.as_ref(), &survey)
        };
        let (camera, pairs, listed) =
            images.map_or_else(Default::default, |images| (images.camera, images.pairs, images.listed));
        Ok(Self {
            path: path.to_owned(),
            topics,
            camera,
            base_from_camera,
            pairs,
            listed,
            odometry,
            gyro: sensors.gyro,
            scans: sensors.scans,
            ground_truth,
            warnings: survey.warnings,
        })
    }

    /// The topics of the sequence.
    #[must_use]
    pub fn topics(&self) -> &RosImageTopics {
        &self.topics
    }

    /// The camera of the bag; `None` if none was needed, or without images.
    #[must_use]
    pub fn camera(&self) -> Option<PinholeCamera> {
        self.camera
    }

    /// The camera's pose on the base by the bag's transforms, optical frame; `None` if the transforms do not connect both.
    #[must_use]
    pub fn base_from_camera(&self) -> Option<Pose3> {
        self.base_from_camera
    }

    /// Number of colour images with a depth image at most 20 ms away.
    #[must_use]
    pub fn len(&self) -> usize {
        self.pairs.len()
    }

    /// Whether the sequence has no image: the bag of a robot with a laser.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty()
    }

    /// Number of colour images, those without depth among them.
    #[must_use]
    pub fn listed(&self) -> usize {
        self.listed
    }

    /// Number of colour images without a depth image near enough in time.
    #[must_use]
    pub fn unpaired(&self) -> usize {
        self.listed - self.pairs.len()
    }

    /// `odom_from_base`; `None` if the bag holds none.
    #[must_use]
    pub fn odometry(&self) -> Option<&[(Stamp, Pose2)]> {
        (!self.odometry.is_empty()).then_some(&self.odometry)
    }

    /// The turn rates of the gyro around the base's vertical, by rising stamps; empty without a usable one.
    #[must_use]
    pub fn gyro(&self) -> &[GyroRate] {
        &self.gyro
    }

    /// Times of the first and of the last beam of each scan of the laser, by rising stamps; empty if the bag was not opened for a robot.
    pub fn scan_times(&self) -> impl Iterator<Item = (Stamp, Stamp)> + '_ {
        self.scans.times()
    }

    /// A scan of the laser, base frame; `None` beyond the last.
    #[must_use]
    pub fn scan(&self, index: usize) -> Option<Scan> {
        self.scans.get(index)
    }

    /// `world_from_camera`, without images `world_from_base`, of a topic of odometry or transforms whose name holds `ground_truth`; `None`
    /// without one.
    #[must_use]
    pub fn ground_truth(&self) -> Option<&[(Stamp, Pose3)]> {
        (!self.ground_truth.is_empty()).then_some(&self.ground_truth)
    }

    /// Omissions on opening, one warning a kind.
    #[must_use]
    pub fn warnings(&self) -> &Warnings {
        &self.warnings
    }

    /// The images in the order of their stamps, not decoded. `depth_scale`: units per metre of depth in whole numbers.
    ///
    /// # Errors
    /// When the bag cannot be opened again.
    pub fn frames(&self, depth_scale: f64) -> Result<RosFrames<'_>, IoError> {
        RosFrames::open(&self.path, &self.topics, &self.pairs, depth_scale)
    }
}

/// The odometry's topic, the base's frame, and its poses; empty without odometry.
type BaseMotion = (String, Option<String>, Vec<(Stamp, Pose2)>);

/// The motion of the base by the requested topic, or by the bag's choice.
fn motion(survey: &mut Survey, asked: Option<&str>) -> Result<BaseMotion, String> {
    if asked.is_none() && !survey.contents.has_motion() {
        return Ok((String::new(), None, Vec::new()));
    }
    let motion = survey.contents.motion(asked)?;
    for skip in std::mem::take(&mut survey.contents.skipped) {
        survey.warnings.add("a pose of the odometry is left out", &skip.problem);
    }
    Ok((motion.topic, Some(motion.base), motion.motion.into_poses()))
}

/// Pose of the camera above the floor below the base.
fn mount(survey: &mut Survey, base: &Option<String>, camera: &str) -> Option<Pose3> {
    let mut broken = None;
    for base in bases(base.as_deref()) {
        match survey.contents.transform(base, camera) {
            Ok(pose) if base != camera => return Some(pose),
            Err(NoTransform::Broken(problem)) => broken = Some(problem),
            Ok(_) | Err(NoTransform::Unconnected) => {}
        }
    }
    if let Some(problem) = broken {
        survey.warnings.add("the mount of the camera is not known", &problem);
    }
    None
}

/// `world_from_camera` by rising stamps, of the poses of the camera or of the base; `world_from_base` without a camera.
fn ground_truth(
    survey: &mut Survey,
    base: Option<&str>,
    camera: Option<&str>,
    base_from_camera: Option<Pose3>,
) -> Vec<(Stamp, Pose3)> {
    let mut poses = Vec::new();
    for (stamp, child, pose) in std::mem::take(&mut survey.truth) {
        match (camera, base_from_camera) {
            (Some(camera), _) if child == camera => poses.push((stamp, pose)),
            (Some(_), Some(base_from_camera)) => poses.push((stamp, pose * base_from_camera)),
            (None, _) if bases(base).any(|base| base == child) => poses.push((stamp, pose)),
            _ => {
                let goal = if camera.is_some() { "camera" } else { "base" };
                let problem =
                    format!("ground truth is left out: no transform leads from its frame to the {goal}");
                survey.warnings.add(&problem, &child);
            }
        }
    }
    poses.sort_by_key(|(stamp, _)| *stamp);
    poses.dedup_by_key(|(stamp, _)| *stamp);
    poses
}
