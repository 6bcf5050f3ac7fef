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
        HomeCommand::Stop => return robot.stop().map(|()| "stop".to_owned()),
        task => {
            let mission =
                Mission::new(vec![task_of(task, view, places)?]).map_err(|error| error.to_string())?;
            OperatorCommand::Begin(mission)
        }
    };
    let text = text_of(&command);
    let begins = matches!(&command, OperatorCommand::Begin(_));
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
            mission.tasks().first().map(ToString::to_string).unwrap_or_default()
        }
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_app::operator::operator_link;
    use trundle_core::Pose2;

    struct NoPlaces;

    impl Places for NoPlaces {
        fn names(&self) -> Vec<String> {
            Vec::new()
        }

        fn pose(&self, _: &str) -> Option<Pose2> {
            None
        }
    }

    #[test]
    fn a_stop_comes_before_waiting_commands_and_the_next_task_is_obeyed() {
        let (mut operator, link) = operator_link();
        let view = RobotStatus::at_rest(Pose2::new(0.0, 0.0, 0.0));
        let mut run = |command| execute(&command, &view, &NoPlaces, &mut operator);
        run(HomeCommand::Return).unwrap();
        assert_eq!(run(HomeCommand::Stop), Ok("stop".to_owned()));
        run(HomeCommand::Start).unwrap();
        let taken: Vec<_> =
            std::iter::from_fn(|| link.next_request()).map(|request| request.command).collect();
        let explore = OperatorCommand::Begin(Mission::new(vec![Task::Explore]).unwrap());
        assert_eq!(taken, [OperatorCommand::cancel(), explore]);
    }
}
