//! The drive to a node.

use super::message::OrderNode;
use crate::robot_commands::RobotCommands;
use crate::robot_status::RobotStatus;
use std::time::Duration;
use trundle_core::{Hypotenuse, Pose2};
use trundle_runtime::{Mission, OperatorCommand, Task, TaskEnd};

/// Time after which a node that was not reached is tried again. Source: ours.
const RETRY_PERIOD: Duration = Duration::from_secs(10);

/// The drive to a node: a mission of one goal.
#[derive(Debug)]
pub struct Drive {
    mission: u64,
    /// Time since the drive failed.
    failed: Option<Duration>,
    is_due: bool,
}

/// State of a drive.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum DriveEnd {
    /// In execution.
    Open,
    /// The node is reached.
    Arrived,
    /// The drive failed for this reason.
    Failed(String),
}

impl Drive {
    /// Begins the drive from `pose` to a node.
    ///
    /// # Errors
    /// When the robot accepts no command.
    pub fn begin(node: &OrderNode, pose: Pose2, robot: &mut dyn RobotCommands) -> Result<Self, String> {
        let goal = goal_of(node, pose).ok_or_else(|| format!("node {} has no position", node.node_id))?;
        let mission = Mission::new(vec![Task::go(goal)]).map_err(|error| error.to_string())?;
        let mission = robot.send(OperatorCommand::Begin(mission))?;
        Ok(Self { mission, failed: None, is_due: false })
    }

    /// Number of the mission.
    #[must_use]
    pub fn mission(&self) -> u64 {
        self.mission
    }

    /// Whether the pause after a failed drive is over and the drive should start again.
    #[must_use]
    pub fn is_due_again(&self) -> bool {
        self.is_due
    }

    /// Updates and returns the state of the drive.
    pub fn step(&mut self, passed: Duration, view: &RobotStatus) -> DriveEnd {
        if let Some(since) = &mut self.failed {
            *since += passed;
            self.is_due = *since >= RETRY_PERIOD;
            return DriveEnd::Open;
        }
        if view.mission.id != self.mission {
            return DriveEnd::Open;
        }
        match view.mission.ended.last().map(|record| &record.end) {
            None => DriveEnd::Open,
            Some(TaskEnd::Done) => DriveEnd::Arrived,
            Some(end) => {
                self.failed = Some(Duration::ZERO);
                DriveEnd::Failed(end.to_string())
            }
        }
    }
}

/// The pose of a node. Without a heading the robot retains its heading of arrival from `pose`.
fn goal_of(node: &OrderNode, pose: Pose2) -> Option<Pose2> {
    let position = node.node_position.as_ref()?;
    let (dx, dy) = (position.x - pose.x, position.y - pose.y);
    let heading = if dx.hypotenuse(dy) > f64::EPSILON { dy.atan2(dx) } else { pose.theta };
    Some(Pose2::new(position.x, position.y, position.theta.unwrap_or(heading)))
}
