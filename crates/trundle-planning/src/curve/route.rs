//! From waypoints to phases: turns in place and verified curves.
//!
//! A curve with both headings is tried first. Without clearance along that curve, the robot turns in place at the end, at the start, or at
//! both. If these fail too, the path is split at its sharpest corner. The last resort is a straight line between two waypoints, which is
//! free: a route always exists.

use crate::curve::analytic_curve::{Curve, CurveSample};
use crate::curve::fit::config::CurveConfig;
use crate::curve::fit::program::fit;
use crate::curve::fit::segment::{PathSegment, Tangent, segments};
use crate::curve::phase::Phase;
use crate::geometry::{bearing, polyline_length};
use crate::polygon::robot_shape::RobotShape;
use crate::search::configuration_space::ConfigurationSpace;
use trundle_core::{Pose2, Vector2, difference_of_angles};

/// Factor on the smoothing length of the second fit if the first curve is too long. Source: ours.
const CLOSER_FACTOR: f64 = 0.4;
/// Factor on the smoothing length of the second fit if the first curve is not drivable. Source: ours.
const SMOOTHER_FACTOR: f64 = 2.0;
/// Spacing of the checks along a curve, m: between two, the distance to an obstacle dips by at most spacing^2 / 8 radius.
/// Source: ours.
const CHECK_SPACING_M: f64 = 0.01;
/// Parametric speed below which a curve is rejected, ratio: a cusp is near. Source: ours.
const MIN_PARAMETRIC_SPEED: f64 = 0.1;
/// Missing clearance that counts as rounding error of the solver, m. Source: ours.
const CLEARANCE_TOLERANCE_M: f64 = 1e-4;

/// Everything that a curve is checked against.
pub(crate) struct RouteContext<'a> {
    pub(crate) space: &'a ConfigurationSpace<'a>,
    /// The polygon, swept in addition to the disc of the configuration space.
    pub(crate) shape: Option<&'a RobotShape>,
    pub(crate) config: &'a CurveConfig,
}

/// The phases from `start` to `goal` along the free waypoints `path`. `moving`: the curvature of a present motion at `start`; the result is
/// then `None` if no curve continues it. From rest a disc always has a route; the result for a polygon is `None` after a contact.
pub(crate) fn route(
    context: &RouteContext<'_>,
    path: &[Vector2],
    start: Pose2,
    goal: Pose2,
    moving: Option<f64>,
) -> Option<Vec<Phase>> {
    let config = context.config;
    let segments = segments(context.space, path, config);
    let longest = polyline_length(path) * config.detour;
    let first = bearing(path[1] - path[0]);
    let last = bearing(path[path.len() - 1] - path[path.len() - 2]);
    let ahead = difference_of_angles(first, start.theta).abs() <= config.turn_first;
    let arriving = difference_of_angles(goal.theta, last).abs() <= config.turn_last;
    let starts: &[Tangent] = match moving {
        Some(_) if !ahead => return None,
        Some(curvature) => &[Tangent::Moving(start.theta, curvature)],
        None if ahead => &[Tangent::Heading(start.theta), Tangent::Free],
        None => &[Tangent::Free],
    };
    let ends: &[Tangent] =
        if arriving { &[Tangent::Heading(goal.theta), Tangent::Free] } else { &[Tangent::Free] };
    for start_tangent in starts {
        for end_tangent in ends {
            // A curve that meets the final heading must be hardly longer; else the robot turns in place.
            let into =
                matches!(start_tangent, Tangent::Heading(_)) || matches!(end_tangent, Tangent::Heading(_));
            let tangents = (*start_tangent, *end_tangent);
            let mut curve = verified_curve(context, &segments, tangents, longest);
            if curve.is_none() && !into {
                curve = verified_curve(context, &segments, tangents, f64::INFINITY);
            }
            let phases = curve.and_then(|curve| with_turns(context, vec![curve], start.theta, goal));
            if phases.is_some() {
                return phases;
            }
        }
    }
    if moving.is_some() {
        return None;
    }
    with_turns(context, split(context, path)?, start.theta, goal)
}

/// A checked free curve no longer than `longest` m. The fit is smoother if the first curve exceeds the curvature, and nearer to the path if
/// the first curve is too long.
fn verified_curve(
    context: &RouteContext<'_>,
    segments: &[PathSegment],
    tangents: (Tangent, Tangent),
    longest: f64,
) -> Option<Curve> {
    let fitted = |factor: f64| fit(segments, tangents, context.config.smoothing * factor, context.config);
    let first = fitted(1.0)?;
    let other = if first.length() > longest {
        fitted(CLOSER_FACTOR)?
    } else if is_drivable(context, &first) {
        return Some(first);
    } else {
        fitted(SMOOTHER_FACTOR)?
    };
    (other.length() <= longest && is_drivable(context, &other)).then_some(other)
}

