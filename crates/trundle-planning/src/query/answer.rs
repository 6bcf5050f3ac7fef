//! The answer to a planning request: disc, polygon, or the escape from an overlap.

use crate::plan::Plan;
use crate::polygon::robot_shape::MAX_OVERLAP_M;
use crate::query::disc_planner::{plan_disc, start_refusal, turn_only};
use crate::query::plan_query::{MIN_SEARCH_RADIUS_M, PlanQuery, SAME_PLACE_M, SearchBuffers};
use crate::query::polygon_planner::{may_pass, plan_polygon};
use crate::search::configuration_space::ConfigurationSpace;
use crate::search::geodesic_search::SearchOutcome;
use trundle_core::{Pose2, Twist2};

/// Path, curve and timing, or the reason for their absence: for the circumscribed disc first; if the disc does not fit, for the polygon.
pub(crate) fn plan(
    query: &PlanQuery<'_>,
    memory: &mut SearchBuffers,
    start: Pose2,
    twist: Twist2,
    goal: Pose2,
) -> Plan {
    if start.distance(&goal) < SAME_PLACE_M && (query.shape.is_disc() || query.fits(start)) {
        return start_refusal(query, start.position())
            .unwrap_or_else(|| turn_only(query, start, twist, goal));
    }
    if !query.shape.is_disc() && !query.fits(start) {
        return plan_escape(query, memory, start, twist, goal);
    }
    plan_disc_or_polygon(query, memory, start, twist, goal)
}

/// For a polygon that overlaps an obstacle, not deeper than the configured escape.
fn plan_escape(
    query: &PlanQuery<'_>,
    memory: &mut SearchBuffers,
    start: Pose2,
    twist: Twist2,
    goal: Pose2,
) -> Plan {
    let escape = query.config.room.escape;
    let depth = query.shape.overlap(query.field, start, escape.max(MAX_OVERLAP_M));
    let leaving = (depth <= escape).then(|| query.shape.escaping(query.field, start, depth)).flatten();
    match leaving {
        Some(shape) if shape.gap(query.field, start, 1e-3) > 0.0 => {
            plan_disc_or_polygon(&PlanQuery { shape: &shape, ..*query }, memory, start, twist, goal)
        }
        _ => Plan::StartInObstacle { clearance: -depth },
    }
}

fn plan_disc_or_polygon(
    query: &PlanQuery<'_>,
    memory: &mut SearchBuffers,
    start: Pose2,
    twist: Twist2,
    goal: Pose2,
) -> Plan {
    let tolerance = query.config.goal_tolerance;
    if query.shape.is_disc() {
        return plan_disc(query, &mut memory.search, start, twist, goal, tolerance);
    }
    let plan = plan_disc(query, &mut memory.search, start, twist, goal, 0.0);
    if matches!(plan, Plan::Found(_)) {
        return plan;
    }
    let plan = plan_polygon(query, memory, start, twist, goal, &plan);
    if matches!(plan, Plan::Found(_)) || tolerance == 0.0 {
        return plan;
    }
    match plan_disc(query, &mut memory.search, start, twist, goal, tolerance) {
        Plan::Found(mut nearby) => {
            nearby.instead_of = Some(plan);
            Plan::Found(nearby)
        }
        _ => plan,
    }
}

/// Whether a path between the cell centres may lead to the goal, or near enough to a blocked goal. Every point of such a path is within
/// half a cell's diagonal of a centre, and the centre's clearance is smaller by at most this distance. The test also holds for graphs.
pub(crate) fn may_be_tight(
    query: &PlanQuery<'_>,
    memory: &mut SearchBuffers,
    plan: &Plan,
    start: Pose2,
    goal: Pose2,
) -> bool {
    if !plan.is_short_of_goal() {
        return false;
    }
    if !query.shape.is_disc() {
        return may_pass(query, memory, start, goal);
    }
    let off = query.field.geometry().resolution * std::f64::consts::FRAC_1_SQRT_2;
    let less = (query.shape.radius - off).max(MIN_SEARCH_RADIUS_M);
    let (start, goal) = (start.position(), goal.position());
    let space = ConfigurationSpace::new(query.field, query.grid, query.config.room, less, start);
    match memory.search.run(&space, start, goal) {
        SearchOutcome::Found(_) => true,
        SearchOutcome::Unreachable(nearest) => {
            let (tolerance, is_blocked) = (query.config.goal_tolerance, matches!(plan, Plan::Blocked { .. }));
            is_blocked && tolerance > 0.0 && (nearest - goal).norm() <= tolerance + off
        }
    }
}
