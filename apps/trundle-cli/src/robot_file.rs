use crate::{Outcome, args::ConfigArgs, console, failure::Failure, settings};
use std::path::Path;
use trundle::io::{OutputFolder, Summary};
use trundle::runtime::RobotConfig;

/// Reads a robot file; without one, the defaults.
pub fn load(file: Option<&Path>) -> Result<RobotConfig, Failure> {
    let Some(file) = file else { return Ok(RobotConfig::default()) };
    let config: RobotConfig = settings::read(file)?;
    config.validated().map_err(|error| Failure::Input(format!("{}: {error}", file.display())))
}

/// `trundle config [FILE]`: the whole robot file.
pub fn print(args: &ConfigArgs) -> Result<Outcome, Failure> {
    let config = load(args.file.as_deref())?;
    let text = config.to_toml();
    if let Some(out) = &args.out {
        let folder = OutputFolder::create(out)?;
        folder.write("robot.toml", text.as_bytes())?;
        folder.write("summary.json", Summary::new("config").set("robot", &config).to_json().as_bytes())?;
        folder.commit()?;
    }
    if !args.quiet {
        console::say(text.trim_end());
    }
    Ok(Outcome::Reached)
}
