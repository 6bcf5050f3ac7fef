//! The setup of a run: all that a replay needs besides the events.

use crate::AppError;
use base64::prelude::{BASE64_STANDARD, Engine};
use serde::{Deserialize, Serialize};
use trundle_core::Pose2;
use trundle_runtime::{Checkpoint, Mission, Robot, RobotConfig, Task};

/// The setup of a run: recorded first, and all that a replay needs besides the events.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct RunSetup {
    /// The scene's name, for reports.
    pub scene: String,
    /// The seed of scene and noise.
    pub seed: u64,
    /// The robot's mission, map frame.
    pub mission: Mission,
    /// Moves truth into the map frame; for evaluation only.
    pub map_from_world: Pose2,
    /// Time of the robot after which the run is given up \[s\].
    pub time_limit: f64,
    /// The robot.
    pub robot: RobotConfig,
    /// Whether the robot's long work runs in threads beside the control loop.
    #[serde(default)]
    pub real_time: bool,
    /// The checkpoint that the robot resumes from, as base64 of its bytes. None: the robot starts with an empty map.
    #[serde(default, rename = "woken", alias = "checkpoint", skip_serializing_if = "Option::is_none")]
    pub checkpoint: Option<String>,
}

impl RunSetup {
    /// A run of `robot` with `mission`, from an empty map, in the data's time, seed 1, without time limit.
    #[must_use]
    pub fn new(scene: &str, mission: Mission, robot: RobotConfig) -> Self {
        Self {
            scene: scene.to_owned(),
            seed: 1,
            mission,
            map_from_world: Pose2::IDENTITY,
            time_limit: f64::MAX,
            robot,
            real_time: false,
            checkpoint: None,
        }
    }

    /// The same run, given up after `time_limit` of the robot's time \[s\].
    #[must_use]
    pub fn with_time_limit(self, time_limit: f64) -> Self {
        Self { time_limit, ..self }
    }

    /// The same run, resumed from the bytes of a checkpoint.
    #[must_use]
    pub fn resumed_from(self, checkpoint: &[u8]) -> Self {
        Self { checkpoint: Some(BASE64_STANDARD.encode(checkpoint)), ..self }
    }

    /// The robot, its mission started.
    ///
    /// # Errors
    /// When a number of the robot is outside its range, or the checkpoint cannot be used.
    pub fn start_robot(&self) -> Result<Robot, AppError> {
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

    /// The goal of a task, map frame; `None` for a task without a goal.
    #[must_use]
    pub fn goal_of(task: &Task) -> Option<Pose2> {
        match task {
            Task::Go(goal) => Some(*goal),
            Task::Return => Some(Pose2::IDENTITY),
            _ => None,
        }
    }

    /// The last goal of the mission.
    #[must_use]
    pub fn last_goal(&self) -> Option<Pose2> {
        self.mission.tasks().iter().rev().find_map(Self::goal_of)
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
    fn the_last_goal_is_that_of_the_last_task_with_one() {
        assert_eq!(setup().last_goal(), Some(Pose2::IDENTITY));
        assert_eq!(RunSetup::goal_of(&Task::Explore), None);
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
    fn a_broken_checkpoint_is_refused() {
        let refusal = setup().resumed_from(b"no checkpoint").start_robot().err().unwrap().to_string();
        assert!(refusal.starts_with("the checkpoint cannot be used"), "{refusal}");
    }
}
