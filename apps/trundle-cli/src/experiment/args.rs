//! Arguments of `trundle experiment`.

use crate::common_args::{Common, RobotArgs};
use crate::live::ViewArgs;
use crate::output_args::OutputDirArg;
use clap::{Args, Subcommand};
use std::path::PathBuf;
use trundle::experiments::{IndexRange, Shard};

/// `trundle experiment`
#[derive(Debug, Args)]
pub struct ExperimentArgs {
    /// The experiment.
    #[command(subcommand)]
    pub which: Experiment,
}

/// The experiments.
#[derive(Debug, Subcommand)]
pub enum Experiment {
    /// The eight start poses of Li et al.: the pose error at the goal, without ground truth.
    Poses(PosesArgs),
    /// An unknown room with obstacles, crossed while it is mapped.
    Obstacles(RunsArgs),
    /// Ten goals in six rooms of a furnished house, from an empty map.
    House(HouseArgs),
    /// Broken sensors, slipping wheels, people in the path: no contact, and continuation when possible.
    Faults(RunsArgs),
    /// A person steps into the robot's path one metre ahead, one per run.
    People(RunsArgs),
    /// Plain rooms that look alike from several poses, alone, with people, and carried away.
    LookAlikes(RunsArgs),
    /// Drives onto a charging station by its infrared light, from one start per seed.
    DockingStation(RunsArgs),
    /// The worlds of the BARN challenge, crossed at up to 2 m/s with a 2-D laser.
    Barn(BarnArgs),
    /// The courses of the local-planning benchmark MRPB 1.0, with and without people, with a 2-D laser.
    Mrpb(MrpbArgs),
    /// Long halls, mazes and changed rooms, each with a given map, with a 2-D laser.
    KnownMap(RunsArgs),
    /// A drive in real time for many minutes: jitter of control, load of the robot's core, memory.
    RealTime(RealTimeArgs),
    /// The four corridor scenarios of Hong (2024), by the paper's method and by the optimal one.
    Corridor(CorridorArgs),
    /// The report of a whole experiment from the folders of its shards.
    Merge(MergeArgs),
}

/// Options of every experiment with many runs.
#[derive(Debug, Args)]
pub struct SeriesArgs {
    /// Seeds of noise and scene of each run: 1 to N.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub seeds: u32,
    /// Make only part K of N of the runs, and keep them for `trundle experiment merge`.
    #[arg(long, value_name = "K/N")]
    pub shard: Option<Shard>,
    /// Make only the run of this name, of all parts.
    #[arg(long, value_name = "NAME", requires = "shard", hide_short_help = true)]
    pub run: Option<String>,
    /// The robot's settings.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// The live page, which shows the runs and accepts no commands.
    #[command(flatten)]
    pub live: ViewArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// Options of an experiment of closed-loop runs.
#[derive(Debug, Args)]
#[command(after_help = "Exit code: 0 every limit kept, 1 otherwise, 2 bad input.")]
pub struct RunsArgs {
    /// Only runs whose name and seed ("lights out, seed 2") contain this text.
    #[arg(long, value_name = "WORD")]
    pub only: Option<String>,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/experiment")]
    pub out: OutputDirArg,
    /// Options of every experiment with many runs.
    #[command(flatten)]
    pub series: SeriesArgs,
}

/// `trundle experiment poses`
#[derive(Debug, Args)]
pub struct PosesArgs {
    /// Drive an emulated Kobuki over a serial line, with a stream of camera frames, in real time: about 15 s per run.
    #[arg(long, conflicts_with = "shard")]
    pub wires: bool,
    /// Options of every experiment of runs.
    #[command(flatten)]
    pub runs: RunsArgs,
}

/// `trundle experiment house`
#[derive(Debug, Args)]
pub struct HouseArgs {
    /// The house: small_house.glb, z up.
    #[arg(long, value_name = "FILE", default_value = "../shared/data/scenes/small_house.glb")]
    pub mesh: PathBuf,
    /// Options of every experiment of runs.
    #[command(flatten)]
    pub runs: RunsArgs,
}

/// `trundle experiment barn`
#[derive(Debug, Args)]
#[command(
    after_help = "Exit code: 0 success at least 97 % and mean score at least 0.45, 1 otherwise, 2 bad input."
)]
pub struct BarnArgs {
    /// Numbers of the worlds, from 0 in the order of worlds.csv [default: all]
    #[arg(long, value_name = "A-B")]
    pub worlds: Option<IndexRange>,
    /// Folder with worlds.csv and obstacles.csv.
    #[arg(long, value_name = "DIR", default_value = "../shared/data/nav/barn")]
    pub data: PathBuf,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/barn")]
    pub out: OutputDirArg,
    /// Options of every experiment with many runs.
    #[command(flatten)]
    pub series: SeriesArgs,
}

/// `trundle experiment mrpb`
#[derive(Debug, Args)]
#[command(
    after_help = "Exit code: 0 every goal reached, nothing touched, control cycle within 2 ms on average; 1 otherwise, 2 bad input."
)]
pub struct MrpbArgs {
    /// Only the courses whose name contains this.
    #[arg(long, value_name = "TEXT")]
    pub only: Option<String>,
    /// Folder with start_goal.csv, actors.csv and maps.
    #[arg(long, value_name = "DIR", default_value = "../shared/data/nav/mrpb")]
    pub data: PathBuf,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/mrpb")]
    pub out: OutputDirArg,
    /// Options of every experiment with many runs.
    #[command(flatten)]
    pub series: SeriesArgs,
}

/// `trundle experiment real-time`
#[derive(Debug, Args)]
#[command(
    after_help = "Writes a recording, some 450 MB per minute.\n\nExit code: 0 jitter at most 5 ms (p99.9), load at most 60 %, memory \
                  growing by at most 10 MB/h, nothing touched; 1 otherwise, 2 bad input."
)]
pub struct RealTimeArgs {
    /// Duration of the drive.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=600))]
    pub minutes: u32,
    /// Seed of noise and room.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// The robot's settings.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/real-time")]
    pub out: OutputDirArg,
    /// The live page, which shows the runs and accepts no commands.
    #[command(flatten)]
    pub live: ViewArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle experiment corridor`
#[derive(Debug, Args)]
#[command(
    after_help = "Exit code: 0 every scenario solved, the paper's method with the motions it reports, 1 otherwise, 2 bad input."
)]
pub struct CorridorArgs {
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/corridor")]
    pub out: OutputDirArg,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle experiment merge`
#[derive(Debug, Args)]
#[command(
    after_help = "The table, the report and the files are those of the experiment in one run, byte for byte.\n\nExit code: 0 every limit \
                  kept, 1 otherwise, 2 bad input: a folder of another experiment, or a run that is missing."
)]
pub struct MergeArgs {
    /// The folders of the shards.
    #[arg(required = true, value_name = "DIR")]
    pub folders: Vec<PathBuf>,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/experiment")]
    pub out: OutputDirArg,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

impl Experiment {
    /// The options of an experiment with many runs.
    pub fn series(&self) -> Option<&SeriesArgs> {
        match self {
            Self::Poses(PosesArgs { runs, .. })
            | Self::House(HouseArgs { runs, .. })
            | Self::Obstacles(runs)
            | Self::Faults(runs)
            | Self::People(runs)
            | Self::LookAlikes(runs)
            | Self::KnownMap(runs)
            | Self::DockingStation(runs) => Some(&runs.series),
            Self::Barn(BarnArgs { series, .. }) | Self::Mrpb(MrpbArgs { series, .. }) => Some(series),
            Self::RealTime(_) | Self::Corridor(_) | Self::Merge(_) => None,
        }
    }
}
