//! Reading of robot files.

use crate::{AppError, settings::read_text};
use std::fmt::Display;
use std::path::Path;
use trundle_io::{OutputFolder, Summary};
use trundle_runtime::RobotConfig;
use trundle_runtime::settings::{RobotFile, json_schema, to_commented_toml};

/// The robot of a robot file, or the default robot, with `overrides` (each `key=value`) on top. Deprecated keys are logged as
/// warnings.
///
/// # Errors
/// Names the file, and the invalid line or value.
pub fn load_robot(file: Option<&Path>, overrides: &[String]) -> Result<RobotConfig, AppError> {
    let text = file.map(read_text).transpose()?.unwrap_or_default();
    parse_robot(&text, file.map(|file| file.display().to_string()).as_deref(), overrides)
}

/// The robot of the text of a robot file, with `overrides` (each `key=value`) on top; `name` is that of the file in messages.
///
/// # Errors
/// Names the invalid line or value.
pub fn parse_robot(text: &str, name: Option<&str>, overrides: &[String]) -> Result<RobotConfig, AppError> {
    let named = |mark: &str, problem: &dyn Display| match name {
        Some(name) => format!("{name}{mark} {problem}"),
        None => problem.to_string(),
    };
    let read = RobotFile::parse(text, overrides).map_err(|error| {
        let mark = if error.line.is_some() { "," } else { ":" };
        AppError::Input(named(mark, &error))
    })?;
    for warning in &read.warnings {
        tracing::warn!("{}", named(":", warning));
    }
    Ok(read.config)
}

/// Writes a robot into a folder: robot.toml, robot.schema.json and summary.json.
///
/// # Errors
/// When a file cannot be written.
pub fn write_robot(config: &RobotConfig, folder: OutputFolder) -> Result<(), AppError> {
    folder.write("robot.toml", to_commented_toml(config).as_bytes())?;
    folder.write("robot.schema.json", robot_schema().as_bytes())?;
    folder.write("summary.json", Summary::new("config").set("robot", config).to_json().as_bytes())?;
    folder.commit()?;
    Ok(())
}

/// The JSON schema of robot files, as text.
#[must_use]
pub fn robot_schema() -> String {
    format!("{:#}", json_schema())
}
