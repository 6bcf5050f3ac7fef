//! Receiver of commands to the robot.

use trundle_app::operator::Operator;
use trundle_runtime::OperatorCommand;

/// Receiver of commands to the robot: the link to a run, or a list in tests.
pub trait RobotCommands {
    /// Sends a command; returns its number, by which a view identifies its mission.
    ///
    /// # Errors
    /// Reason why the robot refuses the command.
    fn send(&mut self, command: OperatorCommand) -> Result<u64, String>;

    /// Stops the robot and ends its mission, before all waiting commands; the robot obeys the next task.
    ///
    /// # Errors
    /// Reason why the robot cannot be stopped.
    fn stop(&mut self) -> Result<(), String>;
}

impl RobotCommands for Operator {
    fn send(&mut self, command: OperatorCommand) -> Result<u64, String> {
        Self::send(self, command).map_err(|error| error.to_string())
    }

    fn stop(&mut self) -> Result<(), String> {
        self.end_mission().map(drop).map_err(|error| error.to_string())
    }
}
