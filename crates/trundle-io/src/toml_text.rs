//! TOML texts of any file, with uniform errors.

use crate::IoError;
use serde::de::DeserializeOwned;
use std::path::Path;
use trundle_core::toml_problem;

/// The value that the text of a file holds.
///
/// # Errors
/// Names the file, the line, and the fault.
pub(crate) fn parse_toml<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T, IoError> {
    toml::from_str(text).map_err(|error| {
        let problem = toml_problem(text, error.span().map(|span| span.start), error.message());
        IoError::line(path, problem.line, problem.message)
    })
}
