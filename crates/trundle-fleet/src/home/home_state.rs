//! The state of a robot for a home.

use crate::robot_status::RobotStatus;
use serde::Serialize;
use trundle_runtime::{DriveState, MotionHold, Task};

/// The state of a robot for a home.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HomeState {
    /// Home Assistant's state of a vacuum cleaner.
    state: &'static str,
    /// Activity of the robot, in one or two words.
    doing: &'static str,
    /// Reason why the robot does not move.
    reason: Option<String>,
    /// The present task.
    task: Option<String>,
    /// Charge \[%\].
    battery: Option<f64>,
    /// Whether the battery is being charged.
    charging: bool,
    /// \[m\]
    x: f64,
    /// \[m\]
    y: f64,
    /// \[deg\]
    heading_deg: f64,
}

impl HomeState {
    /// The state of a view.
    pub fn of(view: &RobotStatus) -> Self {
        let hold = view.hold.map(|hold| hold.to_string());
        let pose = view.estimate.pose;
        let rounded = |value: f64, places: f64| (value * places).round() / places;
        let charge = view.battery.and_then(|battery| battery.charge);
        Self {
            state: word_of(view),
            doing: view.state.name(),
            reason: hold.or_else(|| view.state.reason().map(ToString::to_string)),
            task: open_task(view).map(|task| task.to_string()),
            battery: charge.map(|charge| rounded(100.0 * charge, 1.0)),
            charging: view.battery.is_some_and(|battery| battery.is_charging),
            x: rounded(pose.x, 100.0),
            y: rounded(pose.y, 100.0),
            heading_deg: rounded(pose.theta.to_degrees(), 1.0),
        }
    }

    /// Whether both states are equal except for details that are not urgent.
    pub fn is_like(&self, other: &Self) -> bool {
        (self.state, &self.task, self.charging) == (other.state, &other.task, other.charging)
    }
}

/// Source: the states of a vacuum entity of Home Assistant.
fn word_of(view: &RobotStatus) -> &'static str {
    let is_charging = view.battery.is_some_and(|battery| battery.is_charging);
    match (view.hold, open_task(view)) {
        (Some(MotionHold::Paused), _) => "paused",
        (Some(_), _) => "error",
        _ if is_charging => "docked",
        (None, Some(Task::Return | Task::Dock)) => "returning",
        (None, Some(_)) => "cleaning",
        (None, None) if matches!(view.state, DriveState::Stopped { .. }) => "error",
        (None, None) => "idle",
    }
}

fn open_task(view: &RobotStatus) -> Option<&Task> {
    view.mission.task.as_ref().filter(|_| !view.mission.is_over)
}
