//! Error that ends a run or a command, in one sentence for a person.

use crate::exit_codes::{CODE_BAD_INPUT, CODE_INCOMPLETE, CODE_MISSED};
use thiserror::Error;
use trundle_core::Invalid;
use trundle_io::IoError;

/// Error that ends a run or a command, in one sentence for a person.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AppError {
    /// A file or folder cannot be read, understood or written.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A value is invalid.
    #[error("{0}")]
    Invalid(#[from] Invalid),
    /// An argument, a file's content or a body's event is invalid.
    #[error("{0}")]
    Input(String),
    /// The user interrupted the command before any result existed.
    #[error("nothing was done yet, so nothing was written")]
    Stopped,
    /// The machine refused a thread, a device or a signal.
    #[error("{0}")]
    Environment(String),
}

impl AppError {
    /// An error about input: an argument, a file's content or a body's event.
    #[must_use]
    pub fn input(problem: impl std::fmt::Display) -> Self {
        Self::Input(problem.to_string())
    }

    /// The exit code of a program that this error ends.
    #[must_use]
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Stopped => CODE_MISSED,
            Self::Io(error) if error.is_incomplete() => CODE_INCOMPLETE,
            _ => CODE_BAD_INPUT,
        }
    }

    /// The error if it is a reason for a person to read; a stop by the user is none.
    #[must_use]
    pub fn reason(&self) -> Option<&Self> {
        (!matches!(self, Self::Stopped)).then_some(self)
    }

    /// The same error, preceded by the name of the file or part concerned if the error names none.
    #[must_use]
    pub fn in_context(self, context: &dyn std::fmt::Display) -> Self {
        match self {
            Self::Input(problem) => Self::Input(format!("{context}: {problem}")),
            other => other,
        }
    }
}
