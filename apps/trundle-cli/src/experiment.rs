//! `trundle experiment`: the papers' experiments as commands; exit code 1 if a limit is missed.

use crate::common_args::{Common, RobotArgs};
use crate::live::ViewArgs;
use crate::outcome::Outcome;
use crate::output_args::OutputDirArg;
use crate::{console, logging};
use clap::{Args, Subcommand};
use std::path::{Path, PathBuf};
use trundle::app::operator::OperatorLink;
use trundle::app::{AppError, stop};
use trundle::experiments::{
    ExperimentDisplay, ExperimentReport, IndexRange, RunsRequest, barn, corridor, docking_station,
    fault_scenarios, look_alikes, missions, mrpb, people, poses, real_time,
};
use trundle::io::OutputFolder;
use trundle::live::LivePage;

/// `trundle experiment`
#[derive(Debug, Args)]
pub struct ExperimentArgs {
    /// The experiment.
    #[command(subcommand)]
    pub which: Which,
}

/// The experiments.
#[derive(Debug, Subcommand)]
pub enum Which {
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
    /// By the clock on the wall for many minutes: jitter of control, load of the robot's core, memory.
    RealTime(RealTimeArgs),
    /// The four corridor scenarios of Hong (2024), by the paper's method and by the optimal one.
    Corridor(CorridorArgs),
}

/// Options of an experiment of closed-loop runs.
#[derive(Debug, Args)]
#[command(after_help = "Exit code: 0 every limit kept, 1 otherwise, 2 bad input.")]
pub struct RunsArgs {
    /// Seeds of noise and room: 1 to N.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub seeds: u32,
    /// Only runs whose name and seed ("lights out, seed 2") contain this text.
    #[arg(long, value_name = "WORD")]
    pub only: Option<String>,
    /// The robot's settings.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/experiment")]
    pub out: OutputDirArg,
    /// The live page: it shows the runs, and takes no commands.
    #[command(flatten)]
    pub live: ViewArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
}

