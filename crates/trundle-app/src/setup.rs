//! The setup of a run: all that a replay needs besides the events.

use crate::vocabulary_file::read_vocabulary;
use crate::{AppError, RecordingContent, RunLog};
use base64::prelude::{BASE64_STANDARD, Engine};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use trundle_core::{MapAnnotations, Pose2};
use trundle_io::read_annotations;
use trundle_runtime::settings::with_present_names;
use trundle_runtime::{Checkpoint, Mission, Robot, RobotConfig, Task};
use trundle_vision::Vocabulary;

/// Distance of a goal from the start that still is the start \[m\]. Source: default of `docking.tolerance_m`.
const SAME_PLACE_M: f64 = 0.01;
/// Difference of a heading from the start that still is the start \[rad\]: 1 deg. Source: ours.
const SAME_HEADING_RAD: f64 = 0.0175;

/// The command that drives hardware.
pub const RUN_COMMAND: &str = "run";

/// The setup of a run: recorded first, and all that a replay needs besides the events.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct RunSetup {
    /// The command that made the run, for reports.
    #[serde(default = "demo", skip_serializing_if = "is_demo")]
    pub command: String,
    /// The name of the scene or of the robot, for reports.
    pub scene: String,
    /// The seed of scene and noise.
    pub seed: u64,
    /// The robot's mission, map frame.
    pub mission: Mission,
    /// Moves truth into the map frame; for evaluation only.
    pub map_from_world: Pose2,
    /// Time of the robot at which the run ends \[s\].
    pub time_limit: f64,
    /// The robot.
    pub robot: RobotConfig,
    /// Whether the robot's long jobs run in threads in parallel with the control loop.
    #[serde(default)]
    pub real_time: bool,
    /// Whether the run continues after its mission, for the next request of an operator.
    #[serde(default, rename = "operated", skip_serializing_if = "std::ops::Not::not")]
    pub is_operated: bool,
    /// Content of the recording.
    #[serde(default, skip_serializing_if = "RecordingContent::is_all")]
    pub recording: RecordingContent,
    /// The checkpoint of a resumed robot, as base64 of its bytes; `None` starts with an empty map.
    #[serde(default, rename = "woken", alias = "checkpoint", skip_serializing_if = "Option::is_none")]
    pub checkpoint: Option<String>,
    /// The vocabulary for place recognition, as base64 of its bytes; `None` is the built-in one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vocabulary: Option<String>,
    /// Zones and named places of the map; `None` uses those of the checkpoint.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub annotations: Option<MapAnnotations>,
    /// Time of the run at which the recording begins \[s\]; `None` for one from the start, which a replay needs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recorded_from_s: Option<f64>,
    /// The file that stores changes of zones and places.
    #[serde(skip)]
    pub annotations_file: Option<PathBuf>,
}

fn demo() -> String {
    "demo".to_owned()
}

fn is_demo(command: &str) -> bool {
    command == "demo"
}

impl RunSetup {
    /// A run of `robot` with `mission`, from an empty map, in the data's time, seed 1, without time limit.
    #[must_use]
    pub fn new(scene: &str, mission: Mission, robot: RobotConfig) -> Self {
        Self {
            command: demo(),
            scene: scene.to_owned(),
            seed: 1,
            mission,
            map_from_world: Pose2::IDENTITY,
            time_limit: f64::MAX,
            robot,
            real_time: false,
            is_operated: false,
            recording: RecordingContent::All,
            checkpoint: None,
            vocabulary: None,
            annotations: None,
            recorded_from_s: None,
            annotations_file: None,
        }
    }

    /// The empty log of the run.
    #[must_use]
    pub fn log(&self) -> RunLog {
        RunLog::of_run(!self.mission.tasks().is_empty(), self.is_operated)
    }

    /// The same run, made by another command than `demo`.
    #[must_use]
    pub fn by_command(self, command: &str) -> Self {
        Self { command: command.to_owned(), ..self }
    }

    /// The setup that a recording begins with, its robot checked.
    ///
    /// # Errors
    /// When the config is not a setup, or its robot is invalid. Names the file.
    pub(crate) fn of_recording(file: &Path, config: serde_json::Value) -> Result<Self, AppError> {
        let name = file.display();
        let setup: Self = serde_json::from_value(with_present_names(config))
            .map_err(|error| AppError::Input(format!("{name}: the configuration cannot be used: {error}")))?;
        setup.robot.clone().validated().map_err(|error| AppError::Input(format!("{name}: {error}")))?;
        Ok(setup)
    }

    /// The command of a run on sensors that something else drove: a bag or a folder of images.
    pub const SENSORS: &'static str = "replay";

