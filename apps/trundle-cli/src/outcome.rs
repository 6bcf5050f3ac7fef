//! The end of a command: its exit code, and a sentence on failure.

use crate::console;
use std::path::PathBuf;
use trundle::app::exit_codes::{CODE_INCOMPLETE, CODE_MISSED};
use trundle::app::{AppError, stop};
use trundle::io::IoError;

/// Result of a completed command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Exit code 0.
    Reached,
    /// Exit code 1.
    Missed,
}

impl Outcome {
    /// Reached without a failure; else missed, and the reason is printed.
    pub fn unless(failure: Option<String>) -> Self {
        failure.map_or(Self::Reached, |failure| {
            console::print_error(&AppError::Input(failure));
            Self::Missed
        })
    }
}

/// The exit code of a command that writes into `folders`; prints the reason of a code other than 0.
pub fn end(result: Result<Outcome, AppError>, folders: &[PathBuf]) -> u8 {
    let result = match console::print_failure() {
        Some(error) if result.is_ok() => Err(AppError::Io(IoError::unprinted(error))),
        _ => result,
    };
    let code = match &result {
        Ok(Outcome::Reached) => 0,
        Ok(Outcome::Missed) => CODE_MISSED,
        Err(error) => {
            error.reason().iter().for_each(|error| console::print_error(error));
            error.exit_code()
        }
    };
    let Some((signal, done)) = stop::ended() else { return code };
    let place = match folders {
        [folder, ..] if result.is_ok() || code == CODE_INCOMPLETE => {
            format!("the results so far are in {}", folder.display())
        }
        _ => trundle::app::written_text(),
    };
    console::print_stopped(signal.name(), &format!(" after {done}; {place}"));
    if code == CODE_INCOMPLETE { code } else { signal.exit_code() }
}
