//! From way-points to what the robot does: turns on the spot and verified curves.
//!
//! A curve that meets both headings is tried first; where it has not the room, the robot turns on the spot at the end,
//! at the start, or at both; where even that fails, the way is split at its sharpest corner. A stretch between two
//! way-points is a straight line, which is free already: so there always is a route.

use crate::body::Body;
use crate::curve::{Curve, CurveSample};
use crate::fit::{CurveConfig, Stretch, Tangent, fit, stretches};
use crate::geometry::{bearing, polyline_length};
use crate::space::Space;
use trundle_core::{Pose2, Vector2, difference_of_angles};

/// One thing that the robot does without stopping in between.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    /// Turns on the spot.
    Turn {
        /// Where, map frame; its heading is the one before.
        from: Pose2,
        /// By how much, counter-clockwise, rad; beyond +-pi where the shorter way round is blocked.
        angle: f64,
    },
    /// Drives along a curve, forward.
    Drive(Curve),
}

/// Shares of the smoothing length that are tried where the whole is not right.
const CLOSER: f64 = 0.4;
const SMOOTHER: f64 = 2.0;
/// Spacing of the looks along a curve, m: between two, an obstacle's distance dips by at most spacing^2 / 8 radius.
const SPACING: f64 = 0.01;
/// Parametric speed below which a curve counts as broken: a cusp is near.
const CUSP: f64 = 0.1;
/// A room smaller by this than required is rounding of the solver, m.
const ROUNDING: f64 = 1e-4;

/// Everything that a curve is measured against.
pub(crate) struct Course<'a> {
    pub(crate) space: &'a Space<'a>,
    /// Swept as well where it is more than the space's disc.
    pub(crate) body: Option<&'a Body>,
    pub(crate) config: &'a CurveConfig,
}

/// The phases that lead from `start` to `goal` along the free `way`. `moving`: the curvature of a motion under way at
/// `start`; then `None` when no curve continues it. From rest always a route for a disc; for an outline, `None` when it
/// touches something.
pub(crate) fn route(
    course: &Course<'_>,
    way: &[Vector2],
    start: Pose2,
    goal: Pose2,
    moving: Option<f64>,
) -> Option<Vec<Phase>> {
    let config = course.config;
    let stretches = stretches(course.space, way, config);
    let longest = polyline_length(way) * config.detour;
    let first = bearing(way[1] - way[0]);
    let last = bearing(way[way.len() - 1] - way[way.len() - 2]);
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
            // Into headings only where that is hardly longer; else the robot turns on the spot.
            let into =
                matches!(start_tangent, Tangent::Heading(_)) || matches!(end_tangent, Tangent::Heading(_));
            let tangents = (*start_tangent, *end_tangent);
            let mut curve = safe_curve(course, &stretches, tangents, longest);
            if curve.is_none() && !into {
                curve = safe_curve(course, &stretches, tangents, f64::INFINITY);
            }
            let phases = curve.and_then(|curve| with_turns(course, vec![curve], start.theta, goal));
            if phases.is_some() {
                return phases;
            }
        }
    }
    if moving.is_some() {
        return None;
    }
    with_turns(course, split(course, way)?, start.theta, goal)
}

/// A curve no longer than `longest` m that was measured and found free: smoother where the first one bends too much, nearer
/// to the way where it swings too far.
fn safe_curve(
    course: &Course<'_>,
    stretches: &[Stretch],
    tangents: (Tangent, Tangent),
    longest: f64,
) -> Option<Curve> {
    let fitted = |factor: f64| fit(stretches, tangents, course.config.smoothing * factor, course.config);
    let first = fitted(1.0)?;
    let other = if first.length() > longest {
        fitted(CLOSER)?
    } else if is_drivable(course, &first) {
        return Some(first);
    } else {
        fitted(SMOOTHER)?
    };
    (other.length() <= longest && is_drivable(course, &other)).then_some(other)
}