/// Whether the curve keeps the required clearance everywhere, and the largest curvature.
pub(crate) fn is_drivable(context: &RouteContext<'_>, curve: &Curve) -> bool {
    let (space, max_curvature) = (context.space, context.config.max_curvature);
    let samples = curve.samples(CHECK_SPACING_M);
    let smooth = samples.windows(2).all(|pair| {
        let distance = pair[1].arc - pair[0].arc;
        let turn = difference_of_angles(pair[1].pose.theta, pair[0].pose.theta).abs();
        // Between two checks the curvature may overshoot, but not by half again.
        distance > MIN_PARAMETRIC_SPEED * (pair[1].s - pair[0].s) && turn <= 1.5 * max_curvature * distance
    });
    smooth
        && samples.iter().all(|sample| {
            let at = sample.pose.position();
            sample.curvature.abs() <= max_curvature && space.has_clearance(at, CLEARANCE_TOLERANCE_M)
        })
        && context.shape.is_none_or(|shape| sweeps(space, shape, &samples))
}

/// Whether the polygon is free of contact along the samples.
fn sweeps(space: &ConfigurationSpace<'_>, shape: &RobotShape, samples: &[CurveSample]) -> bool {
    samples.windows(2).all(|pair| {
        let (from, to) = (pair[0].pose, pair[1].pose);
        let turn = difference_of_angles(to.theta, from.theta);
        shape.may_move(space.field, from, to.position() - from.position(), turn)
    })
}

/// Curves with stops between them: the path, split at sharp corners until each part has a curve.
fn split(context: &RouteContext<'_>, path: &[Vector2]) -> Option<Vec<Curve>> {
    if let [a, b] = path {
        let line = Curve::line(*a, *b);
        let free =
            context.shape.is_none_or(|shape| sweeps(context.space, shape, &line.samples(CHECK_SPACING_M)));
        return free.then(|| vec![line]);
    }
    let corner = sharpest_corner(path);
    let mut curves = part(context, &path[..=corner])?;
    curves.extend(part(context, &path[corner..])?);
    Some(curves)
}

fn part(context: &RouteContext<'_>, path: &[Vector2]) -> Option<Vec<Curve>> {
    if path.len() > 2 {
        let segments = segments(context.space, path, context.config);
        if let Some(curve) = verified_curve(context, &segments, (Tangent::Free, Tangent::Free), f64::INFINITY)
        {
            return Some(vec![curve]);
        }
    }
    split(context, path)
}

/// The inner waypoint with the largest turn.
fn sharpest_corner(path: &[Vector2]) -> usize {
    let turn =
        |i: usize| difference_of_angles(bearing(path[i + 1] - path[i]), bearing(path[i] - path[i - 1])).abs();
    (1..path.len() - 1).max_by(|i, j| turn(*i).total_cmp(&turn(*j))).expect("invariant: an inner path-point")
}

/// The curves, with a turn between two curves whose headings differ.
fn with_turns(
    context: &RouteContext<'_>,
    curves: Vec<Curve>,
    heading: f64,
    goal: Pose2,
) -> Option<Vec<Phase>> {
    let mut phases = Vec::new();
    let mut heading = heading;
    for curve in curves {
        let (start, end) = (curve.pose(0.0), curve.pose(curve.span()));
        phases.extend(turn(context, start, heading, start.theta)?);
        heading = end.theta;
        phases.push(Phase::Drive(curve));
    }
    phases.extend(turn(context, goal, heading, goal.theta)?);
    Some(phases)
}

/// A turn at a pose, empty for an angle of 0; `None` if the polygon has too little clearance.
pub(crate) fn turn(context: &RouteContext<'_>, at: Pose2, from: f64, to: f64) -> Option<Option<Phase>> {
    /// Angle below which no turn is needed, rad. Source: ours.
    const MIN_TURN_RAD: f64 = 1e-6;
    let from = Pose2::new(at.x, at.y, from);
    let short = difference_of_angles(to, from.theta);
    if short.abs() <= MIN_TURN_RAD {
        return Some(None);
    }
    let angle = match context.shape {
        Some(shape) => shape.turn(context.space.field, from, to)?,
        None => short,
    };
    Some(Some(Phase::Turn { from, angle }))
}

/// The phases through poses; each pose is reached from the previous one by a turn or straight ahead.
pub(crate) fn straight(context: &RouteContext<'_>, poses: &[Pose2]) -> Option<Vec<Phase>> {
    let mut phases = Vec::new();
    for pair in poses.windows(2) {
        let by = pair[1].position() - pair[0].position();
        if by.norm() > 1e-6 {
            phases.push(Phase::Drive(Curve::line(pair[0].position(), pair[1].position())));
        } else {
            phases.extend(turn(context, pair[0], pair[0].theta, pair[1].theta)?);
        }
    }
    Some(phases)
}
