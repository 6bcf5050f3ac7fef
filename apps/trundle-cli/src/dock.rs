//! `trundle dock`: a manoeuvre of turns and straight moves onto a goal pose in a tight place.

mod args;

pub use args::DockArgs;

use crate::console;
use crate::logging;
use crate::outcome::Outcome;
use crate::output_args;
use std::path::Path;
use std::time::Instant;
use trundle::app::AppError;
use trundle::app::dock::{
    DockingTask, ScanProblem, built_in_problem, file_problem, impossible_text, rows, scan_problem, verdict,
    write_docking,
};
use trundle::core::Footprint;
use trundle::docking::corridor::Problem;
use trundle::docking::{DockingConfig, DockingPlan, DockingPlanner};
use trundle::io::{Expected, FileKind};

/// Where the obstacles come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Map,
    Log,
    BuiltIn,
    File,
}

impl Source {
    fn of(args: &DockArgs) -> Result<Self, AppError> {
        if !args.place.exists() && built_in_problem(&args.place).is_some() {
            return Ok(Self::BuiltIn);
        }
        Ok(match Expected::Docking.check(&args.place)? {
            FileKind::MapYaml => Self::Map,
            FileKind::CarmenLog | FileKind::Gzip => Self::Log,
            _ => Self::File,
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Map => "a map",
            Self::Log => "a laser log",
            Self::BuiltIn => "a built-in problem",
            Self::File => "a file of problems",
        }
    }

    /// Refuses options of another kind of input.
    fn checked(self, args: &DockArgs) -> Result<Self, AppError> {
        let options = [
            ("--scan", args.scan.is_some(), Self::Log),
            ("--problem", args.problem.is_some(), Self::File),
            ("--through-unknown", args.through_unknown, Self::Map),
        ];
        match options.into_iter().find(|&(_, is_given, place)| is_given && place != self) {
            Some((option, _, place)) => {
                Err(named(args, &format!("{option} goes with {}, this is {}", place.name(), self.name())))
            }
            None => Ok(self),
        }
    }
}

/// `trundle dock MAP.yaml --from --to`, `trundle dock SCANS.log --to`, `trundle dock PROBLEM.txt`, or a built-in problem by name.
pub fn run(args: &DockArgs) -> Result<Outcome, AppError> {
    let task = match Source::of(args)?.checked(args)? {
        Source::Map => on_map(args)?,
        Source::Log => match in_scan(args)? {
            ScanProblem { refusal: Some(refusal), .. } => {
                return Ok(Outcome::unless(Some(format!("{}: {refusal}", args.place.display()))));
            }
            scan => of_problem(args, scan.problem)?,
        },
        Source::BuiltIn | Source::File => of_problem(args, listed(args)?)?,
    };
    if let Some(file) = &args.write_problem {
        return write_problem(args, &task, file);
    }
    let planner = DockingPlanner::new(planner_config(args)?)?;
    let clock = Instant::now();
    let plan = planner
        .plan(&task.footprint, &task.scene, task.start, task.goal)
        .map_err(|refusal| named(args, &refusal))?;
    let seconds = clock.elapsed().as_secs_f64();
    let folder = logging::output_folder(&args.out)?;
    let place = write_docking(&task, &plan, seconds, folder)?;
    if !args.common.quiet {
        print_plan(&plan, seconds);
        console::print(&format!("See {}", place.join("dock.png").display()));
    }
    Ok(if matches!(plan, DockingPlan::Found(_)) { Outcome::Reached } else { Outcome::Missed })
}

/// The robot file's `[docking.planner]`, where one is given, else the planner's own defaults; method and margin as asked for.
fn planner_config(args: &DockArgs) -> Result<DockingConfig, AppError> {
    let config =
        args.robot.robot_if_given()?.map_or_else(DockingConfig::default, |robot| robot.docking.planner);
    let method = args.method.map_or(config.method, Into::into);
    Ok(DockingConfig { method, margin: args.margin.unwrap_or(config.margin), ..config })
}

/// Writes the task to a file of problems.
fn write_problem(args: &DockArgs, task: &DockingTask, file: &Path) -> Result<Outcome, AppError> {
    output_args::write_file(file, task.to_text().as_bytes())?;
    if !args.common.quiet {
        console::print(&format!("See {}", file.display()));
    }
    Ok(Outcome::Reached)
}

fn on_map(args: &DockArgs) -> Result<DockingTask, AppError> {
    let (Some(start), Some(goal)) = (args.from, args.to) else {
        return Err(named(args, &"a map needs --from and --to"));
    };
    let (footprint, config) = (footprint(args)?, planner_config(args)?);
    DockingTask::on_map(&args.place, footprint, (start.0, goal.0), &config, args.through_unknown)
}

/// The outline that was asked for, else the robot file's.
fn footprint(args: &DockArgs) -> Result<Footprint, AppError> {
    match &args.footprint {
        Some(footprint) => Ok(footprint.clone()),
        None => Ok(args.robot.robot()?.footprint()?),
    }
}

fn named(args: &DockArgs, problem: &dyn std::fmt::Display) -> AppError {
    AppError::Input(format!("{}: {problem}", args.place.display()))
}

/// Among the points of a scan, in the frame of the robot that made it.
fn in_scan(args: &DockArgs) -> Result<ScanProblem, AppError> {
    let goal = args.to.ok_or_else(|| named(args, &"a scan needs --to"))?.0;
    scan_problem(&args.place, args.scan.map(|number| number as usize), footprint(args)?, goal)
}

/// A built-in problem, else one of a file.
fn listed(args: &DockArgs) -> Result<Problem, AppError> {
    match built_in_problem(&args.place).filter(|_| !args.place.exists()) {
        Some(problem) => Ok(problem),
        None => file_problem(&args.place, args.problem.as_deref()),
    }
}

/// The problem with footprint, start and goal as asked for.
fn of_problem(args: &DockArgs, problem: Problem) -> Result<DockingTask, AppError> {
    let task = DockingTask::of_problem(problem).map_err(|invalid| named(args, &invalid))?;
    Ok(DockingTask {
        footprint: args.footprint.as_ref().map_or(task.footprint, |asked| asked.clone()),
        start: args.from.map_or(task.start, |from| from.0),
        goal: args.to.map_or(task.goal, |to| to.0),
        ..task
    })
}

fn print_plan(plan: &DockingPlan, seconds: f64) {
    match plan {
        DockingPlan::Found(found) if found.manoeuvre.steps().is_empty() => {
            console::print("Already there: nothing to do.");
        }
        DockingPlan::Found(found) => {
            console::print_table(&rows(&found.manoeuvre));
            console::print(&format!("\n{}; planned in {:.1} ms.", verdict(found), seconds * 1e3));
        }
        DockingPlan::Impossible(impossible) => console::print(&impossible_text(impossible)),
    }
}
