//! Reason why a run cannot be shown in Foxglove.

use std::net::SocketAddr;
use thiserror::Error;
use trundle_app::AppError;

/// Reason why a run cannot be shown in Foxglove.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FoxgloveError {
    /// The address is in use, or it is not an address of this machine.
    #[error(
        "--foxglove {address}: {problem}; give another address, as --foxglove 127.0.0.1:0 (the system takes a free port)"
    )]
    Address {
        /// The address.
        address: SocketAddr,
        /// Message of the system.
        problem: std::io::Error,
    },
    /// The system refuses a thread or a socket.
    #[error("the server for Foxglove cannot start: {0}")]
    System(#[from] std::io::Error),
}

impl From<FoxgloveError> for AppError {
    fn from(error: FoxgloveError) -> Self {
        match error {
            FoxgloveError::System(_) => Self::Environment(error.to_string()),
            FoxgloveError::Address { .. } => Self::Input(error.to_string()),
        }
    }
}
