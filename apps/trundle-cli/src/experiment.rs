//! `trundle experiment`: the papers' experiments as commands; exit code 1 where a limit is missed.

mod corridor;

use crate::{Outcome, args::Common, failure::Failure};
use clap::{Args, Subcommand};
use std::path::PathBuf;

/// `trundle experiment`
#[derive(Debug, Args)]
pub struct ExperimentArgs {
    /// Which one.
    #[command(subcommand)]
    pub which: Which,
}

/// The experiments.
#[derive(Debug, Subcommand)]
pub enum Which {
    /// The four corridor scenarios of Hong (2024), by the paper's method and by the optimal one.
    Corridor(CorridorArgs),
}

/// `trundle experiment corridor`
#[derive(Debug, Args)]
#[command(
    after_help = "Exit code: 0 every scenario solved, the paper's method with the motions it reports, 1 otherwise, 2 bad input."
)]
pub struct CorridorArgs {
    /// Folder for the results.
    #[arg(long, value_name = "DIR", default_value = "out/corridor")]
    pub out: PathBuf,
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

impl ExperimentArgs {
    /// What every command takes.
    pub fn common(&self) -> &Common {
        match &self.which {
            Which::Corridor(args) => &args.common,
        }
    }
}

/// Runs the experiment that was asked for.
pub fn run(args: &ExperimentArgs) -> Result<Outcome, Failure> {
    match &args.which {
        Which::Corridor(args) => corridor::run(args),
    }
}
