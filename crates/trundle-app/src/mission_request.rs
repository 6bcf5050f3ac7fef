//! The mission requested by a front end: goals, exploration, the charging station, or a file.

use crate::{AppError, read_mission};
use std::path::PathBuf;
use trundle_core::Pose2;
use trundle_runtime::{Mission, Task};

/// The mission requested by a front end.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MissionRequest {
    /// Goals, map frame, one after the other.
    pub goals: Vec<Pose2>,
    /// Whether the robot explores first. Without another goal the robot then returns to the start.
    pub explore: bool,
    /// Whether the robot drives onto the charging station at the end.
    pub dock: bool,
    /// A mission file, in place of the other fields.
    pub file: Option<PathBuf>,
}

impl MissionRequest {
    /// Whether the request contains no task.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The tasks of the file; else exploration, the goals, and the charging station or the return.
    ///
    /// # Errors
    /// When the file cannot be read, or the mission is invalid.
    pub fn mission(&self) -> Result<Mission, AppError> {
        match &self.file {
            Some(file) => read_mission(file),
            None => Ok(Mission::new(self.tasks())?),
        }
    }

    fn tasks(&self) -> Vec<Task> {
        let explore = self.explore.then_some(Task::Explore);
        let goals = self.goals.iter().map(|goal| Task::go(*goal));
        // The station is the better place to end at than the start.
        let end = if self.dock { Some(Task::Dock) } else { self.explore.then_some(Task::Return) };
        explore.into_iter().chain(goals).chain(end).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exploration_ends_at_the_start_or_at_the_station() {
        let asked = |explore, dock, goals: &[Pose2]| {
            MissionRequest { goals: goals.to_vec(), explore, dock, file: None }.tasks()
        };
        let goal = Pose2::new(1.0, 2.0, 0.5);
        assert_eq!(asked(true, false, &[]), [Task::Explore, Task::Return]);
        assert_eq!(asked(true, false, &[goal]), [Task::Explore, Task::go(goal), Task::Return]);
        assert_eq!(asked(true, true, &[goal]), [Task::Explore, Task::go(goal), Task::Dock]);
        assert_eq!(asked(false, false, &[goal]), [Task::go(goal)]);
        assert_eq!(asked(false, true, &[]), [Task::Dock]);
    }

    #[test]
    fn a_request_for_nothing_is_empty() {
        assert!(MissionRequest::default().is_empty());
        assert!(!MissionRequest { dock: true, ..MissionRequest::default() }.is_empty());
    }
}
