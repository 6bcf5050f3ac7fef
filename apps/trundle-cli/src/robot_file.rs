use crate::{Outcome, console, failure::Failure};
use std::path::Path;
use trundle::runtime::RobotConfig;

/// Reads a robot file; without one, the defaults.
pub fn load(file: Option<&Path>) -> Result<RobotConfig, Failure> {
    let Some(file) = file else { return Ok(RobotConfig::default()) };
    let name = file.display();
    let text = std::fs::read_to_string(file).map_err(|error| Failure::Input(format!("{name}: {error}")))?;
    let config = RobotConfig::from_toml(&text).map_err(|error| Failure::Input(format!("{name}: {error}")))?;
    config.validated().map_err(|error| Failure::Input(format!("{name}: {error}")))
}

/// `trundle config [FILE]`: the whole robot file.
pub fn print(file: Option<&Path>) -> Result<Outcome, Failure> {
    console::say(load(file)?.to_toml().trim_end());
    Ok(Outcome::Reached)
}