    /// Whether the run has only the sensors of a robot that something else drove.
    #[must_use]
    pub fn is_of_sensors(&self) -> bool {
        self.command == Self::SENSORS
    }

    /// The same run with the end at `time_limit` of the robot's time \[s\].
    #[must_use]
    pub fn with_time_limit(self, time_limit: f64) -> Self {
        Self { time_limit, ..self }
    }

    /// Whether the time limit has ended the run of a log.
    pub(crate) fn is_out_of_time(&self, log: &RunLog) -> bool {
        log.elapsed() > self.time_limit
    }

    /// The same run, which continues after its mission for the requests of an operator.
    #[must_use]
    pub fn operated(self) -> Self {
        Self { is_operated: true, ..self }
    }

    /// The same run, resumed from the bytes of a checkpoint.
    #[must_use]
    pub fn resumed_from(self, checkpoint: &[u8]) -> Self {
        Self { checkpoint: Some(BASE64_STANDARD.encode(checkpoint)), ..self }
    }

    /// The same run, with places recognised by this vocabulary.
    #[must_use]
    pub fn with_vocabulary(self, vocabulary: &Vocabulary) -> Self {
        Self { vocabulary: Some(BASE64_STANDARD.encode(vocabulary.to_bytes())), ..self }
    }

    /// The same run, with places recognised by the vocabulary of a file, if one is given.
    ///
    /// # Errors
    /// When the file cannot be read or is no vocabulary.
    pub fn with_vocabulary_of(self, file: Option<&Path>) -> Result<Self, AppError> {
        let vocabulary = file.map(read_vocabulary).transpose()?;
        Ok(match vocabulary {
            Some(vocabulary) => self.with_vocabulary(&vocabulary),
            None => self,
        })
    }

    /// Lines for a person before a run of `body` (its name): the mission, and the recording with the camera's rate \[Hz\].
    #[must_use]
    pub fn announcement(&self, body: &str, camera_rate_hz: f64) -> String {
        let recording = self.recording.announcement(&self.robot.camera, camera_rate_hz, self.time_limit);
        format!("{body}: {}.\n{recording}", self.mission_line())
    }

    /// The mission, for a person before the run.
    #[must_use]
    pub fn mission_line(&self) -> String {
        if self.mission.tasks().is_empty() {
            return "waits for goals; Ctrl-C ends it".to_owned();
        }
        let then = if self.is_operated { ", then waits for goals" } else { "" };
        format!("{}{then}", mission_text(&self.mission))
    }

    /// The same run with the zones and places of a GeoJSON file; changes are stored in this file. If the file is missing, those of the
    /// checkpoint are used, and the first change creates the file.
    ///
    /// # Errors
    /// When the file exists and cannot be used. Names the feature.
    pub fn with_annotations_of(self, file: &Path) -> Result<Self, AppError> {
        let annotations = file.exists().then(|| read_annotations(file)).transpose()?;
        Ok(Self { annotations, annotations_file: Some(file.to_owned()), ..self })
    }

    /// The robot, its mission started.
    ///
    /// # Errors
    /// When a number of the robot is outside its range, or the checkpoint cannot be used.
    pub fn start_robot(&self) -> Result<Robot, AppError> {
        let mut robot = self.robot_at_start()?;
        if let Some(annotations) = &self.annotations {
            robot.annotate(annotations.clone().validated()?);
        }
        let Some(vocabulary) = &self.vocabulary else { return Ok(robot) };
        let unusable = |error: String| AppError::Input(format!("the vocabulary cannot be used: {error}"));
        let bytes = BASE64_STANDARD.decode(vocabulary).map_err(|error| unusable(error.to_string()))?;
        let vocabulary = Vocabulary::from_bytes(&bytes).map_err(|error| unusable(error.to_string()))?;
        Ok(robot.with_vocabulary(&Arc::new(vocabulary)))
    }

    fn robot_at_start(&self) -> Result<Robot, AppError> {
        let Some(checkpoint) = &self.checkpoint else {
            let mut robot = Robot::new(self.robot.clone())?;
            robot.begin(&self.mission);
            return Ok(robot);
        };
        let unusable = |error: String| AppError::Input(format!("the checkpoint cannot be used: {error}"));
        let bytes = BASE64_STANDARD.decode(checkpoint).map_err(|error| unusable(error.to_string()))?;
        let checkpoint = Checkpoint::from_bytes(&bytes).map_err(|error| unusable(error.to_string()))?;
        Robot::resume(self.robot.clone(), &checkpoint).map_err(|error| unusable(error.to_string()))
    }

    /// Whether the run is of a robot of hardware, not of the simulator.
    #[must_use]
    pub fn is_on_hardware(&self) -> bool {
        self.command == RUN_COMMAND
    }

