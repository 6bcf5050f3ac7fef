//! `trundle config`: prints the whole robot file.

use crate::{Outcome, args::ConfigArgs, console};
use trundle::app::{AppError, load_robot};
use trundle::io::{OutputFolder, Summary};
use trundle::runtime::settings::{json_schema, to_commented_toml};

/// `trundle config [FILE]`: the whole robot file.
pub fn print(args: &ConfigArgs) -> Result<Outcome, AppError> {
    if args.schema {
        console::print(&schema_text());
        return Ok(Outcome::Reached);
    }
    let config = load_robot(args.file.as_deref(), &args.set)?;
    let text = to_commented_toml(&config);
    if let Some(out) = &args.out {
        let folder = OutputFolder::create(out)?;
        folder.write("robot.toml", text.as_bytes())?;
        folder.write("robot.schema.json", schema_text().as_bytes())?;
        folder.write("summary.json", Summary::new("config").set("robot", &config).to_json().as_bytes())?;
        folder.commit()?;
    }
    if !args.quiet {
        console::print(text.trim_end());
    }
    Ok(Outcome::Reached)
}

fn schema_text() -> String {
    serde_json::to_string_pretty(&json_schema()).expect("invariant: a JSON value is text")
}