/// `trundle experiment poses`
#[derive(Debug, Args)]
pub struct PosesArgs {
    /// Drive over a serial line to an emulated Kobuki and a stream of camera frames, by the wall clock: about 15 s a run.
    #[arg(long)]
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
    /// Seeds of noise for each world: 1 to N.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub seeds: u32,
    /// Folder with worlds.csv and obstacles.csv.
    #[arg(long, value_name = "DIR", default_value = "../shared/data/nav/barn")]
    pub data: PathBuf,
    /// The robot's settings.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/barn")]
    pub out: OutputDirArg,
    /// The live page: it shows the runs, and takes no commands.
    #[command(flatten)]
    pub live: ViewArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
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
    /// Seeds of noise for each course: 1 to N.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub seeds: u32,
    /// Folder with start_goal.csv, actors.csv and maps.
    #[arg(long, value_name = "DIR", default_value = "../shared/data/nav/mrpb")]
    pub data: PathBuf,
    /// The robot's settings.
    #[command(flatten)]
    pub robot: RobotArgs,
    /// Folder for the results; the previous run in it is renamed to DIR.1
    #[arg(long, value_name = "DIR", default_value = "out/mrpb")]
    pub out: OutputDirArg,
    /// The live page: it shows the runs, and takes no commands.
    #[command(flatten)]
    pub live: ViewArgs,
    /// Options of every command.
    #[command(flatten)]
    pub common: Common,
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
    /// The live page: it shows the runs, and takes no commands.
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

impl ExperimentArgs {
    /// Options of every command.
    pub fn common(&self) -> &Common {
        match &self.which {
            Which::Poses(args) => &args.runs.common,
            Which::Obstacles(args)
            | Which::Faults(args)
            | Which::People(args)
            | Which::LookAlikes(args)
            | Which::DockingStation(args) => &args.common,
            Which::House(args) => &args.runs.common,
            Which::Barn(args) => &args.common,
            Which::Mrpb(args) => &args.common,
            Which::RealTime(args) => &args.common,
            Which::Corridor(args) => &args.common,
        }
    }
}

/// Runs the requested experiment.
pub fn run(args: &ExperimentArgs) -> Result<Outcome, AppError> {
    match &args.which {
        Which::Poses(args) if args.wires => runs(&args.runs, "poses", poses::run_over_wires),
        Which::Poses(args) => runs(&args.runs, "poses", poses::run),
        Which::Obstacles(args) => runs(args, "obstacles", missions::run_obstacles),
        Which::House(args) => {
            runs(&args.runs, "house", |request, display| missions::run_house(request, &args.mesh, display))
        }
        Which::Faults(args) => runs(args, "faults", fault_scenarios::run),
        Which::People(args) => runs(args, "people", people::run),
        Which::LookAlikes(args) => runs(args, "look-alikes", look_alikes::run),
        Which::DockingStation(args) => runs(args, "docking-station", docking_station::run),
        Which::Barn(args) => run_barn(args),
        Which::Mrpb(args) => run_mrpb(args),
        Which::RealTime(args) => run_real_time(args),
        Which::Corridor(args) => in_folder(&args.out, &args.common, None, |_, _| corridor::run()),
    }
}

/// An experiment of closed-loop runs.
fn runs<R: ExperimentReport>(
    args: &RunsArgs,
    name: &str,
    experiment: impl FnOnce(&RunsRequest, &ExperimentDisplay) -> Result<R, AppError>,
) -> Result<Outcome, AppError> {
    let robot = args.robot.robot()?;
    let page = args.live.of_experiment(name, &robot)?;
    let request = RunsRequest { seeds: args.seeds, only: args.only.clone(), robot };
    in_folder(&args.out, &args.common, page, |_, display| experiment(&request, display))
}

fn run_barn(args: &BarnArgs) -> Result<Outcome, AppError> {
    let request = barn::BarnRequest {
        data: args.data.clone(),
        worlds: args.worlds,
        seeds: args.seeds,
        robot: args.robot.robot_if_given()?,
    };
    let page = args.live.of_experiment("barn", &request.robot())?;
    in_folder(&args.out, &args.common, page, |_, display| barn::run(&request, display))
}

fn run_mrpb(args: &MrpbArgs) -> Result<Outcome, AppError> {
    let request = mrpb::MrpbRequest {
        data: args.data.clone(),
        only: args.only.clone(),
        seeds: args.seeds,
        robot: args.robot.robot_if_given()?,
    };
    let page = args.live.of_experiment("mrpb", &request.robot())?;
    in_folder(&args.out, &args.common, page, |_, display| mrpb::run(&request, display))
}

fn run_real_time(args: &RealTimeArgs) -> Result<Outcome, AppError> {
    let robot = args.robot.robot()?;
    let request = real_time::RealTimeRequest { minutes: args.minutes, seed: args.seed, robot };
    let page = args.live.of_experiment("real-time", &request.robot)?;
    in_folder(&args.out, &args.common, page, |folder, display| real_time::run(&request, folder, display))
}

/// Runs an experiment with its page, writes its folder and prints its table.
fn in_folder<R: ExperimentReport>(
    out: &Path,
    common: &Common,
    page: Option<(LivePage, OperatorLink)>,
    experiment: impl FnOnce(&OutputFolder, &ExperimentDisplay) -> Result<R, AppError>,
) -> Result<Outcome, AppError> {
    let folder = logging::output_folder(out)?;
    let (line, progress) = console::progress(common.quiet);
    let display = match &page {
        Some((_, link)) => ExperimentDisplay::with_stage(progress, link.operator()),
        None => ExperimentDisplay::from(progress),
    };
    let report = experiment(&folder, &display);
    line.finish_and_clear();
    drop(page);
    let report = report?;
    report.write(&folder)?;
    stop::note_in(&folder)?;
    let place = folder.commit()?.join("report.html");
    if !common.quiet {
        let table = report.table();
        console::print_table(&table);
        let gap = if table.is_empty() { "" } else { "\n" };
        console::print(&format!("{gap}{}\nSee {}", report.verdict(), place.display()));
    }
    Ok(if report.is_success() { Outcome::Reached } else { Outcome::Missed })
}
