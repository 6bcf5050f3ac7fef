//! A rotated map.

use super::lattice::covering_lattice;
use super::resample::resampled;
use std::f64::consts::FRAC_PI_2;
use trundle_core::{Invalid, OccupancyGrid, Pose2, Vector2};

/// Largest distance of a turn from a right angle at which cells are copied one to one \[rad\]: 1 mm at 100 m. Source: ours.
const MAX_COPIED_TURN_RAD: f64 = 1e-5;

/// The known part of a map, rotated by `turn` rad counter-clockwise about the origin of the map frame, with cells of the same size.
///
/// `map_from_grid` is the pose of the grid in the map frame: of a picture that is itself turned. The grid is resampled once, for both
/// turns. Right angles lose nothing.
///
/// # Errors When the map has no known cell, or the new grid too many cells.
pub fn rotated(grid: &OccupancyGrid, map_from_grid: Pose2, turn: f64) -> Result<OccupancyGrid, Invalid> {
    let pose = Pose2::new(0.0, 0.0, turn) * map_from_grid;
    let quarters = pose.theta / FRAC_PI_2;
    let is_copied = ((quarters - quarters.round()) * FRAC_PI_2).abs() <= MAX_COPIED_TURN_RAD;
    // After a right angle the cells of the old lattice are those of the new one.
    let anchor = if is_copied { pose.transform(grid.geometry().origin) } else { Vector2::zeros() };
    let geometry = covering_lattice(&[(grid, pose)], grid.geometry().resolution, anchor)?;
    Ok(resampled(grid, pose, geometry))
}

/// The map along the axes of the map frame: the grid itself, or the known part of a grid that is turned, resampled once.
///
/// # Errors
/// As [`rotated`].
pub fn upright(grid: OccupancyGrid, map_from_grid: Pose2) -> Result<OccupancyGrid, Invalid> {
    if map_from_grid == Pose2::IDENTITY { Ok(grid) } else { rotated(&grid, map_from_grid, 0.0) }
}
