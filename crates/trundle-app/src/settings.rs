//! Reading of TOML files, with the line in each message.

use crate::AppError;
use serde::de::DeserializeOwned;
use std::path::Path;
use trundle_core::toml_problem;
use trundle_io::Expected;

/// Reads a TOML file.
///
/// # Errors
/// Names the file and the reason, or the line and the fault.
pub fn read_toml<T: DeserializeOwned>(file: &Path) -> Result<T, AppError> {
    let text = read_text(file)?;
    toml::from_str(&text).map_err(|error| {
        let problem = toml_problem(&text, error.span().map(|span| span.start), error.message());
        AppError::Input(format!("{}, line {}: {}", file.display(), problem.line, problem.message))
    })
}

/// The text of a TOML file.
///
/// # Errors
/// Names the file and the reason.
pub fn read_text(file: &Path) -> Result<String, AppError> {
    Expected::Toml.check(file)?;
    Ok(trundle_io::read_text(file)?)
}
