//! Where commands to the robot go.

use trundle_app::operator::Operator;
use trundle_runtime::OperatorCommand;

/// Where commands to the robot go: the link to a run, or a list in tests.
pub trait RobotCommands {
    /// Sends a command; its number, by which a view names its mission.
    ///
    /// # Errors
    /// Why the robot does not take it.
    fn send(&mut self, command: OperatorCommand) -> Result<u64, String>;
}

impl RobotCommands for Operator {
    fn send(&mut self, command: OperatorCommand) -> Result<u64, String> {
        Self::send(self, command).map_err(|error| error.to_string())
    }
}
