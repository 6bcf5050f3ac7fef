//! The plan in numbers: tables, files of numbers, summary.

use super::goal_refusal::{GoalRefusal, MovedGoal};
use super::off_map::OffMap;
use super::plan_times::PlanTimes;
use super::request::PlanRequest;
use trundle_core::Vector2;
use trundle_io::{Summary, table_csv};
use trundle_planning::{Curve, MAX_CLEARANCE_M, MultiGoalPlan, Plan, clearance_text};

/// Distance of two points of the curve in `curve.csv` and in pictures \[m\]. Source: ours.
const CURVE_SAMPLE_SPACING_M: f64 = 0.02;

/// All curves, in order.
pub fn curves(plan: &MultiGoalPlan) -> impl Iterator<Item = &Curve> {
    plan.legs.iter().flat_map(|leg| leg.curves())
}

/// Points along all curves, close together.
pub fn points(plan: &MultiGoalPlan) -> Vec<Vector2> {
    curves(plan)
        .flat_map(|curve| curve.samples(CURVE_SAMPLE_SPACING_M))
        .map(|sample| sample.pose.position())
        .collect()
}

/// Points along the curves: curve, arc length, pose, curvature.
pub fn curve_csv(plan: &MultiGoalPlan) -> String {
    let points = curves(plan).enumerate().flat_map(|(i, curve)| {
        let row = move |p: trundle_planning::CurveSample| {
            [i as f64, p.arc, p.pose.x, p.pose.y, p.pose.theta, p.curvature]
        };
        curve.samples(CURVE_SAMPLE_SPACING_M).into_iter().map(row)
    });
    table_csv(["curve", "s_m", "x_m", "y_m", "theta_rad", "curvature_1_m"], points)
}

/// For each piece, the coefficients of u^k, u from 0 to 1 along the piece: curve, piece, power, x, y.
fn coefficients(plan: &MultiGoalPlan) -> Vec<[f64; 5]> {
    let mut rows = Vec::new();
    for (i, curve) in curves(plan).enumerate() {
        for (j, piece) in curve.pieces().iter().enumerate() {
            let row = |(k, c): (usize, Vector2)| [i as f64, j as f64, k as f64, c.x, c.y];
            rows.extend(piece.monomials().into_iter().enumerate().map(row));
        }
    }
    rows
}

/// The corridors' sides that shape the curves: curve, piece, control point, normal, offset, multiplier.
fn constraints(plan: &MultiGoalPlan) -> Vec<[f64; 7]> {
    let mut rows = Vec::new();
    for (i, curve) in curves(plan).enumerate() {
        rows.extend(curve.active().iter().map(|row| {
            let side = curve.corridors()[row.piece][row.plane];
            let (piece, control) = (row.piece as f64, row.control as f64);
            [i as f64, piece, control, side.normal.x, side.normal.y, side.offset, row.multiplier]
        }));
    }
    rows
}

/// The polynomials: of each piece, the coefficients of u^k, u from 0 to 1 along the piece.
pub fn coefficients_csv(plan: &MultiGoalPlan) -> String {
    table_csv(["curve", "piece", "power", "x_m", "y_m"], coefficients(plan))
}

/// The active constraints: normal . control point <= offset, and the gain per metre of clearance.
pub fn constraints_csv(plan: &MultiGoalPlan) -> String {
    let head = ["curve", "piece", "control", "normal_x", "normal_y", "offset_m", "multiplier"];
    table_csv(head, constraints(plan))
}

/// Polynomials and active constraints, as lines of text.
#[must_use]
pub fn curve_lines(plan: &MultiGoalPlan) -> Vec<String> {
    let mut lines = Vec::new();
    for (i, curve) in curves(plan).enumerate() {
        for (j, piece) in curve.pieces().iter().enumerate() {
            lines.push(format!("curve {i}, piece {j}, {:.3} m, u = 0 to 1:", piece.span()));
            let c = piece.monomials();
            for (axis, name) in ["x", "y"].into_iter().enumerate() {
                lines.push(format!("  {name}(u) = {}", polynomial(c.iter().map(|c| c[axis]))));
            }
        }
    }
    let active = constraints(plan);
    let count = active.len();
    lines.push(format!("active constraints, normal . control point <= offset, multiplier in m^2: {count}"));
    lines.extend(active.into_iter().map(|[curve, piece, control, x, y, offset, multiplier]| {
        format!(
            "  curve {curve}, piece {piece}, control point {control}: {x:+.4} x {y:+.4} y <= {offset:.4} m, \
             multiplier {multiplier:.2e}"
        )
    }));
    lines
}

