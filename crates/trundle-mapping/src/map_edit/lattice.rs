//! The cells of a frame that hold moved maps.

use trundle_core::{Cell, GridGeometry, Invalid, OccupancyGrid, Pose2, Vector2};

/// Part of a cell by which rounding may move a corner without a further row or column of cells. Source: ours.
const CORNER_ROUNDING_CELLS: f64 = 1e-6;

/// The smallest geometry that holds the known cells of maps moved by their poses, with cells of `resolution` m and a corner at `anchor`.
///
/// # Errors
/// When no map has a known cell, or the cells are too many for a grid.
pub fn covering_lattice(
    maps: &[(&OccupancyGrid, Pose2)],
    resolution: f64,
    anchor: Vector2,
) -> Result<GridGeometry, Invalid> {
    let mut bounds: Option<(Vector2, Vector2)> = None;
    for (grid, pose) in maps {
        for corner in known_corners(grid) {
            let at = (pose.transform(corner) - anchor) / resolution;
            let (low, high) = bounds.unwrap_or((at, at));
            bounds = Some((low.inf(&at), high.sup(&at)));
        }
    }
    let Some((low, high)) = bounds else {
        return Err(Invalid::new("number of known cells", 0, "", "1 or more"));
    };
    let low = low.map(|v| (v + CORNER_ROUNDING_CELLS).floor());
    let size = high.map(|v| (v - CORNER_ROUNDING_CELLS).ceil()) - low;
    GridGeometry::new(resolution, anchor + low * resolution, size.x as usize, size.y as usize)
}

/// The smallest geometry on the cells of the first map that holds the known cells of all maps; the first map's pose is the identity.
///
/// # Errors
/// As [`covering_lattice`].
pub fn lattice_of(
    first: &OccupancyGrid,
    others: &[(&OccupancyGrid, Pose2)],
) -> Result<GridGeometry, Invalid> {
    let GridGeometry { resolution, origin, .. } = *first.geometry();
    let maps: Vec<_> = std::iter::once((first, Pose2::IDENTITY)).chain(others.iter().copied()).collect();
    covering_lattice(&maps, resolution, origin)
}

/// Corners of the first and the last known cell of each row, whose convex hull holds all known cells, map frame \[m\].
fn known_corners(grid: &OccupancyGrid) -> Vec<Vector2> {
    let GridGeometry { resolution, origin, width, .. } = *grid.geometry();
    let mut corners = Vec::new();
    for (row, cells) in grid.cells().chunks_exact(width).enumerate() {
        let is_known = |cell: &Cell| *cell != Cell::Unknown;
        let (Some(first), Some(last)) = (cells.iter().position(is_known), cells.iter().rposition(is_known))
        else {
            continue;
        };
        for (col, row) in [(first, row), (last + 1, row), (first, row + 1), (last + 1, row + 1)] {
            corners.push(origin + Vector2::new(col as f64, row as f64) * resolution);
        }
    }
    corners
}
