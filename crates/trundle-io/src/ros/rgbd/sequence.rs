//! The RGB-D sequence of a bag: topics, camera, mount and poses; the images remain on disk.

use super::frames::RosFrames;
use super::survey::Survey;
use super::topic_choice::{ImageTopic, RosImageTopics, base_topic, choose_color, choose_depth};
use crate::laser_log::is_named;
use crate::ros::frames::NoTransform;
use crate::tum::pair_nearest;
use crate::{IoError, TumSequence, Warnings};
use std::path::{Path, PathBuf};
use trundle_core::{PinholeCamera, Pose2, Pose3, Stamp};

/// The requested topics; for `None` the bag's content decides.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct RosSequenceOptions {
    /// Topic of colour images.
    pub color_topic: Option<String>,
    /// Topic of depth images, registered to colour.
    pub depth_topic: Option<String>,
    /// Topic of the camera's intrinsics.
    pub info_topic: Option<String>,
    /// Topic of odometry, or of its transforms.
    pub odometry_topic: Option<String>,
}

/// An RGB-D sequence of a ROS bag.
pub struct RosSequence {
    path: PathBuf,
    topics: RosImageTopics,
    camera: Option<PinholeCamera>,
    base_from_camera: Option<Pose3>,
    /// Stamps of colour and depth.
    pairs: Vec<(Stamp, Stamp)>,
    listed: usize,
    odometry: Vec<(Stamp, Pose2)>,
    ground_truth: Vec<(Stamp, Pose3)>,
    warnings: Warnings,
}

/// Frames on the floor below the base; the first existing one is used. Source: REP 105, REP 120.
const BASE_FRAMES: [&str; 2] = ["base_footprint", "base_link"];
/// Smallest distance of the depth camera from the colour camera at which depth is not registered to colour \[m\]. Source: ours.
const MAX_DEPTH_OFFSET_M: f64 = 1e-3;
/// Smallest turn between both cameras at which depth is not registered to colour \[rad\]. Source: ours.
const MAX_DEPTH_TURN_RAD: f64 = 1e-3;

impl RosSequence {
    /// Reads a bag without its pixels: topics, camera, mount, odometry, ground truth. `needs_camera`: whether the bag must contain the
    /// camera's intrinsics.
    ///
    /// # Errors
    /// When the bag cannot be read, colour or depth is missing or ambiguous, depth is not registered to colour, no image can be paired, or
    /// the camera is missing or invalid.
    pub fn open(path: &Path, options: &RosSequenceOptions, needs_camera: bool) -> Result<Self, IoError> {
        let survey = Survey::read(path)?;
        Self::of(path, survey, options, needs_camera).map_err(|problem| IoError::malformed(path, problem))
    }

    fn of(
        path: &Path,
        mut survey: Survey,
        options: &RosSequenceOptions,
        needs_camera: bool,
    ) -> Result<Self, String> {
        let images = survey.image_topics();
        let color = choose_color(&images, options.color_topic.as_deref())?;
        let depth = choose_depth(&images, options.depth_topic.as_deref(), color)?;
        require_registered(&mut survey, color, depth)?;
        let (info, camera) = match needs_camera {
            true => camera(&survey, color, options.info_topic.as_deref())?,
            false => (String::new(), None),
        };
        let (colors, depths) = (survey.stamps(&color.name), survey.stamps(&depth.name));
        let pairs = pair_nearest(&colors, &depths, TumSequence::MAX_DIFFERENCE);
        if pairs.is_empty() {
            return Err(no_pair((color, &colors), (depth, &depths)));
        }
        let left = images.iter().filter(|topic| topic.name != color.name && topic.name != depth.name);
        let left = left.map(|topic| (topic.name.clone(), topic.count)).collect();
        let (odometry_topic, base, odometry) = motion(&mut survey, options.odometry_topic.as_deref())?;
        let base_from_camera = mount(&mut survey, &base, &color.frame);
        let ground_truth = ground_truth(&mut survey, color, base_from_camera);
        let topics = RosImageTopics {
            color: color.name.clone(),
            depth: depth.name.clone(),
            info,
            odometry: odometry_topic,
            left,
        };
        Ok(Self {
            path: path.to_owned(),
            topics,
            camera,
            base_from_camera,
            pairs: pairs.into_iter().map(|(i, j)| (colors[i], depths[j])).collect(),
            listed: colors.len(),
            odometry,
            ground_truth,
            warnings: survey.warnings,
        })
    }

