use crate::{Outcome, args::PlanArgs, console, failure::Failure, robot_file};
use std::time::Instant;
use trundle::core::{Footprint, Twist2, Vector2};
use trundle::io::{OutputFolder, Summary, read_map, table_csv, trajectory_csv, waypoints_csv};
use trundle::planning::{Curve, Plan, PlanResult, Planner, PlannerConfig};
use trundle::viz::{PlanScene, plan_picture};

/// Distance of two points of the curve in `curve.csv` and in the picture, m.
const SPACING: f64 = 0.02;

/// `trundle plan MAP.yaml --from --to`.
pub fn run(args: &PlanArgs) -> Result<Outcome, Failure> {
    let robot = robot_file::load(args.config.as_deref())?;
    let grid = read_map(&args.map)?;
    let footprint = robot.footprint()?;
    // A map is given: what lies beyond it is no way.
    let config = PlannerConfig { beyond: 0.0, ..robot.planning };
    let mut planner = Planner::new(config, &footprint, robot.limits, robot.drive)?;
    let start = Instant::now();
    let plan = planner.plan(&grid, args.from.0, Twist2::ZERO, args.to.0);
    let seconds = start.elapsed().as_secs_f64();
    let found = found(plan, args)?;
    let folder = OutputFolder::create(&args.out)?;
    let curve: Vec<Vector2> = found
        .curves()
        .flat_map(|curve| curve.samples(SPACING))
        .map(|sample| sample.pose.position())
        .collect();
    folder.write("waypoints.csv", waypoints_csv(found.way_points.points()).as_bytes())?;
    folder.write("curve.csv", curve_csv(&found).as_bytes())?;
    folder.write("coefficients.csv", coefficients_csv(&found).as_bytes())?;
    folder.write("trajectory.csv", trajectory_csv(&found.trajectory).as_bytes())?;
    folder.write("plan.png", &picture(args, &grid, &found, &curve, &footprint))?;
    folder.write("summary.json", summary(args, &found, seconds).to_json().as_bytes())?;
    let place = folder.commit()?;
    if !args.common.quiet {
        console::table(&rows(&found, seconds));
        console::say(&format!("See {}", place.join("plan.png").display()));
    }
    Ok(Outcome::Reached)
}

/// The plan, or in one sentence why there is none.
fn found(plan: Plan, args: &PlanArgs) -> Result<Box<PlanResult>, Failure> {
    match plan {
        Plan::Found(found) => Ok(found),
        refused => Err(Failure::Input(format!(
            "{}: from ({}, {}) m to ({}, {}) m: {refused}",
            args.map.display(),
            args.from.0.x,
            args.from.0.y,
            args.to.0.x,
            args.to.0.y
        ))),
    }
}

fn picture(
    args: &PlanArgs,
    grid: &trundle::core::OccupancyGrid,
    found: &PlanResult,
    curve: &[Vector2],
    footprint: &Footprint,
) -> Vec<u8> {
    plan_picture(&PlanScene {
        grid,
        start: args.from.0,
        goal: args.to.0,
        route: found.raw.points(),
        way_points: found.way_points.points(),
        curve,
        footprint,
    })
}

/// Points along the curves: piece of the plan, way along it, pose, curvature.
fn curve_csv(found: &PlanResult) -> String {
    let points = found.curves().enumerate().flat_map(|(i, curve)| {
        curve
            .samples(SPACING)
            .into_iter()
            .map(move |p| [i as f64, p.arc, p.pose.x, p.pose.y, p.pose.theta, p.curvature])
    });
    table_csv(["curve", "s_m", "x_m", "y_m", "theta_rad", "curvature_1_m"], points)
}

/// The polynomials: of each piece, the coefficients of u^k, u from 0 to 1 along the piece.
fn coefficients_csv(found: &PlanResult) -> String {
    let pieces =
        |curve: &Curve| curve.pieces().iter().map(|piece| piece.monomials().to_vec()).collect::<Vec<_>>();
    let rows = found.curves().enumerate().flat_map(|(i, curve)| {
        pieces(curve).into_iter().enumerate().flat_map(move |(j, monomials)| {
            let row = move |(k, c): (usize, Vector2)| [i as f64, j as f64, k as f64, c.x, c.y];
            monomials.into_iter().enumerate().map(row)
        })
    });
    table_csv(["curve", "piece", "power", "x_m", "y_m"], rows)
}

fn rows(found: &PlanResult, seconds: f64) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    vec![
        row("length", format!("{:.2} m", found.length)),
        row("duration", format!("{:.1} s", found.trajectory.duration())),
        row("way-points", found.way_points.points().len().to_string()),
        row("curve pieces", found.curves().map(|curve| curve.pieces().len()).sum::<usize>().to_string()),
        row("least room beside the robot", format!("{:.3} m", found.min_clearance)),
        row("planning", format!("{:.1} ms", seconds * 1e3)),
    ]
}

fn summary(args: &PlanArgs, found: &PlanResult, seconds: f64) -> Summary {
    let mut summary = Summary::new("plan");
    summary
        .set("success", true)
        .set("map", args.map.display().to_string())
        .set("from", args.from.0)
        .set("to", args.to.0)
        .set("length_m", found.length)
        .set("duration_s", found.trajectory.duration())
        .set("way_points", found.way_points.points().len())
        .set("curve_pieces", found.curves().map(|curve| curve.pieces().len()).sum::<usize>())
        .set("min_clearance_m", found.min_clearance)
        .set("fell_back", found.fell_back)
        .set("wall_clock", serde_json::json!({ "planning_s": seconds }));
    summary
}
