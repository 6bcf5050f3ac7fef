//! Plans for the circumscribed disc of the robot.

use crate::curve::phase::Phase;
use crate::curve::route::{RouteContext, is_drivable, turn};
use crate::plan::Plan;
use crate::polygon::robot_shape::missing_about_disc;
use crate::query::path_search::find_path;
use crate::query::plan_query::{MIN_SEARCH_RADIUS_M, PlanQuery, REST_SPEED_M_S, SAME_PLACE_M};
use crate::search::configuration_space::ConfigurationSpace;
use crate::search::geodesic_search::GeodesicSearch;
use crate::search::grid_path::GridPath;
use crate::timing::trajectory::can_follow;
use trundle_core::{Pose2, Twist2, Vector2};

/// Plan to the goal, or to the reachable point nearest to it, within `tolerance` m.
pub(crate) fn plan_disc(
    query: &PlanQuery<'_>,
    search: &mut GeodesicSearch,
    start: Pose2,
    twist: Twist2,
    goal: Pose2,
    tolerance: f64,
) -> Plan {
    if let Some(refusal) = start_refusal(query, start.position()) {
        return refusal;
    }
    let radius = query.shape.radius;
    let space = query.configuration_space(radius, start.position());
    let missing = missing_about_disc(query.field, goal.position(), radius);
    let in_obstacle = missing.map(|missing| Plan::GoalInObstacle { clearance: -missing });
    if let (Some(refusal), true) = (&in_obstacle, tolerance == 0.0) {
        return refusal.clone();
    }
    let nearest = match find_path(query, search, &space, start.position(), goal.position()) {
        Ok(path) => return plan_along(query, search, &space, path, (start, twist), goal),
        Err(nearest) => nearest,
    };
    if (nearest - goal.position()).norm() > tolerance {
        return Plan::Blocked { nearest };
    }
    let instead = Pose2::new(nearest.x, nearest.y, goal.theta);
    let plan = if start.distance(&instead) < SAME_PLACE_M {
        turn_only(query, start, twist, instead)
    } else {
        match find_path(query, search, &space, start.position(), nearest) {
            Ok(path) => plan_along(query, search, &space, path, (start, twist), instead),
            Err(nearest) => Plan::Blocked { nearest },
        }
    };
    let Plan::Found(mut plan) = plan else { return plan };
    plan.instead_of = Some(in_obstacle.unwrap_or(Plan::Blocked { nearest }));
    Plan::Found(plan)
}

/// Plan along a path: continuing the present motion, or after braking, or from rest.
fn plan_along(
    query: &PlanQuery<'_>,
    search: &mut GeodesicSearch,
    space: &ConfigurationSpace<'_>,
    path: GridPath,
    (start, twist): (Pose2, Twist2),
    goal: Pose2,
) -> Plan {
    let context = query.context(space);
    if twist.v > REST_SPEED_M_S {
        let onward = query.route(&context, &path.points, start, goal, Some(twist.omega / twist.v));
        if let Some(phases) = onward.filter(|phases| can_follow(phases, twist.v, query.drive)) {
            return query.timed(path, phases, start, twist.v, true);
        }
        if let Some(plan) = brake_first(query, search, &context, start, twist, goal) {
            return plan;
        }
    }
    let still = twist.v.abs() <= REST_SPEED_M_S;
    match query.route(&context, &path.points, start, goal, None) {
        Some(phases) => query.timed(path, phases, start, 0.0, still),
        // A polygon that leaves a wall, or turns next to it, may touch it while its disc would not.
        None => Plan::Blocked { nearest: start.position() },
    }
}

/// The reason why the disc cannot start here.
pub(crate) fn start_refusal(query: &PlanQuery<'_>, start: Vector2) -> Option<Plan> {
    if !query.shape.is_disc() {
        return None;
    }
    let radius = query.shape.radius;
    let clearance = query.field.clearance(start, radius);
    let inside = clearance <= 0.0 || clearance < radius - query.config.room.escape;
    inside.then_some(Plan::StartInObstacle { clearance: clearance - radius })
}

pub(crate) fn turn_only(query: &PlanQuery<'_>, start: Pose2, twist: Twist2, goal: Pose2) -> Plan {
    let path = GridPath::new(vec![start.position()], vec![start.position()]);
    let space = query.configuration_space(query.shape.inner.max(MIN_SEARCH_RADIUS_M), start.position());
    match turn(&query.context(&space), start, start.theta, goal.theta) {
        Some(phase) => {
            query.timed(path, phase.into_iter().collect(), start, 0.0, twist.v.abs() <= REST_SPEED_M_S)
        }
        None => Plan::Blocked { nearest: start.position() },
    }
}

/// Brakes along the present arc, then plans from its end.
fn brake_first(
    query: &PlanQuery<'_>,
    search: &mut GeodesicSearch,
    context: &RouteContext<'_>,
    start: Pose2,
    twist: Twist2,
    goal: Pose2,
) -> Option<Plan> {
    let brake = query.brake(start, twist);
    let standing = brake.pose(brake.span());
    let stop = standing.position();
    let inside = query.field.geometry().cell_at(stop).is_some();
    if !inside || !is_drivable(context, &brake) {
        return None;
    }
    let rest = if standing.distance(&goal) < SAME_PLACE_M {
        GridPath::new(vec![stop], vec![stop])
    } else {
        find_path(query, search, context.space, stop, goal.position()).ok()?
    };
    let mut phases = vec![Phase::Drive(brake)];
    if rest.points.len() > 1 {
        phases.extend(query.route(context, &rest.points, standing, goal, None)?);
    } else {
        phases.extend(turn(context, standing, standing.theta, goal.theta)?);
    }
    let with_start = |mut points: Vec<Vector2>| {
        points.insert(0, start.position());
        points
    };
    let whole =
        GridPath { raw: with_start(rest.raw), points: with_start(rest.points), fell_back: rest.fell_back };
    Some(query.timed(whole, phases, start, twist.v, true))
}
