//! Reading of robot files.

use crate::{AppError, settings::read_text};
use std::path::Path;
use trundle_runtime::RobotConfig;
use trundle_runtime::settings::RobotFile;

/// The robot of a robot file; without a file, the default robot.
///
/// # Errors
/// Names the file, and the line or the value that cannot be accepted.
pub fn load_robot(file: Option<&Path>) -> Result<RobotConfig, AppError> {
    let Some(file) = file else { return Ok(RobotConfig::default()) };
    let read = RobotFile::parse(&read_text(file)?, &[])
        .map_err(|error| AppError::Input(format!("{}, {error}", file.display())))?;
    for warning in &read.warnings {
        tracing::warn!("{}: {warning}", file.display());
    }
    Ok(read.config)
}
