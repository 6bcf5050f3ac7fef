//! Reason why a robot cannot join a broker.

use std::path::PathBuf;
use thiserror::Error;
use trundle_app::AppError;

/// Reason why a robot cannot join a broker. A silent broker is not an error: the robot tries again.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FleetError {
    /// The file of the password cannot be used.
    #[error("password file {}: {problem}", file.display())]
    PasswordFile {
        /// The file.
        file: PathBuf,
        /// The problem.
        problem: String,
    },
    /// A password without a user.
    #[error("a password is given and no user: expected --mqtt mqtt://USER@HOST:PORT")]
    PasswordWithoutUser,
    /// The name of the robot is invalid in a topic.
    #[error("--mqtt-name {0}: expected letters, digits, '-' and '_', as robot-7 or acme/robot-7")]
    Name(String),
    /// The system refuses a thread.
    #[error("the link to the broker cannot start: {0}")]
    System(#[from] std::io::Error),
}

impl From<FleetError> for AppError {
    fn from(error: FleetError) -> Self {
        match error {
            FleetError::System(_) => Self::Environment(error.to_string()),
            _ => Self::Input(error.to_string()),
        }
    }
}
