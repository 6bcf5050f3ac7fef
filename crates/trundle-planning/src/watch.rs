//! Whether a plan made on an older map still holds.

use crate::body::{Body, outline_to_square};
use crate::geometry::box_gap;
use crate::outline::DEEPEST;
use crate::{DistanceField, UnknownIs};
use thiserror::Error;
use trundle_core::{Cell, OccupancyGrid, Pose2, Trajectory, Vector2};

/// Where a trajectory would first come too near to something.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("blocked at {time:.2} s: {clearance:.3} m beside the footprint at ({x:.3}, {y:.3})", x = pose.x, y = pose.y)]
pub struct Obstruction {
    /// Seconds since the trajectory's start.
    pub time: f64,
    /// Where the robot would be.
    pub pose: Pose2,
    /// Room beside the footprint there, m, negative: so much is missing.
    pub clearance: f64,
}

/// Distance between two looks, m.
const SPACING: f64 = 0.01;

/// A grid, and what its unknown cells count as.
pub(crate) type Layer<'a> = (&'a OccupancyGrid, UnknownIs);

/// A disc is looked at so much smaller, m: rounding of the curve.
const SLACK: f64 = 2e-4;
/// An outline is looked at so much smaller, m: what a sweep may have missed.
const MISSED: f64 = 5e-4;

/// The body as a plan under way is watched with: what a plan may have missed is no obstruction.
pub(crate) fn slim(body: &Body) -> Body {
    body.shrunk(if body.is_disc() { SLACK } else { MISSED }).unwrap_or_else(|| body.clone())
}

/// A robot that overlaps something where it stands, and everything around it.
pub(crate) struct Exit {
    pub(crate) field: DistanceField,
    pub(crate) body: Body,
}

impl Exit {
    /// Of a body at a pose, in a grid of the cells around it; `None` where its middle is inside something.
    pub(crate) fn new(around: &OccupancyGrid, unknown: UnknownIs, pose: Pose2, body: &Body) -> Option<Self> {
        let reach = body.radius + 4.0 * around.geometry().resolution;
        let field = DistanceField::up_to(reach, around, unknown);
        let depth = body.overlap(&field, pose, deepest(body));
        let body = body.leaving(&field, pose, depth + SLACK)?;
        (body.gap(&field, pose, SLACK) > 0.0).then_some(Self { field, body })
    }
}

/// How far inside something a body may be and still leave it, m.
pub(crate) fn deepest(body: &Body) -> f64 {
    if body.is_disc() { body.radius } else { DEEPEST }
}

/// Checks a trajectory of a [`slim`] body from `from` seconds on, against every layer. Where it overlaps something at once,
/// `exit` says what, and it may go on as long as it comes no deeper, until it has left.
pub(crate) fn still_free(
    layers: &[Layer<'_>],
    trajectory: &Trajectory,
    from: f64,
    body: &Body,
    exit: impl FnOnce(Pose2) -> Option<Exit>,
) -> Result<(), Obstruction> {
    let room = |pose| layers.iter().map(|layer| room(*layer, pose, body)).fold(body.needs(), f64::min);
    let required = if body.is_disc() { body.needs() } else { f64::MIN_POSITIVE };
    let obstruction = |time, pose| Obstruction { time, pose, clearance: room(pose).max(0.0) - body.needs() };
    let mut last = trajectory.at(from);
    let is_inside = room(last.pose) < required;
    let exit = if is_inside { exit(last.pose) } else { None };
    if is_inside && exit.is_none() {
        return Err(obstruction(from, last.pose));
    }
    let is_free = |pose| match &exit {
        Some(exit) if exit.body.is_leaving(pose) => exit.body.gap(&exit.field, pose, SLACK) > 0.0,
        _ => room(pose) >= required,
    };
    for point in trajectory.points().iter().filter(|point| point.time > from) {
        let turn = trundle_core::difference_of_angles(point.pose.theta, last.pose.theta);
        let turned = if body.is_disc() { 0.0 } else { body.radius * turn.abs() };
        let steps = ((point.pose.distance(&last.pose) + turned) / SPACING).ceil();
        for k in 1..=steps as usize {
            let share = k as f64 / steps;
            let pose = last.pose.interpolate(&point.pose, share);
            if !is_free(pose) {
                return Err(obstruction(last.time + (point.time - last.time) * share, pose));
            }
        }
        last = *point;
    }
    Ok(())
}

/// How much room there is for what the body needs ([`Body::needs`]), at most that, m: from the axle for a disc, beside the
/// outline for a polygon.
fn room((grid, unknown): Layer<'_>, pose: Pose2, body: &Body) -> f64 {
    let (point, cap, outline) = (pose.position(), body.needs(), body.outline(pose));
    let geometry = grid.geometry();
    let half = geometry.resolution / 2.0;
    let reach = (body.radius / geometry.resolution).ceil() as i64 + 1;
    let at = (point - geometry.origin) / geometry.resolution;
    let (col, row) = (at.x.floor() as i64, at.y.floor() as i64);
    let mut best = cap;
    for r in row - reach..=row + reach {
        for c in col - reach..=col + reach {
            let inside = r >= 0 && c >= 0 && r < geometry.height as i64 && c < geometry.width as i64;
            let cell =
                if inside { grid.cells()[r as usize * geometry.width + c as usize] } else { Cell::Unknown };
            let blocks = cell == Cell::Occupied || (cell == Cell::Unknown && unknown == UnknownIs::Obstacle);
            if blocks {
                let centre =
                    geometry.origin + Vector2::new(c as f64 + 0.5, r as f64 + 0.5) * geometry.resolution;
                let gap = match outline[..] {
                    [] => box_gap(point, centre, half).norm(),
                    _ => outline_to_square(&outline, centre, half, cap),
                };
                best = best.min(gap);
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Footprint, TrajectoryPoint, Twist2};

    #[test]
    fn a_new_obstacle_is_seen_ahead_and_not_behind() {
        let mut grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(40); 10].join("\n")).unwrap();
        let disc = Body::new(&Footprint::Disc { radius: 0.2 });
        let at = |time: f64| TrajectoryPoint {
            time,
            pose: Pose2::new(0.5 + time, 0.5, 0.0),
            twist: Twist2::new(1.0, 0.0),
        };
        let trajectory = Trajectory::new(vec![at(0.0), at(1.5), at(3.0)]).unwrap();
        let check = |grid: &OccupancyGrid, from| {
            still_free(&[(grid, UnknownIs::Free)], &trajectory, from, &disc, |_| None)
        };
        assert!(check(&grid, 0.0).is_ok());
        grid.set(trundle_core::CellIndex { col: 20, row: 5 }, Cell::Occupied);
        let hit = check(&grid, 0.0).unwrap_err();
        assert!((hit.pose.x - 1.8).abs() < 0.02 && (hit.time - 1.3).abs() < 0.02, "{hit}");
        assert!(check(&grid, 1.9).is_ok());
    }
}
