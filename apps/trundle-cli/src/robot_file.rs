//! `trundle config`: prints the whole robot file.

use crate::outcome::Outcome;
use crate::output_args::OutputDirArg;
use crate::{console, logging};
use clap::Args;
use std::path::PathBuf;
use trundle::app::{AppError, load_robot};
use trundle::io::Summary;
use trundle::runtime::settings::{json_schema, to_commented_toml};

/// `trundle config`
#[derive(Debug, Args)]
#[command(after_help = "Example: trundle config > robot.toml && trundle demo --config robot.toml")]
pub struct ConfigArgs {
    /// Check this robot file and print it completely, with defaults for missing keys.
    pub file: Option<PathBuf>,
    /// Set one key in place of the file's; may be repeated.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Print the JSON schema of robot files instead, for editors.
    #[arg(long)]
    pub schema: bool,
    /// Also write robot.toml, robot.schema.json and summary.json into this folder.
    #[arg(long, value_name = "DIR")]
    pub out: Option<OutputDirArg>,
    /// Print nothing.
    #[arg(long, short)]
    pub quiet: bool,
}

/// `trundle config [FILE]`: the whole robot file.
pub fn print(args: &ConfigArgs) -> Result<Outcome, AppError> {
    if args.schema {
        console::print(&schema_text());
        return Ok(Outcome::Reached);
    }
    let config = load_robot(args.file.as_deref(), &args.set)?;
    let text = to_commented_toml(&config);
    if let Some(out) = &args.out {
        let folder = logging::output_folder(out)?;
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
