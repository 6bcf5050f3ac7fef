//! An action at a node.

use super::abilities::wait_s;
use super::message::Action;
use crate::robot_commands::RobotCommands;
use crate::robot_status::RobotStatus;
use std::time::Duration;
use trundle_runtime::{Mission, MotionHold, OperatorCommand, Task, TaskEnd};

/// An action in progress at a node.
#[derive(Debug)]
pub struct NodeAction {
    action: Action,
    work: Work,
}

#[derive(Debug)]
enum Work {
    /// The robot came to the exact pose already.
    Nothing,
    /// Time that is left.
    Wait(Duration),
    /// The mission that drives onto the charging station.
    Charge(u64),
}

/// State of an action.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum ActionEnd {
    /// In execution.
    Open,
    /// Done.
    Done,
    /// The action failed for this reason.
    Failed(String),
}

impl NodeAction {
    /// Whether an action moves the robot.
    #[must_use]
    pub fn drives(action: &Action) -> bool {
        action.action_type == "startCharging"
    }

    /// Begins an action; the number of its mission, if it has one.
    ///
    /// # Errors
    /// Reason why the action cannot start.
    pub fn begin(action: Action, robot: &mut dyn RobotCommands) -> Result<(Self, Option<u64>), String> {
        let (work, mission) = match action.action_type.as_str() {
            "wait" => (Work::Wait(Duration::from_secs_f64(wait_s(&action).ok_or("no duration")?)), None),
            "finePositioning" => (Work::Nothing, None),
            "startCharging" => {
                let mission = Mission::new(vec![Task::Dock]).map_err(|error| error.to_string())?;
                let mission = robot.send(OperatorCommand::Begin(mission))?;
                (Work::Charge(mission), Some(mission))
            }
            other => return Err(format!("this robot cannot do {other}")),
        };
        Ok((Self { action, work }, mission))
    }

    /// The action.
    #[must_use]
    pub fn action(&self) -> &Action {
        &self.action
    }

    /// Continues the action, `passed` after the last step. A pause stops its time.
    pub fn step(&mut self, passed: Duration, view: &RobotStatus) -> ActionEnd {
        match &mut self.work {
            Work::Nothing => ActionEnd::Done,
            Work::Wait(left) => {
                if view.hold != Some(MotionHold::Paused) {
                    *left = left.saturating_sub(passed);
                }
                if left.is_zero() { ActionEnd::Done } else { ActionEnd::Open }
            }
            Work::Charge(mission) if view.mission.id == *mission => {
                match view.mission.ended.last().map(|record| &record.end) {
                    None => ActionEnd::Open,
                    Some(TaskEnd::Done) => ActionEnd::Done,
                    Some(end) => ActionEnd::Failed(end.to_string()),
                }
            }
            Work::Charge(_) => ActionEnd::Open,
        }
    }
}
