//! `trundle doctor`: whether this computer is ready to drive a robot.

use crate::console;
use crate::outcome::Outcome;
use clap::Args;
use std::path::PathBuf;
use trundle::app::doctor::{System, examine};

/// `trundle doctor`
#[derive(Debug, Args)]
#[command(
    after_help = "Exit code 1: a problem was found; warnings do not count. Example: trundle doctor --out /data/runs"
)]
pub struct DoctorArgs {
    /// Folder that runs write to.
    #[arg(long, value_name = "FOLDER", default_value = "out")]
    pub out: PathBuf,
    /// Print the checks as JSON.
    #[arg(long)]
    pub json: bool,
}

/// `trundle doctor`.
pub fn run(args: &DoctorArgs) -> Outcome {
    let report = examine(&System::this_computer(), &args.out);
    console::print(&if args.json { report.json() } else { report.text() });
    if report.is_well() { Outcome::Reached } else { Outcome::Missed }
}
