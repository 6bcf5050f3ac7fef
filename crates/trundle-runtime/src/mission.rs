//! Missions: a sequence of tasks, and their results.

pub(crate) mod dock_failure;
pub(crate) mod dock_task;
pub(crate) mod executor;
pub(crate) mod executor_config;
pub(crate) mod goal_options;
pub(crate) mod light_search;
pub(crate) mod task;

use crate::reason::Reason;
pub use dock_failure::DockFailure;
pub use goal_options::{GoalOptions, TaskGoal, WhenBlocked};
use serde::{Deserialize, Serialize};
use std::fmt;
pub use task::Task;
use trundle_core::{Invalid, Pose2, PoseBound, Stamp};

/// A sequence of tasks. An unreachable goal gets one more attempt at the end of the mission, before a return.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Mission {
    tasks: Vec<Task>,
}

impl Mission {
    /// A mission of these tasks, in this order.
    ///
    /// # Errors
    /// When a goal is not finite; the error names its index.
    pub fn new(tasks: Vec<Task>) -> Result<Self, Invalid> {
        for (i, task) in tasks.iter().enumerate() {
            task.require_usable(i)?;
        }
        Ok(Self { tasks })
    }

    /// The tasks.
    pub fn tasks(&self) -> &[Task] {
        &self.tasks
    }
}

/// State of a mission.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MissionState {
    /// The remaining tasks, the present one first.
    pub left: Mission,
    /// Indices of these tasks in the mission.
    pub places: Vec<usize>,
    /// The tasks that have ended.
    pub ended: Vec<TaskRecord>,
    /// Whether an operator gave the mission and waits for its result: a goal without a path ends immediately.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub by_operator: bool,
}

impl MissionState {
    /// The state before the first task.
    pub fn new(mission: Mission) -> Self {
        let places = (0..mission.tasks().len()).collect();
        Self { places, left: mission, ended: Vec::new(), by_operator: false }
    }

    /// The same mission, marked as given by an operator.
    #[must_use]
    pub(crate) fn of_operator(self) -> Self {
        Self { by_operator: true, ..self }
    }

    /// Returns a valid state, as from a file, unchanged.
    ///
    /// # Errors
    /// When a goal is not finite, or the numbers of tasks and places differ.
    pub fn validated(self) -> Result<Self, Invalid> {
        let (tasks, places) = (self.left.tasks.len(), self.places.len());
        if tasks != places {
            return Err(Invalid::new("places of tasks", places, "", format!("{tasks}, one for each task")));
        }
        Ok(Self { left: Mission::new(self.left.tasks)?, ..self })
    }

    /// This mission after a restart of the robot.
    #[must_use]
    pub(crate) fn after_restart(mut self) -> Self {
        self.ended.iter_mut().for_each(|record| record.before_restart = true);
        self
    }
}

/// End of a task.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum TaskEnd {
    /// The task succeeded.
    Done,
    /// Postponed: a second attempt follows at the end of the mission.
    PutOff {
        /// Reason for the postponement.
        #[serde(flatten)]
        reason: Reason,
    },
    /// The task failed.
    GivenUp {
        /// Reason for the failure.
        #[serde(flatten)]
        reason: Reason,
    },
}

impl fmt::Display for TaskEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Done => f.write_str("done"),
            Self::PutOff { reason } => write!(f, "put off: {reason}"),
            Self::GivenUp { reason } => write!(f, "given up: {reason}"),
        }
    }
}

/// A task that has ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TaskRecord {
    /// Index of the task in the mission.
    pub index: usize,
    /// The task.
    pub task: Task,
    /// End of the task.
    pub end: TaskEnd,
    /// Time of the start.
    pub from: Stamp,
    /// Time of the end.
    pub to: Stamp,
    /// Estimated pose of the robot at that time, map frame.
    pub pose: Pose2,
    /// Error of that pose that is kept with a probability of 95 %; `None` in records of a checkpoint without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bound: Option<PoseBound>,
    /// Whether the robot was restarted since, so that the stamps are of another clock.
    pub before_restart: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_goal_that_is_not_a_number_is_refused_by_its_place() {
        let error = Mission::new(vec![Task::Explore, Task::go(Pose2::new(f64::NAN, 0.0, 0.0))]).unwrap_err();
        assert_eq!(error.field, "x of the goal of task 2");
    }

    #[test]
    fn each_task_has_a_text_and_a_name_in_files() {
        let go = Task::go(Pose2::new(1.0, -2.0, std::f64::consts::FRAC_PI_2));
        let tasks = [
            (go, "go to (1.00 m, -2.00 m, 90 deg)", "go"),
            (Task::Explore, "explore", "explore"),
            (Task::Return, "return to the start", "return"),
            (Task::Dock, "dock at the charging station", "dock"),
        ];
        for (task, text, name) in tasks {
            assert_eq!(task.to_string(), text);
            let file = serde_json::to_string(&task).unwrap();
            assert!(file.contains(name), "{file}");
            assert_eq!(serde_json::from_str::<Task>(&file).unwrap(), task);
        }
    }

    #[test]
    fn a_mission_is_a_list_in_files() {
        let mission = Mission::new(vec![Task::Explore, Task::Return]).unwrap();
        let file = serde_json::to_string(&mission).unwrap();
        assert_eq!(file, r#"["explore","return"]"#);
        assert_eq!(serde_json::from_str::<Mission>(&file).unwrap(), mission);
    }

    #[test]
    fn a_state_from_a_file_needs_a_place_for_each_task_and_finite_goals() {
        let new = |tasks| MissionState::new(Mission { tasks });
        assert_eq!(new(vec![Task::Explore, Task::Return]).places, [0, 1]);
        assert!(new(vec![Task::Explore]).validated().is_ok());
        let missing = MissionState { places: Vec::new(), ..new(vec![Task::Explore]) };
        assert_eq!(missing.validated().unwrap_err().field, "places of tasks");
        let infinite = new(vec![Task::go(Pose2::new(f64::INFINITY, 0.0, 0.0))]);
        assert_eq!(infinite.validated().unwrap_err().field, "x of the goal of task 1");
    }

    #[test]
    fn ends_describe_the_outcome_of_a_task() {
        let reason = || Reason::PoseUnknown;
        assert_eq!(TaskEnd::Done.to_string(), "done");
        assert!(TaskEnd::PutOff { reason: reason() }.to_string().starts_with("put off: the pose is unknown"));
        assert!(
            TaskEnd::GivenUp { reason: reason() }.to_string().starts_with("given up: the pose is unknown")
        );
        assert_eq!(serde_json::to_string(&TaskEnd::Done).unwrap(), r#""done""#);
    }
}
