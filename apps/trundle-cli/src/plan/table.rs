//! The plan in numbers.

use super::Spent;
use super::args::PlanArgs;
use super::errand::{Errand, Moved, Refusal};
use crate::console;
use trundle::core::Vector2;
use trundle::io::{Summary, table_csv};
use trundle::planning::{Curve, MAX_CLEARANCE_M, MultiGoalPlan, Plan, clearance_text};

/// Distance of two points of the curve in `curve.csv` and in pictures, m.
const SPACING: f64 = 0.02;

/// All curves, in order.
pub fn curves(tour: &MultiGoalPlan) -> impl Iterator<Item = &Curve> {
    tour.legs.iter().flat_map(|leg| leg.curves())
}

/// Points along all curves, close together.
pub fn points(tour: &MultiGoalPlan) -> Vec<Vector2> {
    curves(tour).flat_map(|curve| curve.samples(SPACING)).map(|sample| sample.pose.position()).collect()
}

/// Points along the curves: piece of the plan, way along it, pose, curvature.
pub fn curve_csv(tour: &MultiGoalPlan) -> String {
    let points = curves(tour).enumerate().flat_map(|(i, curve)| {
        let row = move |p: trundle::planning::CurveSample| {
            [i as f64, p.arc, p.pose.x, p.pose.y, p.pose.theta, p.curvature]
        };
        curve.samples(SPACING).into_iter().map(row)
    });
    table_csv(["curve", "s_m", "x_m", "y_m", "theta_rad", "curvature_1_m"], points)
}

/// Of each piece, the coefficients of u^k, u from 0 to 1 along the piece: curve, piece, power, x, y.
fn coefficients(tour: &MultiGoalPlan) -> Vec<[f64; 5]> {
    let mut rows = Vec::new();
    for (i, curve) in curves(tour).enumerate() {
        for (j, piece) in curve.pieces().iter().enumerate() {
            let row = |(k, c): (usize, Vector2)| [i as f64, j as f64, k as f64, c.x, c.y];
            rows.extend(piece.monomials().into_iter().enumerate().map(row));
        }
    }
    rows
}

/// The corridors' sides that shape the curves: curve, piece, control point, normal, offset, multiplier.
fn constraints(tour: &MultiGoalPlan) -> Vec<[f64; 7]> {
    let mut rows = Vec::new();
    for (i, curve) in curves(tour).enumerate() {
        rows.extend(curve.active().iter().map(|row| {
            let side = curve.corridors()[row.piece][row.plane];
            let (piece, control) = (row.piece as f64, row.control as f64);
            [i as f64, piece, control, side.normal.x, side.normal.y, side.offset, row.multiplier]
        }));
    }
    rows
}

/// The polynomials: of each piece, the coefficients of u^k, u from 0 to 1 along the piece.
pub fn coefficients_csv(tour: &MultiGoalPlan) -> String {
    table_csv(["curve", "piece", "power", "x_m", "y_m"], coefficients(tour))
}

/// The active constraints: normal . control point <= offset, and what a metre of room would gain.
pub fn constraints_csv(tour: &MultiGoalPlan) -> String {
    let head = ["curve", "piece", "control", "normal_x", "normal_y", "offset_m", "multiplier"];
    table_csv(head, constraints(tour))
}

/// Prints polynomials and active constraints.
pub fn print_curves(tour: &MultiGoalPlan) {
    for (i, curve) in curves(tour).enumerate() {
        for (j, piece) in curve.pieces().iter().enumerate() {
            console::print(&format!("curve {i}, piece {j}, {:.3} m, u = 0 to 1:", piece.span()));
            let c = piece.monomials();
            for (axis, name) in ["x", "y"].into_iter().enumerate() {
                console::print(&format!("  {name}(u) = {}", polynomial(c.iter().map(|c| c[axis]))));
            }
        }
    }
    let active = constraints(tour);
    console::print(&format!(
        "active constraints, normal . control point <= offset, multiplier in m^2: {}",
        active.len()
    ));
    for [curve, piece, control, x, y, offset, multiplier] in active {
        console::print(&format!(
            "  curve {curve}, piece {piece}, control point {control}: {x:+.4} x {y:+.4} y <= {offset:.4} m, \
             multiplier {multiplier:.2e}"
        ));
    }
}

