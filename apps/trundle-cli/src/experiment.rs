//! `trundle experiment`: the papers' experiments as commands; exit code 1 if a limit is missed.

mod args;
mod shards;

pub use args::ExperimentArgs;

use self::args::{BarnArgs, Experiment, MrpbArgs, RealTimeArgs, RunsArgs, SeriesArgs};
use crate::common_args::Common;
use crate::outcome::Outcome;
use crate::{console, logging};
use std::path::Path;
use std::sync::Arc;
use trundle::app::operator::OperatorLink;
use trundle::app::{AppError, stop};
use trundle::experiments::{
    ExperimentContext, ExperimentDisplay, ExperimentReport, KeptRuns, RobotExperiment, RunOrigin,
    RunsRequest, barn, corridor, docking_station, fault_scenarios, known_map, look_alikes, missions, mrpb,
    people, poses, real_time,
};
use trundle::io::OutputFolder;
use trundle::live::LivePage;
use trundle::runtime::RobotConfig;

/// Runs the requested experiment, or merges its shards.
pub fn run(args: &ExperimentArgs) -> Result<Outcome, AppError> {
    match &args.which {
        Experiment::Merge(merge) => {
            let kept = KeptRuns::read(&merge.folders)?;
            let which = shards::experiment_of(kept.manifest(), merge)?;
            run_from(&which, &RunOrigin::Kept(Arc::new(kept)))
        }
        which => run_from(which, &shards::origin_of(which.series())?),
    }
}

fn run_from(which: &Experiment, origin: &RunOrigin) -> Result<Outcome, AppError> {
    match which {
        Experiment::Poses(args) if args.wires => runs(&args.runs, "poses", origin, poses::run_over_wires),
        Experiment::Poses(args) => runs(&args.runs, "poses", origin, poses::run),
        Experiment::Obstacles(args) => runs(args, "obstacles", origin, missions::run_obstacles),
        Experiment::House(args) => runs(&args.runs, "house", origin, |request, context| {
            missions::run_house(request, &args.mesh, context)
        }),
        Experiment::Faults(args) => runs(args, "faults", origin, fault_scenarios::run),
        Experiment::People(args) => runs(args, "people", origin, people::run),
        Experiment::LookAlikes(args) => runs(args, "look-alikes", origin, look_alikes::run),
        Experiment::DockingStation(args) => runs(args, "docking-station", origin, docking_station::run),
        Experiment::Barn(BarnArgs { data, worlds, series, out }) => {
            own_robot((series, out), origin, |robot| {
                barn::BarnRequest::new(data.clone(), *worlds, series.seeds, robot)
            })
        }
        Experiment::Mrpb(MrpbArgs { data, only, series, out }) => own_robot((series, out), origin, |robot| {
            mrpb::MrpbRequest::new(data.clone(), only.clone(), series.seeds, robot)
        }),
        Experiment::KnownMap(RunsArgs { only, series, out }) => own_robot((series, out), origin, |robot| {
            known_map::KnownMapRequest::new(series.seeds, only.clone(), robot)
        }),
        Experiment::RealTime(args) => run_real_time(args, origin),
        Experiment::Corridor(a) => in_folder(&a.out, &a.common, None, origin, |_, _| corridor::run()),
        Experiment::Merge(_) => Err(AppError::input("a merge of merges, expected shards of runs")),
    }
}

/// An experiment of closed-loop runs.
fn runs<R: ExperimentReport>(
    args: &RunsArgs,
    name: &str,
    origin: &RunOrigin,
    experiment: impl FnOnce(&RunsRequest, &ExperimentContext) -> Result<R, AppError>,
) -> Result<Outcome, AppError> {
    let robot = origin.robot(|| args.series.robot.robot_if_given())?.unwrap_or_default();
    let page = args.series.live.of_experiment(name, &robot)?;
    let request = RunsRequest { seeds: args.series.seeds, only: args.only.clone(), robot };
    in_folder(&args.out, &args.series.common, page, origin, |_, context| experiment(&request, context))
}

/// An experiment with a robot of its own.
fn own_robot<E: RobotExperiment>(
    (series, out): (&SeriesArgs, &Path),
    origin: &RunOrigin,
    request: impl FnOnce(Option<RobotConfig>) -> E,
) -> Result<Outcome, AppError> {
    let request = request(origin.robot(|| series.robot.robot_if_given())?);
    let page = series.live.of_experiment(E::NAME, &request.robot())?;
    in_folder(out, &series.common, page, origin, |_, context| request.run(context))
}

fn run_real_time(args: &RealTimeArgs, origin: &RunOrigin) -> Result<Outcome, AppError> {
    let robot = args.robot.robot()?;
    let request = real_time::RealTimeRequest { minutes: args.minutes, seed: args.seed, robot };
    let page = args.live.of_experiment("real-time", &request.robot)?;
    in_folder(&args.out, &args.common, page, origin, |folder, context| {
        real_time::run(&request, folder, context)
    })
}

/// Runs an experiment with its page, writes its folder and prints its table.
fn in_folder<R: ExperimentReport>(
    out: &Path,
    common: &Common,
    page: Option<(LivePage, OperatorLink)>,
    origin: &RunOrigin,
    experiment: impl FnOnce(&OutputFolder, &ExperimentContext) -> Result<R, AppError>,
) -> Result<Outcome, AppError> {
    let folder = logging::output_folder(out)?;
    let (line, progress) = console::progress(common.quiet);
    let display = match &page {
        Some((_, link)) => ExperimentDisplay::with_stage(progress, link.operator()),
        None => ExperimentDisplay::from(progress),
    };
    let context = ExperimentContext { display, runs: origin.in_folder(&folder)? };
    let report = experiment(&folder, &context);
    line.finish_and_clear();
    drop(page);
    let report = report?;
    report.write(&folder)?;
    stop::note_in(&folder)?;
    let place = folder.commit()?;
    if !common.quiet {
        let table = report.table();
        console::print_table(&table);
        let gap = if table.is_empty() { "" } else { "\n" };
        console::print(&format!("{gap}{}", report.verdict()));
        console::print_see(&place.join("report.html"));
    }
    let dead = context.runs.dead();
    dead.iter().for_each(console::print_error);
    Ok(if report.is_success() && dead.is_none() { Outcome::Reached } else { Outcome::Missed })
}