/// Whether the curve keeps the required room everywhere, and bends no more than allowed.
pub(crate) fn is_drivable(course: &Course<'_>, curve: &Curve) -> bool {
    let (space, max_curvature) = (course.space, course.config.max_curvature);
    let samples = curve.samples(SPACING);
    let smooth = samples.windows(2).all(|pair| {
        let way = pair[1].arc - pair[0].arc;
        let turn = difference_of_angles(pair[1].pose.theta, pair[0].pose.theta).abs();
        // Between two looks the curvature may overshoot, but not by half again.
        way > CUSP * (pair[1].s - pair[0].s) && turn <= 1.5 * max_curvature * way
    });
    smooth
        && samples.iter().all(|sample| {
            let at = sample.pose.position();
            sample.curvature.abs() <= max_curvature && space.keeps(at, ROUNDING)
        })
        && course.body.is_none_or(|body| sweeps(space, body, &samples))
}

/// Whether the outline touches nothing along the samples.
fn sweeps(space: &Space<'_>, body: &Body, samples: &[CurveSample]) -> bool {
    samples.windows(2).all(|pair| {
        let (from, to) = (pair[0].pose, pair[1].pose);
        let turn = difference_of_angles(to.theta, from.theta);
        body.may_move(space.field, from, to.position() - from.position(), turn)
    })
}

/// Curves with stops between them: the way, split at sharp corners until each part has a curve.
fn split(course: &Course<'_>, way: &[Vector2]) -> Option<Vec<Curve>> {
    if let [a, b] = way {
        let line = Curve::line(*a, *b);
        let free = course.body.is_none_or(|body| sweeps(course.space, body, &line.samples(SPACING)));
        return free.then(|| vec![line]);
    }
    let corner = sharpest(way);
    let mut curves = part(course, &way[..=corner])?;
    curves.extend(part(course, &way[corner..])?);
    Some(curves)
}

fn part(course: &Course<'_>, way: &[Vector2]) -> Option<Vec<Curve>> {
    if way.len() > 2 {
        let stretches = stretches(course.space, way, course.config);
        if let Some(curve) = safe_curve(course, &stretches, (Tangent::Free, Tangent::Free), f64::INFINITY) {
            return Some(vec![curve]);
        }
    }
    split(course, way)
}

/// The inner way-point where the way turns most.
fn sharpest(way: &[Vector2]) -> usize {
    let turn =
        |i: usize| difference_of_angles(bearing(way[i + 1] - way[i]), bearing(way[i] - way[i - 1])).abs();
    (1..way.len() - 1).max_by(|i, j| turn(*i).total_cmp(&turn(*j))).expect("invariant: an inner way-point")
}

/// The curves, with turns wherever one's end heading is not the next one's start heading.
fn with_turns(course: &Course<'_>, curves: Vec<Curve>, heading: f64, goal: Pose2) -> Option<Vec<Phase>> {
    let mut phases = Vec::new();
    let mut heading = heading;
    for curve in curves {
        let (start, end) = (curve.pose(0.0), curve.pose(curve.span()));
        phases.extend(turn(course, start, heading, start.theta)?);
        heading = end.theta;
        phases.push(Phase::Drive(curve));
    }
    phases.extend(turn(course, goal, heading, goal.theta)?);
    Some(phases)
}

/// A turn at a place, nothing where there is nothing to turn; `None` where the outline has not the room.
pub(crate) fn turn(course: &Course<'_>, at: Pose2, from: f64, to: f64) -> Option<Option<Phase>> {
    const NOTHING: f64 = 1e-6;
    let from = Pose2::new(at.x, at.y, from);
    let short = difference_of_angles(to, from.theta);
    if short.abs() <= NOTHING {
        return Some(None);
    }
    let angle = match course.body {
        Some(body) => body.turn(course.space.field, from, to)?,
        None => short,
    };
    Some(Some(Phase::Turn { from, angle }))
}

/// The phases through poses of which each is reached from the one before by a turn or straight ahead.
pub(crate) fn straight(course: &Course<'_>, poses: &[Pose2]) -> Option<Vec<Phase>> {
    let mut phases = Vec::new();
    for pair in poses.windows(2) {
        let by = pair[1].position() - pair[0].position();
        if by.norm() > 1e-6 {
            phases.push(Phase::Drive(Curve::line(pair[0].position(), pair[1].position())));
        } else {
            phases.extend(turn(course, pair[0], pair[0].theta, pair[1].theta)?);
        }
    }
    Some(phases)
}
