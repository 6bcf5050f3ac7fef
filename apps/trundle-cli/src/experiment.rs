//! `trundle experiment`: the papers' experiments as commands; exit code 1 where a limit is missed.

mod corridor;
mod faults;
mod missions;
mod poses;
mod trial;

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
    /// The eight start poses of Li et al.: how exactly the robot settles, on its own senses.
    Poses(RunsArgs),
    /// An unknown room with obstacles, crossed while it is mapped.
    Obstacles(RunsArgs),
    /// Ten goals in six rooms of a furnished house, from an empty map.
    House(HouseArgs),
    /// Sensors that break, wheels that slip, people in the way: nothing touched, and on when it can be.
    Faults(RunsArgs),
    /// The four corridor scenarios of Hong (2024), by the paper's method and by the optimal one.
    Corridor(CorridorArgs),
}

/// What an experiment of closed-loop runs takes.
#[derive(Debug, Args)]
#[command(after_help = "Exit code: 0 every limit kept, 1 otherwise, 2 bad input.")]
pub struct RunsArgs {
    /// Seeds of noise and room: 1 to N.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub seeds: u32,
    /// Only runs whose name holds this.
    #[arg(long, value_name = "WORD")]
    pub only: Option<String>,
    /// Robot file (see `trundle config`).
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// Folder for the results.
    #[arg(long, value_name = "DIR", default_value = "out/experiment")]
    pub out: PathBuf,
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle experiment house`
#[derive(Debug, Args)]
pub struct HouseArgs {
    /// The house: small_house.glb, z up.
    #[arg(long, value_name = "FILE", default_value = "../shared/data/scenes/small_house.glb")]
    pub mesh: PathBuf,
    /// What every experiment of runs takes.
    #[command(flatten)]
    pub runs: RunsArgs,
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
            Which::Poses(args) | Which::Obstacles(args) | Which::Faults(args) => &args.common,
            Which::House(args) => &args.runs.common,
            Which::Corridor(args) => &args.common,
        }
    }
}

/// Runs the experiment that was asked for.
pub fn run(args: &ExperimentArgs) -> Result<Outcome, Failure> {
    match &args.which {
        Which::Poses(args) => poses::run(args),
        Which::Obstacles(args) => missions::obstacles(args),
        Which::House(args) => missions::house(&args.runs, &args.mesh),
        Which::Faults(args) => faults::run(args),
        Which::Corridor(args) => corridor::run(args),
    }
}
