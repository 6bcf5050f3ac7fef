//! Plans for a polygonal footprint whose circumscribed disc does not fit.

use crate::curve::phase::Phase;
use crate::curve::route::{RouteContext, is_drivable, straight};
use crate::plan::Plan;
use crate::polygon::lattice_planner::{LatticePlanner, shortened};
use crate::polygon::robot_shape::MAX_OVERLAP_M;
use crate::query::plan_query::{MIN_SEARCH_RADIUS_M, PlanQuery, REST_SPEED_M_S, SAME_PLACE_M, SearchBuffers};
use crate::search::configuration_space::ConfigurationSpace;
use crate::search::geodesic_search::{GeodesicSearch, SearchOutcome};
use crate::search::grid_path::GridPath;
use crate::timing::trajectory::can_follow;
use trundle_core::{Pose2, Twist2, Vector2};

/// Overlap that a motion may have unnoticed, m. Source: ours.
const UNDETECTED_OVERLAP_M: f64 = 1e-3;

/// Poses of a polygonal footprint to the goal.
struct PolygonPath {
    poses: Vec<Pose2>,
    path: GridPath,
}

/// Plans straight moves and turns of the polygon, or a curve if one is free. A moving robot continues along a curve, or brakes on its arc
/// first. If neither is free, the plan starts from rest and is not continuous. `by_disc`: the plan of the circumscribed disc.
pub(crate) fn plan_polygon(
    query: &PlanQuery<'_>,
    memory: &mut SearchBuffers,
    start: Pose2,
    twist: Twist2,
    goal: Pose2,
    by_disc: &Plan,
) -> Plan {
    let inner = query.shape.inner.max(MIN_SEARCH_RADIUS_M);
    if !query.fits(start) {
        let missing = query.shape.overlap(query.field, start, query.shape.inner.max(MAX_OVERLAP_M));
        return Plan::StartInObstacle { clearance: -missing };
    }
    if let Some(missing) = query.shape.missing_at_goal(query.field, goal) {
        return Plan::GoalInObstacle { clearance: -missing };
    }
    if is_disconnected(query, &mut memory.search, start, goal) {
        return match by_disc {
            Plan::Blocked { .. } => by_disc.clone(),
            _ => Plan::Blocked { nearest: nearest_reachable(query, &mut memory.search, start, goal) },
        };
    }
    let space = query.polygon_space(inner, start.position());
    let context = query.context(&space);
    let lattice_planner = &mut memory.lattice_planner;
    let polygon_path = match polygon_path(query, lattice_planner, &context, start, goal) {
        Ok(polygon_path) => polygon_path,
        Err(nearest) => return Plan::Blocked { nearest },
    };
    if twist.v > REST_SPEED_M_S {
        let onward = curve_along(query, &context, &polygon_path, start, goal, Some(twist.omega / twist.v));
        if let Some(phases) = onward.filter(|phases| can_follow(phases, twist.v, query.drive)) {
            return query.timed(polygon_path.path, phases, start, twist.v, true);
        }
        if let Some(plan) = brake_then_plan(query, lattice_planner, &context, start, twist, goal) {
            return plan;
        }
    }
    match phases_from_rest(query, &context, &polygon_path, start, goal) {
        Some(phases) => query.timed(polygon_path.path, phases, start, 0.0, twist.v.abs() <= REST_SPEED_M_S),
        None => Plan::Blocked { nearest: start.position() },
    }
}

/// Whether even the largest inscribed disc, reduced by half a cell's diagonal, has no path. This quick test avoids a search over headings
/// that would expand everything.
fn is_disconnected(query: &PlanQuery<'_>, search: &mut GeodesicSearch, start: Pose2, goal: Pose2) -> bool {
    let geometry = query.field.geometry();
    let (middle, radius) = query.shape.inscribed;
    let off = geometry.resolution * std::f64::consts::FRAC_1_SQRT_2;
    let less = radius - query.shape.depth() - off - UNDETECTED_OVERLAP_M;
    let (from, to) = (start.transform(middle), goal.transform(middle));
    let is_inside = [from, to].iter().all(|at| geometry.cell_at(*at).is_some());
    if less < MIN_SEARCH_RADIUS_M || !is_inside {
        return false;
    }
    let space = ConfigurationSpace::new(query.field, query.grid, query.config.room, less, from);
    matches!(search.run(&space, from, to), SearchOutcome::Unreachable(_))
}

