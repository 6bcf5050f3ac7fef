//! `trundle config`: prints the whole robot file.

use crate::outcome::Outcome;
use crate::output_args::OutputDirArg;
use crate::{console, logging};
use clap::Args;
use std::path::PathBuf;
use trundle::app::{AppError, load_robot, robot_schema, write_robot};
use trundle::runtime::settings::to_commented_toml;

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
        console::print(&robot_schema());
        return Ok(Outcome::Reached);
    }
    let config = load_robot(args.file.as_deref(), &args.set)?;
    if let Some(out) = &args.out {
        write_robot(&config, logging::output_folder(out)?)?;
    }
    if !args.quiet {
        console::print(to_commented_toml(&config).trim_end());
    }
    Ok(Outcome::Reached)
}
