//! `trundle dock`: a manoeuvre of turns and straight moves onto a goal pose in a tight place.

mod args;

use crate::{Outcome, console};
pub use args::DockArgs;
use std::path::Path;
use std::time::Instant;
use trundle::app::AppError;
use trundle::app::dock::{
    DockingObstacles, manoeuvre_picture, motions, rows, step_pictures, steps_csv, verdict,
};
use trundle::core::{Footprint, OccupancyGrid, Pose2};
use trundle::docking::corridor::{Problem, Scenario, parse, write};
use trundle::docking::{
    Certificate, DockingConfig, DockingPlan, DockingPlanner, Impossible, Obstacle, ObstacleScene,
    SearchLimit, Solution,
};
use trundle::io::{LaserLogOptions, OutputFolder, Summary, read_carmen, read_map};
use trundle::viz::tiles;

/// What is to be planned, and what stands around.
struct Task {
    name: String,
    footprint: Footprint,
    start: Pose2,
    goal: Pose2,
    scene: ObstacleScene,
    grid: Option<OccupancyGrid>,
    problem: Option<Problem>,
}

/// Where the obstacles come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Map,
    Log,
    BuiltIn,
    File,
}

impl Source {
    fn of(args: &DockArgs) -> Self {
        let ending = args.place.extension().unwrap_or_default();
        let is_a = |endings: &[&str]| endings.iter().any(|known| ending.eq_ignore_ascii_case(known));
        if is_a(&["yaml", "yml"]) {
            Self::Map
        } else if is_a(&["log"]) {
            Self::Log
        } else if !args.place.exists() && built_in(&args.place).is_some() {
            Self::BuiltIn
        } else {
            Self::File
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Map => "a map",
            Self::Log => "a laser log",
            Self::BuiltIn => "a built-in problem",
            Self::File => "a file of problems",
        }
    }

    /// Refuses options that mean nothing here.
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
    let task = match Source::of(args).checked(args)? {
        Source::Map => on_map(args)?,
        Source::Log => task_of(args, in_scan(args)?)?,
        Source::BuiltIn | Source::File => task_of(args, of_file(args)?)?,
    };
    if let Some(file) = &args.write_problem {
        return write_problem(args, task, file);
    }
    let docker = DockingPlanner::new(planner(args)?)?;
    let clock = Instant::now();
    let plan = docker
        .plan(&task.footprint, &task.scene, task.start, task.goal)
        .map_err(|refusal| AppError::Input(format!("{}: {refusal}", args.place.display())))?;
    let seconds = clock.elapsed().as_secs_f64();
    let folder = OutputFolder::create(&args.out)?.instead_of(&["steps.csv", "steps.png"]);
    let surroundings = DockingObstacles { grid: task.grid.as_ref(), problem: task.problem.as_ref() };
    let found = match &plan {
        DockingPlan::Found(found) => Some(found),
        DockingPlan::Impossible(_) => None,
    };
    let in_the_way = match &plan {
        DockingPlan::Impossible(impossible) => impossible.by.map(|by| by.at),
        DockingPlan::Found(_) => None,
    };
    let ends = (task.start, task.goal);
    if let Some(found) = found.filter(|found| !found.manoeuvre.steps().is_empty()) {
        folder.write("steps.csv", steps_csv(&found.manoeuvre).as_bytes())?;
        let steps = step_pictures(surroundings, &task.footprint, ends, found);
        folder.write("steps.png", &tiles(&steps, columns(steps.len())))?;
    }
    let picture = manoeuvre_picture(surroundings, &task.footprint, ends, found, in_the_way);
    folder.write("dock.png", &picture.to_png())?;
    folder.write("summary.json", summary(&task, &plan, seconds).to_json().as_bytes())?;
    let place = folder.commit()?;
    if !args.common.quiet {
        tell(&plan, seconds);
        console::print(&format!("See {}", place.join("dock.png").display()));
    }
    Ok(if found.is_some() { Outcome::Reached } else { Outcome::Missed })
}