fn polynomial(coefficients: impl Iterator<Item = f64>) -> String {
    let term = |(k, c): (usize, f64)| match k {
        0 => format!("{c:.6}"),
        1 => format!("{c:+.6} u"),
        _ => format!("{c:+.6} u^{k}"),
    };
    coefficients.enumerate().map(term).collect::<Vec<_>>().join(" ")
}

/// What the terminal shows.
pub fn rows(tour: &MultiGoalPlan, Spent { all, stages }: Spent) -> Vec<Vec<String>> {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let ms = |seconds: f64| format!("{:.2} ms", seconds * 1e3);
    let mut rows = Vec::new();
    if tour.legs.len() > 1 {
        rows.push(row("goals", tour.legs.len().to_string()));
    }
    rows.extend([
        row("length", format!("{:.2} m", length(tour))),
        row("duration", format!("{:.1} s", tour.trajectory.duration())),
        row("way-points", way_points(tour).to_string()),
        row("curve pieces", pieces(tour).to_string()),
        row("active constraints", constraints(tour).len().to_string()),
        row("least room beside the robot", clearance_text(least_room(tour))),
        row("planning", ms(all)),
        row("  distance field", ms(stages.field)),
        row("  way-points", ms(stages.waypoints)),
        row("  curve", ms(stages.curve)),
        row("  timing", ms(stages.timing)),
    ]);
    rows
}

fn length(tour: &MultiGoalPlan) -> f64 {
    tour.legs.iter().map(|leg| leg.length).sum()
}

fn way_points(tour: &MultiGoalPlan) -> usize {
    tour.legs.iter().map(|leg| leg.waypoints.points().len()).sum()
}

fn pieces(tour: &MultiGoalPlan) -> usize {
    curves(tour).map(|curve| curve.pieces().len()).sum()
}

fn least_room(tour: &MultiGoalPlan) -> f64 {
    tour.legs.iter().map(|leg| leg.min_clearance).fold(f64::INFINITY, f64::min)
}

/// `summary.json` of an errand without a plan.
pub fn no_summary(args: &PlanArgs, errand: &Errand, refusal: &Refusal, why: &str) -> Summary {
    let goals: Vec<_> = errand.goals.iter().map(|goal| goal.pose).collect();
    let mut summary = Summary::new("plan");
    summary
        .set("success", false)
        .set("map", args.map.display().to_string())
        .set("from", errand.start.pose)
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
    args: &PlanArgs,
    errand: &Errand,
    tour: &MultiGoalPlan,
    moved: &[Moved],
    spent: Spent,
) -> Summary {
    let goals: Vec<_> = errand.goals.iter().map(|goal| goal.pose).collect();
    let moved: Vec<_> = moved
        .iter()
        .map(|moved| serde_json::json!({ "goal": moved.goal, "off_m": moved.off, "why": moved.why }))
        .collect();
    let reached: Vec<_> = tour.legs.iter().map(|leg| leg.trajectory.end()).collect();
    let mut summary = Summary::new("plan");
    summary
        .set("success", true)
        .set("map", args.map.display().to_string())
        .set("from", errand.start.pose)
        .set("to", goals[goals.len() - 1])
        .set("goals", goals)
        .set("reached", reached)
        .set("goals_moved", moved)
        .set("length_m", length(tour))
        .set("duration_s", tour.trajectory.duration())
        .set("way_points", way_points(tour))
        .set("curve_pieces", pieces(tour))
        .set("active_constraints", constraints(tour).len())
        .set("min_clearance_m", least_room(tour))
        .set("min_clearance_is_a_limit", least_room(tour) >= MAX_CLEARANCE_M)
        .set("fell_back", tour.legs.iter().any(|leg| leg.fell_back))
        .set(
            "wall_clock",
            serde_json::json!({
                "planning_s": spent.all,
                "field_s": spent.stages.field,
                "way_points_s": spent.stages.waypoints,
                "curve_s": spent.stages.curve,
                "timing_s": spent.stages.timing,
            }),
        );
    summary
}