/// Whether a path between cell centres may lead to the goal: the polygon is tested with its boundary half a cell's diagonal further in.
pub(crate) fn may_pass(query: &PlanQuery<'_>, memory: &mut SearchBuffers, start: Pose2, goal: Pose2) -> bool {
    if !(query.fits(start) && query.fits(goal)) || is_disconnected(query, &mut memory.search, start, goal) {
        return false;
    }
    let off = query.field.geometry().resolution * std::f64::consts::FRAC_1_SQRT_2;
    let Some(slim) = query.shape.shrunk(off) else { return true };
    let space = query.polygon_space(slim.inner.max(MIN_SEARCH_RADIUS_M), start.position());
    memory.lattice_planner.run(&space, &slim, start, goal).is_ok()
}

/// The point nearest to the goal that the circumscribed disc reaches.
fn nearest_reachable(
    query: &PlanQuery<'_>,
    search: &mut GeodesicSearch,
    start: Pose2,
    goal: Pose2,
) -> Vector2 {
    let space = query.configuration_space(query.shape.radius, start.position());
    match search.run(&space, start.position(), goal.position()) {
        SearchOutcome::Unreachable(nearest) => nearest,
        SearchOutcome::Found(_) => goal.position(),
    }
}

/// The path by the lattice search, or the reachable point nearest to the goal.
fn polygon_path(
    query: &PlanQuery<'_>,
    lattice_planner: &mut LatticePlanner,
    context: &RouteContext<'_>,
    start: Pose2,
    goal: Pose2,
) -> Result<PolygonPath, Vector2> {
    let search = || lattice_planner.run(context.space, query.shape, start, goal);
    let poses = query.timer.time(|times| &mut times.waypoints, search)?;
    let raw: Vec<Vector2> = poses.iter().map(Pose2::position).collect();
    let poses = shortened(context.space, query.shape, &poses);
    let mut points: Vec<Vector2> = poses.iter().map(Pose2::position).collect();
    points.dedup_by(|a, b| (*a - *b).norm() < SAME_PLACE_M);
    Ok(PolygonPath { poses, path: GridPath::new(raw, points) })
}

fn curve_along(
    query: &PlanQuery<'_>,
    context: &RouteContext<'_>,
    polygon_path: &PolygonPath,
    start: Pose2,
    goal: Pose2,
    moving: Option<f64>,
) -> Option<Vec<Phase>> {
    let points = &polygon_path.path.points;
    (points.len() > 1).then(|| query.route(context, points, start, goal, moving)).flatten()
}

/// The phases of a plan from rest: a curve, or else the straight moves and turns themselves.
fn phases_from_rest(
    query: &PlanQuery<'_>,
    context: &RouteContext<'_>,
    polygon_path: &PolygonPath,
    start: Pose2,
    goal: Pose2,
) -> Option<Vec<Phase>> {
    curve_along(query, context, polygon_path, start, goal, None)
        .or_else(|| straight(context, &polygon_path.poses))
}

/// Brakes along the present arc if its sweep is free, then plans from its end.
fn brake_then_plan(
    query: &PlanQuery<'_>,
    lattice_planner: &mut LatticePlanner,
    context: &RouteContext<'_>,
    start: Pose2,
    twist: Twist2,
    goal: Pose2,
) -> Option<Plan> {
    let brake = query.brake(start, twist);
    let standing = brake.pose(brake.span());
    if !is_drivable(context, &brake) || !query.fits(standing) {
        return None;
    }
    let mut polygon_path = polygon_path(query, lattice_planner, context, standing, goal).ok()?;
    let mut phases = vec![Phase::Drive(brake)];
    phases.extend(phases_from_rest(query, context, &polygon_path, standing, goal)?);
    polygon_path.path.raw.insert(0, start.position());
    polygon_path.path.points.insert(0, start.position());
    Some(query.timed(polygon_path.path, phases, start, twist.v, true))
}
