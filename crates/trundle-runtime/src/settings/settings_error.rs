//! Reasons why a robot file is refused.

use thiserror::Error;

/// Reason why a robot file is refused.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{}{message}", line.map_or(String::new(), |line| format!("line {line}: ")))]
pub struct SettingsError {
    /// The line in the file, from 1, if it is known.
    pub line: Option<usize>,
    /// The error, and the accepted values.
    pub message: String,
}

impl SettingsError {
    pub(super) fn new(line: Option<usize>, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }
}
