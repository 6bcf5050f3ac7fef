//! The rectangle in which a path is searched: the grid, extended to start and goal.

use trundle_core::{GridGeometry, Invalid, Vector2};

/// Largest number of cells of an area. Larger areas are refused: memory and time grow with the cells. Source: ours.
const MAX_AREA_CELLS: f64 = 4.0e7;
/// Margin around a start or goal off the grid, m. A smaller one leaves no path around the robot. Source: ours.
const OFF_GRID_MARGIN_M: f64 = 1.0;

/// The smallest rectangle on the grid's lattice that holds the grid, the start and the goal, extended by `beyond` m.
///
/// # Errors
/// When the area would have more than [`MAX_AREA_CELLS`] cells.
pub(crate) fn area(
    grid: &GridGeometry,
    start: Vector2,
    goal: Vector2,
    beyond: f64,
) -> Result<GridGeometry, Invalid> {
    let res = grid.resolution;
    let mut low = Vector2::zeros();
    let mut high = Vector2::new(grid.width as f64, grid.height as f64);
    for point in [start, goal] {
        if grid.cell_at(point).is_none() {
            let at = (point - grid.origin) / res;
            low = low.inf(&at.map(|c| (c - OFF_GRID_MARGIN_M / res).floor()));
            high = high.sup(&at.map(|c| (c + OFF_GRID_MARGIN_M / res).ceil()));
        }
    }
    let grown = (beyond / res).ceil();
    let (low, high) = (low - Vector2::repeat(grown), high + Vector2::repeat(grown));
    let size = high - low;
    if size.x * size.y > MAX_AREA_CELLS {
        let value = format!("{} x {}", size.x, size.y);
        return Err(Invalid::new("planning area", value, "cells", format!("at most {MAX_AREA_CELLS}")));
    }
    GridGeometry::new(res, grid.origin + low * res, size.x as usize, size.y as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_is_kept_where_it_suffices_and_extended_on_its_lattice() {
        let grid = GridGeometry::new(0.1, Vector2::new(-1.0, 0.0), 20, 10).unwrap();
        let inside = Vector2::new(0.0, 0.5);
        assert_eq!(area(&grid, inside, inside, 0.0), Ok(grid));
        let wide = area(&grid, inside, Vector2::new(3.04, 0.52), 0.0).unwrap();
        assert_eq!((wide.width, wide.height), (51, 21), "{wide:?}");
        assert!((wide.origin - Vector2::new(-1.0, -0.5)).norm() < 1e-9, "{wide:?}");
        assert!(area(&grid, inside, Vector2::new(1e9, 0.0), 0.0).is_err());
    }
}
