//! The plan in pictures, and their page.

use super::goal_refusal::{GoalRefusal, MovedGoal};
use super::numbers::{curves, plan_rows, points};
use super::plan_times::PlanTimes;
use super::request::PlanRequest;
use trundle_core::{DriveLimits, Pose2, Vector2};
use trundle_planning::{HalfPlane, MultiGoalPlan, Plan};
use trundle_viz::{
    Figure, PlanParts, PlanScene, Report, Table, no_plan_picture, plan_part_pictures, plan_picture,
    speed_charts,
};

/// `plan.png`, `field.png`, `corridors.png` and the page with them and the speeds.
pub struct Pictures {
    pub plan: Vec<u8>,
    pub field: Vec<u8>,
    pub corridors: Vec<u8>,
    pub page: String,
}

/// Draws map, plan and legend.
pub fn draw(
    request: &PlanRequest,
    plan: &MultiGoalPlan,
    limits: DriveLimits,
    moved: &[MovedGoal],
    times: PlanTimes,
) -> Pictures {
    let join = |of: fn(&trundle_planning::PlanResult) -> &[Vector2]| -> Vec<Vector2> {
        plan.legs.iter().flat_map(|leg| of(leg).iter().copied()).collect()
    };
    let (raw, way_points, curve) =
        (join(|leg| leg.raw.points()), join(|leg| leg.waypoints.points()), points(plan));
    let goals: Vec<Pose2> = plan.legs.iter().map(|leg| leg.trajectory.end()).collect();
    let replaced: Vec<Pose2> = moved.iter().map(|moved| request.goals[moved.goal].pose).collect();
    let scene = PlanScene {
        grid: &request.grid,
        start: request.start.pose,
        goals: &goals,
        replaced: &replaced,
        lanes: &request.lanes(),
        route: &raw,
        way_points: &way_points,
        curve: &curve,
        footprint: &request.footprint,
        keep_out: request.keep_out.as_ref(),
        slow: request.slow.as_ref(),
    };
    let field = request.planner.field();
    let geometry = field.map_or(*request.grid.geometry(), |field| *field.geometry());
    let distances: Vec<f32> = field.map_or(vec![], |field| {
        (0..geometry.len()).map(|i| field.at_cell(geometry.cell(i)) as f32).collect()
    });
    let corridors: Vec<_> =
        curves(plan).flat_map(|curve| curve.corridors()).map(|planes| HalfPlane::outline(planes)).collect();
    let active: Vec<Vector2> = curves(plan)
        .flat_map(|curve| curve.active().iter().map(|row| curve.pieces()[row.piece].control()[row.control]))
        .collect();
    let parts = PlanParts { geometry, distances: &distances, corridors: &corridors, active: &active };
    let [field, corridors] = plan_part_pictures(&scene, &parts);
    let plan_png = plan_picture(&scene);
    let notes = moved.iter().map(|moved| vec![moved.note(), String::new()]);
    let numbers: Vec<_> = notes.chain(plan_rows(plan, times)).collect();
    let page = page([&plan_png, &field, &corridors], plan, limits, &numbers);
    Pictures { plan: plan_png, field, corridors, page }
}

/// `plan.png` without a plan: the ends of the leg, and the reachable position nearest to its goal.
pub fn without_plan(request: &PlanRequest, refusal: &GoalRefusal) -> Vec<u8> {
    let (start, goal) = (refusal.from, request.goals[refusal.goal].pose);
    let nearest: Vec<Vector2> = match refusal.why {
        Plan::Blocked { nearest } => vec![nearest],
        _ => vec![],
    };
    let scene = PlanScene {
        grid: &request.grid,
        start,
        goals: &[goal],
        replaced: &[],
        lanes: &request.lanes(),
        route: &[],
        way_points: &[],
        curve: &[],
        footprint: &request.footprint,
        keep_out: request.keep_out.as_ref(),
        slow: request.slow.as_ref(),
    };
    no_plan_picture(&scene, &nearest)
}

fn page(pictures: [&[u8]; 3], plan: &MultiGoalPlan, limits: DriveLimits, numbers: &[Vec<String>]) -> String {
    let [overview, field, corridors] = pictures;
    let figure = |title: &str, png: &[u8], caption: &str| Figure::png(title, png).caption(caption).wide();
    let table = numbers
        .iter()
        .fold(Table::new("Numbers", ["", ""]), |table, row| table.row([row[0].clone(), row[1].clone()]));
    let report = Report::new("A plan")
        .subtitle("From a map, a start and a goal to way-points, a curve and its timing.")
        .section("How it was made", "")
        .figure(figure("Plan", overview, "What the robot will drive, and the floor that it sweeps."))
        .figure(figure(
            "Distance field and way-points",
            field,
            "Distance to the nearest obstacle. Dashed: the path of the search. Solid: the way-points after string pulling.",
        ))
        .figure(figure(
            "Corridors and curve",
            corridors,
            "Convex free polygons that hold the pieces of the curve; circles are control points that lean on a side.",
        ))
        .section("Over time", "");
    let charts = speed_charts(&plan.trajectory, (limits.v, limits.omega));
    charts
        .iter()
        .fold(report, |report, chart| report.figure(Figure::chart(chart)))
        .section("In numbers", "")
        .table(table)
        .to_html()
}