/// Four motions a row; of more than 16 about as many as there are rows.
fn columns(motions: usize) -> usize {
    motions.isqrt().max(4)
}

/// The robot file's `[docking.planner]`, where one is given, else the planner's own defaults; method and margin as asked for.
fn planner(args: &DockArgs) -> Result<DockingConfig, AppError> {
    let config =
        args.robot.robot_if_given()?.map_or_else(DockingConfig::default, |robot| robot.docking.planner);
    let method = args.method.map_or(config.method, Into::into);
    Ok(DockingConfig { method, margin: args.margin.unwrap_or(config.margin), ..config })
}

/// Writes what would be solved to a file of its own.
fn write_problem(args: &DockArgs, task: Task, file: &Path) -> Result<Outcome, AppError> {
    let Task { name, footprint, start, goal, .. } = task;
    let obstacles = match task.problem {
        Some(problem) => problem.obstacles,
        None => task.scene.pieces().iter().map(|p| Obstacle::Segment(p.segment.a, p.segment.b)).collect(),
    };
    let text = write(&[Problem { name, footprint, start, goal, obstacles }]);
    std::fs::write(file, text)
        .map_err(|error| AppError::Input(format!("{}: cannot write it: {error}", file.display())))?;
    if !args.common.quiet {
        console::print(&format!("See {}", file.display()));
    }
    Ok(Outcome::Reached)
}

fn on_map(args: &DockArgs) -> Result<Task, AppError> {
    let grid = read_map(&args.place)?;
    let (Some(start), Some(goal)) = (args.from, args.to) else {
        return Err(AppError::Input(format!("{}: a map needs --from and --to", args.place.display())));
    };
    let (start, goal) = (start.0, goal.0);
    for (name, pose) in [("start", start), ("goal", goal)] {
        if grid.geometry().cell_at(pose.position()).is_none() {
            let (file, Pose2 { x, y, .. }) = (args.place.display(), pose);
            return Err(AppError::Input(format!("{file}: the {name} ({x:.2}, {y:.2}) m is off the map")));
        }
    }
    let footprint = footprint(args)?;
    let config = planner(args)?;
    let (center, half) = config.view(&footprint, &start, &goal);
    let scene = ObstacleScene::from_grid(&grid, center, half, !args.through_unknown);
    Ok(Task {
        name: args.place.display().to_string(),
        footprint,
        start,
        goal,
        scene,
        grid: Some(grid),
        problem: None,
    })
}

/// The outline that was asked for, else the robot file's.
fn footprint(args: &DockArgs) -> Result<Footprint, AppError> {
    match &args.footprint {
        Some(footprint) => Ok(footprint.0.clone()),
        None => Ok(args.robot.robot()?.footprint()?),
    }
}

fn named(args: &DockArgs, problem: &dyn std::fmt::Display) -> AppError {
    AppError::Input(format!("{}: {problem}", args.place.display()))
}

/// Among the points of a scan, in the frame of the robot that made it.
fn in_scan(args: &DockArgs) -> Result<Problem, AppError> {
    let log = read_carmen(&args.place, &LaserLogOptions::default())?;
    let count = log.scans.len();
    let number = args.scan.map_or(count, |number| number as usize);
    let scan = number.checked_sub(1).and_then(|i| log.scans.get(i));
    let scan = scan.ok_or_else(|| named(args, &format!("it has no scan {number}, only 1 to {count}")))?;
    let goal = args.to.ok_or_else(|| named(args, &"a scan needs --to"))?.0;
    Ok(Problem {
        name: format!("scan-{number}"),
        footprint: footprint(args)?,
        start: Pose2::default(),
        goal,
        obstacles: scan.scan.hits().map(Obstacle::Point).collect(),
    })
}

