use crate::{Outcome, args::ConfigArgs, console, failure::Failure, settings};
use std::path::Path;
use trundle::io::{OutputFolder, Summary};
use trundle::runtime::RobotConfig;
use trundle::runtime::settings::{RobotFile, to_commented_toml};

/// Reads a robot file; without one, the defaults.
pub fn load(file: Option<&Path>) -> Result<RobotConfig, Failure> {
    let Some(file) = file else { return Ok(RobotConfig::default()) };
    let read = RobotFile::parse(&settings::text_of(file)?, &[])
        .map_err(|error| Failure::Input(format!("{}, {error}", file.display())))?;
    for warning in &read.warnings {
        console::warn(&format!("{}: {warning}", file.display()));
    }
    Ok(read.config)
}

/// `trundle config [FILE]`: the whole robot file.
pub fn print(args: &ConfigArgs) -> Result<Outcome, Failure> {
    let config = load(args.file.as_deref())?;
    let text = to_commented_toml(&config);
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
