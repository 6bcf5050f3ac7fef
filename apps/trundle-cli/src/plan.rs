mod args;
mod errand;
mod picture;
mod table;

pub use args::PlanArgs;

use crate::{Outcome, console, failure::Failure, robot_file};
use errand::Errand;
use std::sync::OnceLock;
use std::time::Instant;
use trundle::core::Vector2;
use trundle::io::{OutputFolder, trajectory_csv, waypoints_csv};

/// `trundle plan MAP.yaml --from --goal`.
pub fn run(args: &PlanArgs) -> Result<Outcome, Failure> {
    let robot = robot_file::load(args.config.as_deref())?;
    let mut errand = Errand::read(args, &robot)?;
    errand.planner.set_clock(Some(seconds));
    let start = seconds();
    let tour = errand.plan(&args.map)?;
    let (spent, stages) = (seconds() - start, errand.planner.stage_times());
    let folder = OutputFolder::create(&args.out)?;
    let way_points: Vec<Vector2> =
        tour.legs.iter().flat_map(|leg| leg.way_points.points().iter().copied()).collect();
    folder.write("waypoints.csv", waypoints_csv(&way_points).as_bytes())?;
    folder.write("curve.csv", table::curve_csv(&tour).as_bytes())?;
    folder.write("coefficients.csv", table::coefficients_csv(&tour).as_bytes())?;
    folder.write("constraints.csv", table::constraints_csv(&tour).as_bytes())?;
    folder.write("trajectory.csv", trajectory_csv(&tour.trajectory).as_bytes())?;
    let pictures = picture::draw(&errand, &tour, robot.limits, spent, stages);
    folder.write("plan.png", &pictures.plan)?;
    folder.write("field.png", &pictures.field)?;
    folder.write("corridors.png", &pictures.corridors)?;
    folder.write("plan.html", pictures.page.as_bytes())?;
    let summary = table::summary(args, &errand, &tour, spent, stages);
    folder.write("summary.json", summary.to_json().as_bytes())?;
    let place = folder.commit()?;
    if args.coefficients {
        table::print_curves(&tour);
    }
    if !args.common.quiet {
        table::notes(&errand, &tour).iter().for_each(|note| console::say(note));
        console::table(&table::rows(&tour, spent, stages));
        console::say(&format!("See {}", place.join("plan.html").display()));
    }
    Ok(Outcome::Reached)
}

/// The wall clock, s.
fn seconds() -> f64 {
    static BEGIN: OnceLock<Instant> = OnceLock::new();
    BEGIN.get_or_init(Instant::now).elapsed().as_secs_f64()
}