fn polynomial(coefficients: impl Iterator<Item = f64>) -> String {
    let term = |(k, c): (usize, f64)| match k {
        0 => format!("{c:.6}"),
        1 => format!("{c:+.6} u"),
        _ => format!("{c:+.6} u^{k}"),
    };
    coefficients.enumerate().map(term).collect::<Vec<_>>().join(" ")
}

/// The table of a plan.
#[must_use]
pub fn plan_rows(plan: &MultiGoalPlan, PlanTimes { all, stages }: PlanTimes) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let ms = |seconds: f64| format!("{:.2} ms", seconds * 1e3);
    let mut rows = Vec::new();
    if plan.legs.len() > 1 {
        rows.push(row("goals", plan.legs.len().to_string()));
    }
    rows.extend([
        row("length", format!("{:.2} m", length(plan))),
        row("duration", format!("{:.1} s", plan.trajectory.duration())),
        row("way-points", way_points(plan).to_string()),
        row("curve pieces", pieces(plan).to_string()),
        row("active constraints", constraints(plan).len().to_string()),
        row("minimum clearance", clearance_text(min_clearance(plan))),
        row("planning", ms(all)),
        row("  distance field", ms(stages.field)),
        row("  way-points", ms(stages.waypoints)),
        row("  curve", ms(stages.curve)),
        row("  timing", ms(stages.timing)),
    ]);
    rows
}

fn length(plan: &MultiGoalPlan) -> f64 {
    plan.legs.iter().map(|leg| leg.length).sum()
}

fn way_points(plan: &MultiGoalPlan) -> usize {
    plan.legs.iter().map(|leg| leg.waypoints.points().len()).sum()
}

fn pieces(plan: &MultiGoalPlan) -> usize {
    curves(plan).map(|curve| curve.pieces().len()).sum()
}

fn min_clearance(plan: &MultiGoalPlan) -> f64 {
    plan.legs.iter().map(|leg| leg.min_clearance).fold(f64::INFINITY, f64::min)
}

/// `summary.json` of a request without a plan.
pub fn no_plan_summary(request: &PlanRequest, refusal: &GoalRefusal, why: &str) -> Summary {
    let goals: Vec<_> = request.goals.iter().map(|goal| goal.pose).collect();
    let mut summary = Summary::new("plan");
    summary
        .set("success", false)
        .set("map", request.map.display().to_string())
        .set("from", request.start.pose)
        .set("goals", goals)
        .set("goal_without_plan", refusal.goal)
        .set("why", why);
    if let Plan::Blocked { nearest } = &refusal.why {
        summary.set("nearest_reachable_m", [nearest.x, nearest.y]);
    }
    summary
}

/// `summary.json`.
pub fn summary(
    request: &PlanRequest,
    plan: &MultiGoalPlan,
    moved: &[MovedGoal],
    times: PlanTimes,
) -> Summary {
    let goals: Vec<_> = request.goals.iter().map(|goal| goal.pose).collect();
    let moved: Vec<_> = moved
        .iter()
        .map(|moved| serde_json::json!({ "goal": moved.goal, "off_m": moved.off, "why": moved.why }))
        .collect();
    let reached: Vec<_> = plan.legs.iter().map(|leg| leg.trajectory.end()).collect();
    let mut summary = Summary::new("plan");
    summary
        .set("success", true)
        .set("map", request.map.display().to_string())
        .set("from", request.start.pose)
        .set("to", goals[goals.len() - 1])
        .set("goals", goals)
        .set("reached", reached)
        .set("goals_moved", moved)
        .set("length_m", length(plan))
        .set("duration_s", plan.trajectory.duration())
        .set("way_points", way_points(plan))
        .set("curve_pieces", pieces(plan))
        .set("active_constraints", constraints(plan).len())
        .set("min_clearance_m", min_clearance(plan))
        .set("min_clearance_is_a_limit", min_clearance(plan) >= MAX_CLEARANCE_M)
        .set("off_map_m", OffMap::of(request, plan).map(|off| off.by))
        .set("fell_back", plan.legs.iter().any(|leg| leg.fell_back))
        .set(
            "wall_clock",
            serde_json::json!({
                "planning_s": times.all,
                "field_s": times.stages.field,
                "way_points_s": times.stages.waypoints,
                "curve_s": times.stages.curve,
                "timing_s": times.stages.timing,
            }),
        );
    summary
}
