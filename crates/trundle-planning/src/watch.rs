//! Whether a plan made on an older map still holds.

use crate::UnknownIs;
use crate::body::{Body, outline_to_square};
use crate::geometry::box_gap;
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

/// A disc may miss so much room: rounding of the curve, m.
const SLACK: f64 = 2e-4;
/// An outline is looked at so much smaller, m: what a sweep may have missed.
const MISSED: f64 = 5e-4;
/// How deep an outline may overlap what it leaves, m: tried one after the other.
const DEPTHS: [f64; 6] = [0.01, 0.02, 0.03, 0.04, 0.05, 0.065];
/// How far from where it stands a robot that already has less room may have no more, m, beside the room that is missing.
const ZONE: f64 = 0.2;

/// Checks a trajectory from `from` seconds on, against every layer. A robot that already has less room may go on as long as it
/// gets no nearer, until it has left.
pub(crate) fn still_free(
    layers: &[Layer<'_>],
    trajectory: &Trajectory,
    from: f64,
    body: &Body,
) -> Result<(), Obstruction> {
    let slim = body.shrunk(MISSED);
    let body = slim.as_ref().unwrap_or(body);
    let mut last = trajectory.at(from);
    let room = |pose| layers.iter().map(|layer| room(*layer, pose, body)).fold(body.needs(), f64::min);
    let (here, now) = (last.pose, room(last.pose));
    let slack = if body.is_disc() { SLACK } else { body.needs() - 1e-9 };
    let is_leaving = |pose: &Pose2| now < body.needs() && pose.distance(&here) <= body.needs() - now + ZONE;
    let within = |pose, body: &Body| {
        layers.iter().map(|layer| self::room(*layer, pose, body)).fold(body.needs(), f64::min)
    };
    // An outline that overlaps something may leave it no deeper than it is.
    let overlaps = !body.is_disc() && now <= 0.0;
    let inner = DEPTHS.iter().filter(|_| overlaps).filter_map(|depth| body.shrunk(*depth));
    let inner = inner.into_iter().find(|inner| within(here, inner) > 0.0);
    if overlaps && inner.is_none() {
        return Err(Obstruction { time: from, pose: here, clearance: -DEPTHS[DEPTHS.len() - 1] });
    }
    let leaving_room = |pose| match &inner {
        Some(inner) if within(pose, inner) > 0.0 => now,
        Some(_) => f64::NEG_INFINITY,
        None => room(pose),
    };
    for point in trajectory.points().iter().filter(|point| point.time > from) {
        let turn = trundle_core::difference_of_angles(point.pose.theta, last.pose.theta);
        let turned = if body.is_disc() { 0.0 } else { body.radius * turn.abs() };
        let way = point.pose.distance(&last.pose) + turned;
        if way == 0.0 {
            last = *point;
            continue;
        }
        let steps = (way / SPACING).ceil();
        for k in 1..=steps as usize {
            let share = k as f64 / steps;
            let pose = last.pose.interpolate(&point.pose, share);
            let (distance, required) = if is_leaving(&pose) {
                (leaving_room(pose), now - 1e-6)
            } else {
                (room(pose), body.needs() - slack)
            };
            if distance < required {
                let time = last.time + (point.time - last.time) * share;
                return Err(Obstruction { time, pose, clearance: distance.max(0.0) - body.needs() });
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
        assert!(still_free(&[(&grid, UnknownIs::Free)], &trajectory, 0.0, &disc).is_ok());
        grid.set(trundle_core::CellIndex { col: 20, row: 5 }, Cell::Occupied);
        let hit = still_free(&[(&grid, UnknownIs::Free)], &trajectory, 0.0, &disc).unwrap_err();
        assert!((hit.pose.x - 1.8).abs() < 0.02 && (hit.time - 1.3).abs() < 0.02, "{hit}");
        assert!(still_free(&[(&grid, UnknownIs::Free)], &trajectory, 1.9, &disc).is_ok());
    }
}