fn built_in(place: &Path) -> Option<Problem> {
    Scenario::ALL.map(Scenario::problem).into_iter().find(|problem| place == Path::new(&problem.name))
}

fn of_file(args: &DockArgs) -> Result<Problem, AppError> {
    let named = |problem: &dyn std::fmt::Display| named(args, problem);
    if let Some(problem) = built_in(&args.place).filter(|_| !args.place.exists()) {
        return Ok(problem);
    }
    let text =
        std::fs::read_to_string(&args.place).map_err(|error| named(&format!("cannot read it: {error}")))?;
    let problems = parse(&text).map_err(|invalid| named(&invalid))?;
    let chosen = match &args.problem {
        Some(name) => problems.into_iter().find(|problem| problem.name == *name),
        None => problems.into_iter().next(),
    };
    chosen.ok_or_else(|| match &args.problem {
        Some(name) => named(&format!("it has no problem '{name}'")),
        None => named(&"it has no problem"),
    })
}

fn task_of(args: &DockArgs, problem: Problem) -> Result<Task, AppError> {
    let footprint =
        args.footprint.as_ref().map_or_else(|| problem.footprint.clone(), |given| given.0.clone());
    Ok(Task {
        name: problem.name.clone(),
        footprint,
        start: args.from.map_or(problem.start, |pose| pose.0),
        goal: args.to.map_or(problem.goal, |pose| pose.0),
        scene: problem.scene().map_err(|invalid| named(args, &invalid))?,
        grid: None,
        problem: Some(problem),
    })
}

fn tell(plan: &DockingPlan, seconds: f64) {
    match plan {
        DockingPlan::Found(found) if found.manoeuvre.steps().is_empty() => {
            console::print("Already there: nothing to do.");
        }
        DockingPlan::Found(found) => {
            console::print_table(&rows(&found.manoeuvre));
            console::print(&format!("\n{}; planned in {:.1} ms.", verdict(found), seconds * 1e3));
        }
        DockingPlan::Impossible(impossible) => console::print(&reason(impossible)),
    }
}

/// Why there is no manoeuvre, in one sentence.
fn reason(impossible: &Impossible) -> String {
    let by = impossible.by.as_ref().map_or_else(String::new, |by| format!(": {by} is in the way"));
    let ended = |limit: SearchLimit| {
        format!("the search ended at docking.planner.{}, more of it searches longer", limit.setting())
    };
    let proof = match (impossible.certificate, impossible.limit) {
        (Certificate::Never, None) => "proven for motions of any kind".to_owned(),
        (Certificate::Never, Some(limit)) => {
            format!("proven for motions of any kind; farther off none was found: {}", ended(limit))
        }
        (Certificate::AtResolution, _) => {
            "a complete search in steps of docking.planner.position_tolerance found no way through; a way that is narrower than such a step is \
             not ruled out".to_owned()
        }
        (Certificate::None, None) => "none was found, which is no proof".to_owned(),
        (Certificate::None, Some(limit)) => format!("none was found, which is no proof: {}", ended(limit)),
    };
    format!("No manoeuvre within {:.1} m{by} ({proof}).", impossible.within)
}

fn summary(task: &Task, plan: &DockingPlan, seconds: f64) -> Summary {
    let mut summary = Summary::new("dock");
    summary.set("task", &task.name).set("from", task.start).set("to", task.goal);
    match plan {
        DockingPlan::Found(Solution { manoeuvre, bound, margin }) => summary
            .set("success", true)
            .set("motions", motions(manoeuvre))
            .set("duration_s", manoeuvre.duration())
            .set("bound_s", *bound)
            .set("margin_m", *margin),
        DockingPlan::Impossible(impossible) => {
            let proven = impossible.certificate != Certificate::None;
            summary.set("success", false).set("proven", proven).set("reason", reason(impossible))
        }
    };
    summary.set("wall_clock", serde_json::json!({ "planning_s": seconds }));
    summary
}
