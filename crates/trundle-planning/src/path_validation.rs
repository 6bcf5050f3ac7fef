//! Validation of a plan on a newer map.

use crate::polygon::robot_shape::{MAX_OVERLAP_M, RobotShape};
use thiserror::Error;
use trundle_collision::square::{point_to_square, polygon_to_square};
use trundle_core::{Cell, OccupancyGrid, Pose2, Trajectory, Vector2};
use trundle_grid::{DistanceField, UnknownIs};

/// First contact along a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("blocked at {time:.2} s: {clearance:.3} m beside the footprint at ({x:.3}, {y:.3})", x = pose.x, y = pose.y)]
pub struct Obstruction {
    /// Seconds since the trajectory's start.
    pub time: f64,
    /// Pose at the contact.
    pub pose: Pose2,
    /// Clearance of the footprint at the contact, m, negative: the missing distance.
    pub clearance: f64,
}

/// Distance between two checks, m. Source: ours.
const CHECK_SPACING_M: f64 = 0.01;

/// A grid, and the meaning of its unknown cells.
pub(crate) type Layer<'a> = (&'a OccupancyGrid, UnknownIs);

/// Reduction of a disc for the check, m: rounding of the curve. Source: ours.
const DISC_REDUCTION_M: f64 = 2e-4;
/// Reduction of a polygon for the check, m: overlap that a sweep may have missed. Source: ours.
const POLYGON_REDUCTION_M: f64 = 5e-4;

/// The shape for the check, reduced by the largest overlap that planning may miss.
pub(crate) fn reduced_shape(shape: &RobotShape) -> RobotShape {
    let reduction = if shape.is_disc() { DISC_REDUCTION_M } else { POLYGON_REDUCTION_M };
    shape.shrunk(reduction).unwrap_or_else(|| shape.clone())
}

/// A robot that overlaps an obstacle at the start of the check, with the field around it.
pub(crate) struct ShapeEscape {
    pub(crate) field: DistanceField,
    pub(crate) shape: RobotShape,
}

impl ShapeEscape {
    /// For a shape at a pose, in a grid of the cells around it; `None` if its centre is inside an obstacle.
    pub(crate) fn new(
        around: &OccupancyGrid,
        unknown: UnknownIs,
        pose: Pose2,
        shape: &RobotShape,
    ) -> Option<Self> {
        let reach = shape.radius + 4.0 * around.geometry().resolution;
        let field = DistanceField::up_to(reach, around, unknown);
        let depth = shape.overlap(&field, pose, max_overlap(shape));
        let shape = shape.escaping(&field, pose, depth + DISC_REDUCTION_M)?;
        (shape.gap(&field, pose, DISC_REDUCTION_M) > 0.0).then_some(Self { field, shape })
    }
}

/// Largest overlap from which a shape may leave, m.
pub(crate) fn max_overlap(shape: &RobotShape) -> f64 {
    if shape.is_disc() { shape.radius } else { MAX_OVERLAP_M }
}

/// Checks the trajectory of a [`reduced_shape`] shape from `from` seconds on, against every layer. For a shape that overlaps an obstacle at
/// the start, `escape` describes the overlap. The shape may continue while its overlap does not grow, until it is free.
pub(crate) fn validate_layers(
    layers: &[Layer<'_>],
    trajectory: &Trajectory,
    from: f64,
    shape: &RobotShape,
    escape: impl FnOnce(Pose2) -> Option<ShapeEscape>,
) -> Result<(), Obstruction> {
    let clearance =
        |pose| layers.iter().map(|layer| clearance(*layer, pose, shape)).fold(shape.needs(), f64::min);
    let required = if shape.is_disc() { shape.needs() } else { f64::MIN_POSITIVE };
    let obstruction =
        |time, pose| Obstruction { time, pose, clearance: clearance(pose).max(0.0) - shape.needs() };
    let mut last = trajectory.at(from);
    let is_inside = clearance(last.pose) < required;
    let escape = if is_inside { escape(last.pose) } else { None };
    if is_inside && escape.is_none() {
        return Err(obstruction(from, last.pose));
    }
    let is_free = |pose| match &escape {
        Some(escape) if escape.shape.is_escaping(pose) => {
            escape.shape.gap(&escape.field, pose, DISC_REDUCTION_M) > 0.0
        }
        _ => clearance(pose) >= required,
    };
    for point in trajectory.points().iter().filter(|point| point.time > from) {
        let turn = trundle_core::difference_of_angles(point.pose.theta, last.pose.theta);
        let turned = if shape.is_disc() { 0.0 } else { shape.radius * turn.abs() };
        let steps = ((point.pose.distance(&last.pose) + turned) / CHECK_SPACING_M).ceil();
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

/// The clearance at a pose, at most the required clearance of the shape ([`RobotShape::needs`]), m: from the axle for a disc, from the
/// boundary for a polygon.
fn clearance((grid, unknown): Layer<'_>, pose: Pose2, shape: &RobotShape) -> f64 {
    let (point, cap, outline) = (pose.position(), shape.needs(), shape.outline(pose));
    let geometry = grid.geometry();
    let half = geometry.resolution / 2.0;
    let reach = (shape.radius / geometry.resolution).ceil() as i64 + 1;
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
                    [] => point_to_square(point, centre, half).norm(),
                    _ => polygon_to_square(&outline, centre, half, cap),
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
    fn a_new_obstacle_ahead_is_found_and_one_behind_is_not() {
        let mut grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(40); 10].join("\n")).unwrap();
        let disc = RobotShape::new(&Footprint::Disc { radius: 0.2 });
        let at = |time: f64| TrajectoryPoint {
            time,
            pose: Pose2::new(0.5 + time, 0.5, 0.0),
            twist: Twist2::new(1.0, 0.0),
        };
        let trajectory = Trajectory::new(vec![at(0.0), at(1.5), at(3.0)]).unwrap();
        let check = |grid: &OccupancyGrid, from| {
            validate_layers(&[(grid, UnknownIs::Free)], &trajectory, from, &disc, |_| None)
        };
        assert!(check(&grid, 0.0).is_ok());
        grid.set(trundle_core::CellIndex { col: 20, row: 5 }, Cell::Occupied);
        let hit = check(&grid, 0.0).unwrap_err();
        assert!((hit.pose.x - 1.8).abs() < 0.02 && (hit.time - 1.3).abs() < 0.02, "{hit}");
        assert!(check(&grid, 1.9).is_ok());
    }
}
