//! `trundle doctor`: whether this computer is ready to drive a robot.

use crate::console;
use crate::outcome::Outcome;
use clap::Args;
use std::path::PathBuf;
use trundle::app::doctor::{Level, System, examine};

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
    if args.json {
        console::print(&report.json());
    } else {
        console::print_table(&report.rows());
        let (problems, warnings) = (report.count(Level::Problem), report.count(Level::Warning));
        console::print(&format!("{problems} problems, {warnings} warnings"));
    }
    if report.count(Level::Problem) == 0 { Outcome::Reached } else { Outcome::Missed }
}