    /// The goal of a task, map frame; `None` for a task without a goal.
    #[must_use]
    pub fn goal_of(task: &Task) -> Option<Pose2> {
        match task {
            Task::Go(goal) => Some(goal.pose),
            Task::Return => Some(Pose2::IDENTITY),
            _ => None,
        }
    }

    /// Whether the mission only stays at the start.
    #[must_use]
    pub fn is_without_motion(&self) -> bool {
        let is_start = |goal: Pose2| {
            goal.distance(&Pose2::IDENTITY) < SAME_PLACE_M && goal.theta.abs() < SAME_HEADING_RAD
        };
        let stays = |task: &Task| {
            matches!(task, Task::Go(_) | Task::Return) && Self::goal_of(task).is_some_and(is_start)
        };
        self.checkpoint.is_none() && self.mission.tasks().iter().all(stays)
    }

    /// The last goal of the mission.
    #[must_use]
    pub fn last_goal(&self) -> Option<Pose2> {
        self.last_goal_task().as_ref().and_then(Self::goal_of)
    }

    /// The last task of the mission that has a goal.
    #[must_use]
    pub fn last_goal_task(&self) -> Option<Task> {
        self.mission.tasks().iter().rev().find(|task| Self::goal_of(task).is_some()).copied()
    }
}

/// A mission in words.
#[must_use]
pub fn mission_text(mission: &Mission) -> String {
    mission.tasks().iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setup() -> RunSetup {
        RunSetup::new(
            "demo",
            Mission::new(vec![Task::Explore, Task::Return]).unwrap(),
            RobotConfig::default(),
        )
    }

    #[test]
    fn the_line_before_a_run_says_what_follows_the_mission() {
        let operated = setup().operated();
        assert_eq!(setup().mission_line(), "explore, return to the start");
        assert_eq!(operated.mission_line(), "explore, return to the start, then waits for goals");
        let idle = RunSetup { mission: Mission::default(), ..operated };
        assert_eq!(idle.mission_line(), "waits for goals; Ctrl-C ends it");
    }

    #[test]
    fn the_last_goal_is_that_of_the_last_task_with_one() {
        assert_eq!(setup().last_goal(), Some(Pose2::IDENTITY));
        assert_eq!(RunSetup::goal_of(&Task::Explore), None);
    }

    #[test]
    fn a_mission_to_the_start_alone_is_without_motion() {
        let direct = |goals: &[Pose2]| {
            let mission = Mission::new(goals.iter().map(|goal| Task::go(*goal)).collect()).unwrap();
            RunSetup::new("demo", mission, RobotConfig::default()).is_without_motion()
        };
        assert!(direct(&[Pose2::IDENTITY]));
        assert!(!direct(&[Pose2::new(0.0, 0.0, 0.5)]) && !direct(&[Pose2::new(0.1, 0.0, 0.0)]));
        assert!(!direct(&[Pose2::new(1.0, 0.0, 0.0), Pose2::IDENTITY]));
        assert!(!setup().is_without_motion(), "it explores");
    }

    #[test]
    fn a_setup_survives_its_recording() {
        let resumed = setup().with_time_limit(12.0).resumed_from(b"abc");
        let text = serde_json::to_string(&resumed).unwrap();
        let read: RunSetup = serde_json::from_str(&text).unwrap();
        assert_eq!((read.checkpoint.as_deref(), read.time_limit), (Some("YWJj"), 12.0));
        let renamed: RunSetup = serde_json::from_str(&text.replace("\"woken\"", "\"checkpoint\"")).unwrap();
        assert_eq!(renamed.checkpoint, read.checkpoint);
    }

    #[test]
    fn a_vocabulary_is_part_of_the_recording() {
        let own = setup().with_vocabulary(&Vocabulary::builtin());
        let read: RunSetup = serde_json::from_str(&serde_json::to_string(&own).unwrap()).unwrap();
        assert!(read.vocabulary.is_some() && read.start_robot().is_ok());
        assert!(!serde_json::to_string(&setup()).unwrap().contains("vocabulary"));
        let broken = RunSetup { vocabulary: Some("YWJj".to_owned()), ..setup() };
        let refusal = broken.start_robot().err().unwrap().to_string();
        assert!(refusal.starts_with("the vocabulary cannot be used"), "{refusal}");
    }

    #[test]
    fn a_broken_checkpoint_is_refused() {
        let refusal = setup().resumed_from(b"no checkpoint").start_robot().err().unwrap().to_string();
        assert!(refusal.starts_with("the checkpoint cannot be used"), "{refusal}");
    }
}
