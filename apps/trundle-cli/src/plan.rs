mod args;
mod errand;
mod picture;
mod table;

pub use args::PlanArgs;

use crate::{Outcome, console};
use errand::{Errand, Refusal};
use std::sync::OnceLock;
use std::time::Instant;
use trundle::app::AppError;
use trundle::core::{DriveLimits, Vector2};
use trundle::io::{OutputFolder, trajectory_csv, waypoints_csv};
use trundle::planning::{MultiGoalPlan, PlanningTimes};

/// Everything that a plan may write: what an earlier one left behind is removed.
const FILES: [&str; 10] = [
    "waypoints.csv",
    "curve.csv",
    "coefficients.csv",
    "constraints.csv",
    "trajectory.csv",
    "plan.png",
    "field.png",
    "corridors.png",
    "plan.html",
    "summary.json",
];

/// `trundle plan MAP.yaml --from --goal`.
pub fn run(args: &PlanArgs) -> Result<Outcome, AppError> {
    let robot = args.robot.robot()?;
    let mut errand = Errand::read(args, &robot)?;
    errand.planner.set_clock(Some(seconds));
    let start = seconds();
    let tour = errand.plan();
    let spent = Spent { all: seconds() - start, stages: errand.planner.stage_times() };
    let folder = OutputFolder::create(&args.out)?.instead_of(&FILES);
    match tour {
        Ok(tour) => write_tour(args, &mut errand, &tour, robot.limits, spent, folder),
        Err(refusal) => write_refusal(args, &mut errand, &refusal, folder),
    }
}

fn write_tour(
    args: &PlanArgs,
    errand: &mut Errand,
    tour: &MultiGoalPlan,
    limits: DriveLimits,
    spent: Spent,
    folder: OutputFolder,
) -> Result<Outcome, AppError> {
    let moved = errand.goals_moved(tour);
    let way_points: Vec<Vector2> =
        tour.legs.iter().flat_map(|leg| leg.waypoints.points().iter().copied()).collect();
    folder.write("waypoints.csv", waypoints_csv(&way_points).as_bytes())?;
    folder.write("curve.csv", table::curve_csv(tour).as_bytes())?;
    folder.write("coefficients.csv", table::coefficients_csv(tour).as_bytes())?;
    folder.write("constraints.csv", table::constraints_csv(tour).as_bytes())?;
    folder.write("trajectory.csv", trajectory_csv(&tour.trajectory).as_bytes())?;
    let pictures = picture::draw(errand, tour, limits, &moved, spent);
    folder.write("plan.png", &pictures.plan)?;
    folder.write("field.png", &pictures.field)?;
    folder.write("corridors.png", &pictures.corridors)?;
    folder.write("plan.html", pictures.page.as_bytes())?;
    folder.write("summary.json", table::summary(args, errand, tour, &moved, spent).to_json().as_bytes())?;
    let place = folder.commit()?;
    if args.coefficients {
        table::print_curves(tour);
    }
    if !args.common.quiet {
        moved.iter().for_each(|moved| console::print(&moved.note()));
        console::print_table(&table::rows(tour, spent));
        console::print(&format!("See {}", place.join("plan.html").display()));
    }
    Ok(Outcome::Reached)
}

/// Says why there is no plan, and writes that and a picture of it.
fn write_refusal(
    args: &PlanArgs,
    errand: &mut Errand,
    refusal: &Refusal,
    folder: OutputFolder,
) -> Result<Outcome, AppError> {
    let why = errand.explain(refusal);
    folder.write("plan.png", &picture::without_plan(errand, refusal))?;
    folder.write("summary.json", table::no_summary(args, errand, refusal, &why).to_json().as_bytes())?;
    folder.commit()?;
    console::print_error(&AppError::Input(format!("{}: {why}", args.map.display())));
    Ok(Outcome::Missed)
}

/// Time that planning took, s.
#[derive(Debug, Clone, Copy)]
struct Spent {
    all: f64,
    stages: PlanningTimes,
}

/// The wall clock, s.
fn seconds() -> f64 {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
}