    /// The topics of the sequence.
    #[must_use]
    pub fn topics(&self) -> &RosImageTopics {
        &self.topics
    }

    /// The camera of the bag; `None` if none was needed.
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

    /// Whether the sequence is empty; always false.
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

    /// `world_from_camera`, of a topic of odometry or transforms whose name holds `ground_truth`; `None` without one.
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

/// Refuses depth whose camera pose differs from that of colour by the bag's transforms.
fn require_registered(survey: &mut Survey, color: &ImageTopic, depth: &ImageTopic) -> Result<(), String> {
    if color.frame == depth.frame {
        return Ok(());
    }
    let frames =
        format!("depth of {} is in {}, colour of {} in {}", depth.name, depth.frame, color.name, color.frame);
    match survey.contents.transform(&color.frame, &depth.frame) {
        Ok(pose) if pose.translation.norm() <= MAX_DEPTH_OFFSET_M && pose.angle() <= MAX_DEPTH_TURN_RAD => {}
        Ok(pose) => {
            return Err(format!(
                "{frames}, {:.3} m and {:.2} deg apart: expected depth registered to colour, in its frame (--depth-topic names it)",
                pose.translation.norm(),
                pose.angle().to_degrees()
            ));
        }
        Err(_) => survey.warnings.add("depth is taken as registered to colour", &frames),
    }
    Ok(())
}

/// The camera of the colour images and its topic: the requested one, the one with the images' prefix, or the only one in their frame.
fn camera(
    survey: &Survey,
    color: &ImageTopic,
    asked: Option<&str>,
) -> Result<(String, Option<PinholeCamera>), String> {
    let base = base_topic(&color.name);
    let beside = base.rsplit_once('/').map(|(folder, _)| format!("{folder}/camera_info"));
    let wanted = asked.map(str::to_owned).or(beside).unwrap_or_default();
    let by_name = survey.infos.iter().find(|(topic, _)| is_named(topic, &wanted));
    let in_frame = || survey.infos.iter().find(|(_, info)| asked.is_none() && info.frame == color.frame);
    let Some((topic, info)) = by_name.or_else(in_frame) else {
        let topics: Vec<&str> = survey.infos.keys().map(String::as_str).collect();
        let topics = if topics.is_empty() { "none".to_owned() } else { topics.join(", ") };
        return Err(format!(
            "no camera_info on {wanted} for the images of {} (topics of camera_info: {topics}), expected it, or --camera",
            color.name
        ));
    };
    let is_rectified = base.rsplit('/').next().is_some_and(|name| name.contains("rect"));
    let camera = info.camera(is_rectified).map_err(|invalid| format!("camera_info on {topic}: {invalid}"))?;
    Ok((topic.clone(), Some(camera)))
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
    let bases = BASE_FRAMES.iter().copied().chain(base.as_deref());
    let mut broken = None;
    for base in bases {
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

/// `world_from_camera` by rising stamps, of the poses of the camera or of the base.
fn ground_truth(survey: &mut Survey, color: &ImageTopic, mount: Option<Pose3>) -> Vec<(Stamp, Pose3)> {
    let mut poses = Vec::new();
    for (stamp, child, pose) in std::mem::take(&mut survey.truth) {
        if child == color.frame {
            poses.push((stamp, pose));
        } else if let Some(base_from_camera) = mount {
            poses.push((stamp, pose * base_from_camera));
        } else {
            let problem = "ground truth is left out: no transform leads from its frame to the camera";
            survey.warnings.add(problem, &child);
        }
    }
    poses.sort_by_key(|(stamp, _)| *stamp);
    poses.dedup_by_key(|(stamp, _)| *stamp);
    poses
}

fn no_pair((color, colors): (&ImageTopic, &[Stamp]), (depth, depths): (&ImageTopic, &[Stamp])) -> String {
    let span = |stamps: &[Stamp]| match stamps {
        [first, .., last] => format!("{first} s to {last} s"),
        [only] => format!("{only} s"),
        [] => "none".to_owned(),
    };
    format!(
        "no image of {} ({}) is within {} s of one of {} ({})",
        color.name,
        span(colors),
        TumSequence::MAX_DIFFERENCE,
        depth.name,
        span(depths)
    )
}
