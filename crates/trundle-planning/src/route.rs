//! From way-points to what the robot does: turns on the spot and verified curves.
//!
//! A curve that meets both headings is tried first; where it has not the room, the robot turns on the spot at the end,
//! at the start, or at both; where even that fails, the way is split at its sharpest corner. A stretch between two
//! way-points is a straight line, which is free already: so there always is a route.

use crate::fit::{CurveConfig, Stretch, Tangent, fit, stretches};
use crate::geometry::bearing;
use crate::{curve::Curve, space::Space};
use std::f64::consts::PI;
use trundle_core::{Pose2, Vector2, difference_of_angles};

/// One thing that the robot does without stopping in between.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    /// Turns on the spot.
    Turn {
        /// Where, map frame; its heading is the one before.
        from: Pose2,
        /// By how much, counter-clockwise, rad, in (-pi, pi].
        angle: f64,
    },
    /// Drives along a curve, forward.
    Drive(Curve),
}

/// Spacing of the looks along a curve, m: between two, an obstacle's distance dips by at most spacing^2 / 8 radius.
const SPACING: f64 = 0.01;
/// Parametric speed below which a curve counts as broken: a cusp is near.
const CUSP: f64 = 0.1;
/// A room smaller by this than required is rounding of the solver, m.
const ROUNDING: f64 = 1e-4;

/// The phases that lead from `start` to `goal` along the free `way`. `moving`: the curvature of a motion under way at
/// `start`; then `None` when no curve continues it. Always a route otherwise.
pub(crate) fn route(
    space: &Space<'_>,
    way: &[Vector2],
    start: Pose2,
    goal: Pose2,
    moving: Option<f64>,
    config: &CurveConfig,
) -> Option<Vec<Phase>> {
    let stretches = stretches(space, way, config);
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
            if let Some(curve) = safe_curve(space, &stretches, (*start_tangent, *end_tangent), config) {
                return Some(with_turns(vec![curve], start.theta, goal));
            }
        }
    }
    moving.is_none().then(|| with_turns(split(space, way, config), start.theta, goal))
}

/// A curve that was measured and found free, at one of two smoothings.
fn safe_curve(
    space: &Space<'_>,
    stretches: &[Stretch],
    tangents: (Tangent, Tangent),
    config: &CurveConfig,
) -> Option<Curve> {
    [1.0, 2.0].into_iter().find_map(|factor| {
        fit(stretches, tangents, config.smoothing * factor, config)
            .filter(|curve| is_drivable(space, curve, config.max_curvature))
    })
}

/// Whether the curve keeps the required room everywhere, and bends no more than allowed.
pub(crate) fn is_drivable(space: &Space<'_>, curve: &Curve, max_curvature: f64) -> bool {
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
            sample.curvature.abs() <= max_curvature && space.field.keeps(at, space.required(at) - ROUNDING)
        })
}

/// Curves with stops between them: the way, split at sharp corners until each part has a curve.
fn split(space: &Space<'_>, way: &[Vector2], config: &CurveConfig) -> Vec<Curve> {
    if let [a, b] = way {
        return vec![Curve::line(*a, *b)];
    }
    let corner = sharpest(way);
    let mut curves = part(space, &way[..=corner], config);
    curves.extend(part(space, &way[corner..], config));
    curves
}

fn part(space: &Space<'_>, way: &[Vector2], config: &CurveConfig) -> Vec<Curve> {
    if way.len() > 2 {
        let stretches = stretches(space, way, config);
        if let Some(curve) = safe_curve(space, &stretches, (Tangent::Free, Tangent::Free), config) {
            return vec![curve];
        }
    }
    split(space, way, config)
}

/// The inner way-point where the way turns most.
fn sharpest(way: &[Vector2]) -> usize {
    let turn =
        |i: usize| difference_of_angles(bearing(way[i + 1] - way[i]), bearing(way[i] - way[i - 1])).abs();
    (1..way.len() - 1).max_by(|i, j| turn(*i).total_cmp(&turn(*j))).expect("invariant: an inner way-point")
}

/// The curves, with turns wherever one's end heading is not the next one's start heading.
fn with_turns(curves: Vec<Curve>, heading: f64, goal: Pose2) -> Vec<Phase> {
    let mut phases = Vec::new();
    let mut heading = heading;
    for curve in curves {
        let (start, end) = (curve.pose(0.0), curve.pose(curve.span()));
        phases.extend(turn(start, heading, start.theta));
        heading = end.theta;
        phases.push(Phase::Drive(curve));
    }
    phases.extend(turn(goal, heading, goal.theta));
    phases
}

/// A turn at a place, unless there is nothing to turn.
pub(crate) fn turn(at: Pose2, from: f64, to: f64) -> Option<Phase> {
    const NOTHING: f64 = 1e-6;
    let angle = difference_of_angles(to, from);
    debug_assert!(angle.abs() <= PI, "turn of {angle} rad");
    (angle.abs() > NOTHING).then(|| Phase::Turn { from: Pose2::new(at.x, at.y, from), angle })
}
