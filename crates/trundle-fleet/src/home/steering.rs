//! From a command of a home to commands of the robot.

use super::command::HomeCommand;
use crate::Places;
use crate::robot_commands::RobotCommands;
use crate::robot_status::RobotStatus;
use trundle_runtime::{Mission, MotionHold, OperatorCommand, Task};

/// Carries out a command; returns the robot's activity in words.
///
/// # Errors
/// Reason why the robot cannot carry the command out.
pub fn execute(
    command: &HomeCommand,
    view: &RobotStatus,
    places: &dyn Places,
    robot: &mut dyn RobotCommands,
) -> Result<String, String> {
    let is_paused = view.hold == Some(MotionHold::Paused);
    let command = match command {
        HomeCommand::Pause => OperatorCommand::Pause,
        HomeCommand::Continue => OperatorCommand::Continue,
        HomeCommand::Start if is_paused => OperatorCommand::Continue,
        HomeCommand::Stop => OperatorCommand::cancel(),
        task => {
            let mission =
                Mission::new(vec![task_of(task, view, places)?]).map_err(|error| error.to_string())?;
            OperatorCommand::Begin(mission)
        }
    };
    let text = text_of(&command);
    let begins = matches!(&command, OperatorCommand::Begin(mission) if !mission.tasks().is_empty());
    robot.send(command)?;
    if begins && is_paused {
        robot.send(OperatorCommand::Continue)?;
    }
    Ok(text)
}

fn task_of(command: &HomeCommand, view: &RobotStatus, places: &dyn Places) -> Result<Task, String> {
    Ok(match command {
        HomeCommand::Return => Task::Return,
        HomeCommand::Dock => Task::Dock,
        HomeCommand::GoHome if view.station.is_some() => Task::Dock,
        HomeCommand::GoHome => Task::Return,
        HomeCommand::GoTo(pose) => Task::go(*pose),
        HomeCommand::GoToPlace(name) => {
            let known = || places.names().join(", ");
            Task::go(places.pose(name).ok_or_else(|| format!("no place '{name}'; places: {}", known()))?)
        }
        _ => Task::Explore,
    })
}

fn text_of(command: &OperatorCommand) -> String {
    match command {
        OperatorCommand::Pause => "pause".to_owned(),
        OperatorCommand::Continue => "go on".to_owned(),
        OperatorCommand::Begin(mission) => {
            mission.tasks().first().map_or("stop".to_owned(), ToString::to_string)
        }
        _ => String::new(),
    }
}
