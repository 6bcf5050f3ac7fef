//! `trundle config`: prints the whole robot file.

use crate::{Outcome, args::ConfigArgs, console};
use trundle::app::{AppError, load_robot};
use trundle::io::{OutputFolder, Summary};
use trundle::runtime::settings::to_commented_toml;

/// `trundle config [FILE]`: the whole robot file.
pub fn print(args: &ConfigArgs) -> Result<Outcome, AppError> {
    let config = load_robot(args.file.as_deref())?;
    let text = to_commented_toml(&config);
    if let Some(out) = &args.out {
        let folder = OutputFolder::create(out)?;
        folder.write("robot.toml", text.as_bytes())?;
        folder.write("summary.json", Summary::new("config").set("robot", &config).to_json().as_bytes())?;
        folder.commit()?;
    }
    if !args.quiet {
        console::print(text.trim_end());
    }
    Ok(Outcome::Reached)
}
