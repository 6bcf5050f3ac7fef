//! `trundle dock`: a manoeuvre of turns and straight moves onto a goal pose in a tight place.

mod args;
mod picture;
mod table;

use crate::{Outcome, console, failure::Failure, robot_file};
pub use args::DockArgs;
pub(crate) use picture::{Surroundings, manoeuvre_picture};
use std::path::Path;
use std::time::Instant;
pub(crate) use table::{motions, steps_csv};
use trundle::core::{Footprint, OccupancyGrid, Pose2};
use trundle::docking::corridor::{Problem, parse};
use trundle::docking::{Certificate, Docker, DockingConfig, Impossible, Plan, Scene, Solution};
use trundle::io::{OutputFolder, Summary, read_map};

/// What is to be planned, and what stands around.
struct Task {
    name: String,
    footprint: Footprint,
    start: Pose2,
    goal: Pose2,
    scene: Scene,
    grid: Option<OccupancyGrid>,
    problem: Option<Problem>,
}

/// `trundle dock MAP.yaml --from --to`, or `trundle dock PROBLEM.txt`.
pub fn run(args: &DockArgs) -> Result<Outcome, Failure> {
    let task = if is_map(&args.place) { on_map(args)? } else { of_problem(args)? };
    let docker = Docker::new(DockingConfig { method: args.method.into(), ..DockingConfig::default() })?;
    let clock = Instant::now();
    let plan = docker
        .plan(&task.footprint, &task.scene, task.start, task.goal)
        .map_err(|refusal| Failure::Input(format!("{}: {refusal}", args.place.display())))?;
    let seconds = clock.elapsed().as_secs_f64();
    let folder = OutputFolder::create(&args.out)?;
    let surroundings = Surroundings { grid: task.grid.as_ref(), problem: task.problem.as_ref() };
    let found = match &plan {
        Plan::Found(found) => Some(found),
        Plan::Impossible(_) => None,
    };
    if let Some(found) = found {
        folder.write("steps.csv", steps_csv(&found.manoeuvre).as_bytes())?;
    }
    let picture = manoeuvre_picture(surroundings, &task.footprint, (task.start, task.goal), found);
    folder.write("dock.png", &picture)?;
    folder.write("summary.json", summary(&task, &plan, seconds).to_json().as_bytes())?;
    let place = folder.commit()?;
    if !args.common.quiet {
        tell(&plan, seconds);
        console::say(&format!("See {}", place.join("dock.png").display()));
    }
    Ok(if found.is_some() { Outcome::Reached } else { Outcome::Missed })
}

fn is_map(place: &Path) -> bool {
    place.extension().is_some_and(|e| e.eq_ignore_ascii_case("yaml") || e.eq_ignore_ascii_case("yml"))
}

fn on_map(args: &DockArgs) -> Result<Task, Failure> {
    let grid = read_map(&args.place)?;
    let (Some(start), Some(goal)) = (args.from, args.to) else {
        return Err(Failure::Input(format!("{}: a map needs --from and --to", args.place.display())));
    };
    let (start, goal) = (start.0, goal.0);
    let footprint = match &args.footprint {
        Some(footprint) => footprint.0.clone(),
        None => robot_file::load(args.config.as_deref())?.footprint()?,
    };
    let config = DockingConfig::default();
    let half = start.distance(&goal) / 2.0 + config.reach + 2.0 * footprint.circumscribed_radius();
    let center = (start.position() + goal.position()) / 2.0;
    let scene = Scene::from_grid(&grid, center, half, !args.through_unknown);
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

fn of_problem(args: &DockArgs) -> Result<Task, Failure> {
    let named =
        |problem: &dyn std::fmt::Display| Failure::Input(format!("{}: {problem}", args.place.display()));
    let text =
        std::fs::read_to_string(&args.place).map_err(|error| named(&format!("cannot read it: {error}")))?;
    let problems = parse(&text).map_err(|invalid| named(&invalid))?;
    let chosen = match &args.problem {
        Some(name) => problems.into_iter().find(|problem| problem.name == *name),
        None => problems.into_iter().next(),
    };
    let problem = chosen.ok_or_else(|| match &args.problem {
        Some(name) => named(&format!("it has no problem '{name}'")),
        None => named(&"it has no problem"),
    })?;
    let footprint =
        args.footprint.as_ref().map_or_else(|| problem.footprint.clone(), |given| given.0.clone());
    Ok(Task {
        name: problem.name.clone(),
        footprint,
        start: args.from.map_or(problem.start, |pose| pose.0),
        goal: args.to.map_or(problem.goal, |pose| pose.0),
        scene: problem.scene().map_err(|invalid| named(&invalid))?,
        grid: None,
        problem: Some(problem),
    })
}

fn tell(plan: &Plan, seconds: f64) {
    match plan {
        Plan::Found(found) => {
            console::table(&table::rows(&found.manoeuvre));
            console::say(&format!("\n{}; planned in {:.1} ms.", table::verdict(found), seconds * 1e3));
        }
        Plan::Impossible(impossible) => console::say(&reason(impossible)),
    }
}

/// Why there is no manoeuvre, in one sentence.
fn reason(impossible: &Impossible) -> String {
    let by = impossible.by.as_ref().map_or_else(String::new, |by| {
        format!(": obstacle {} at ({:.3}, {:.3}) m is in the way", by.obstacle, by.at.x, by.at.y)
    });
    let proof = match impossible.certificate {
        Certificate::Never => "proven for motions of any kind",
        Certificate::AtResolution => "proven at the search's resolution",
        Certificate::None => "none was found; not proven",
    };
    format!("No manoeuvre{by} ({proof}).")
}

fn summary(task: &Task, plan: &Plan, seconds: f64) -> Summary {
    let mut summary = Summary::new("dock");
    summary.set("task", &task.name).set("from", task.start).set("to", task.goal);
    match plan {
        Plan::Found(Solution { manoeuvre, bound, margin }) => summary
            .set("success", true)
            .set("motions", motions(manoeuvre))
            .set("duration_s", manoeuvre.duration())
            .set("bound_s", *bound)
            .set("margin_m", *margin),
        Plan::Impossible(impossible) => {
            let proven = impossible.certificate != Certificate::None;
            summary.set("success", false).set("proven", proven).set("reason", reason(impossible))
        }
    };
    summary.set("wall_clock", serde_json::json!({ "planning_s": seconds }));
    summary
}
