//! Reason why the live page cannot be served.

use std::net::SocketAddr;
use std::path::PathBuf;
use thiserror::Error;
use trundle_app::AppError;

/// Reason why the live page cannot be served.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LiveError {
    /// The address is in use, or it is not an address of this machine.
    #[error(
        "--live {address}: {problem}; give another address, as --live 127.0.0.1:0 (the system takes a free port)"
    )]
    Address {
        /// The address.
        address: SocketAddr,
        /// Message of the system.
        problem: std::io::Error,
    },
    /// The system refuses a thread or random bytes.
    #[error("the live page cannot start: {0}")]
    System(String),
    /// A certificate or its key cannot be used.
    #[error("certificate of the live page: {}: {problem}", file.display())]
    Certificate {
        /// The file.
        file: PathBuf,
        /// The problem, and the accepted content.
        problem: String,
    },
    /// A file of tokens cannot be used.
    #[error("token file {}: {problem}", file.display())]
    TokenFile {
        /// The file.
        file: PathBuf,
        /// The problem, and the accepted value.
        problem: String,
    },
}

impl From<LiveError> for AppError {
    fn from(error: LiveError) -> Self {
        match error {
            LiveError::System(_) => Self::Environment(error.to_string()),
            _ => Self::Input(error.to_string()),
        }
    }
}
