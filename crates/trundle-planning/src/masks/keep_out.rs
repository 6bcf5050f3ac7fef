//! Keep-out areas, and other changes of the grid before planning.

use crate::area::area;
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Pose2, Vector2};

/// The grid with every cell occupied that a keep-out mask touches; the mask may have another lattice. With `grow`, the grid is extended to
/// contain the mask's occupied cells.
///
/// # Errors
/// When the extended grid would have too many cells.
pub(crate) fn kept_out(
    grid: &OccupancyGrid,
    mask: &OccupancyGrid,
    grow: bool,
) -> Result<OccupancyGrid, Invalid> {
    let forbidden = || mask.cells().iter().enumerate().filter(|(_, cell)| **cell == Cell::Occupied);
    let square = |linear: usize| {
        let (centre, half) =
            (mask.geometry().center(mask.geometry().cell(linear)), mask.geometry().resolution / 2.0);
        (centre - Vector2::repeat(half), centre + Vector2::repeat(half))
    };
    let mut merged = grid.clone();
    if grow && let Some((first, _)) = forbidden().next() {
        let whole = forbidden().fold(square(first), |(low, high), (linear, _)| {
            let (a, b) = square(linear);
            (low.inf(&a), high.sup(&b))
        });
        merged = cut(grid, area(grid.geometry(), whole.0, whole.1, 0.0)?);
    }
    forbidden().for_each(|(linear, _)| occupy(&mut merged, square(linear)));
    Ok(merged)
}

/// The grid over another geometry of its lattice; added cells are unknown.
pub(crate) fn cut(grid: &OccupancyGrid, geometry: GridGeometry) -> OccupancyGrid {
    if geometry == *grid.geometry() {
        return grid.clone();
    }
    let cells = (0..geometry.len()).map(|linear| grid.at(geometry.center(geometry.cell(linear))));
    OccupancyGrid::new(geometry, cells.collect()).expect("invariant: a cell for each")
}

/// Occupies the cells that a box overlaps.
fn occupy(grid: &mut OccupancyGrid, (low, high): (Vector2, Vector2)) {
    /// Overlap below which a cell is not touched, as a share of a cell: rounding. Source: ours.
    const MIN_OVERLAP_CELLS: f64 = 1e-6;
    let GridGeometry { resolution, origin, width, height } = *grid.geometry();
    let span = |low: f64, high: f64, size: usize| {
        let first = (low / resolution + MIN_OVERLAP_CELLS).floor().clamp(0.0, size as f64);
        let end = (high / resolution - MIN_OVERLAP_CELLS).ceil().clamp(0.0, size as f64);
        first as usize..end as usize
    };
    let (low, high) = (low - origin, high - origin);
    for row in span(low.y, high.y, height) {
        for col in span(low.x, high.x, width) {
            grid.set(CellIndex { col, row }, Cell::Occupied);
        }
    }
}

/// Whether the space at the robot's front at a pose is unknown.
pub(crate) fn is_unknown_ahead(grid: &OccupancyGrid, pose: Pose2, radius: f64) -> bool {
    grid.at(pose.position() + pose.direction() * radius) == Cell::Unknown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mask_with_finer_cells_forbids_every_cell_that_it_touches() {
        let grid = OccupancyGrid::from_ascii(0.1, "....\n....\n....").unwrap();
        let geometry = GridGeometry::new(0.02, Vector2::new(0.12, 0.0), 1, 20).unwrap();
        let thin = OccupancyGrid::filled(geometry, Cell::Occupied);
        let merged = kept_out(&grid, &thin, false).unwrap();
        assert_eq!(merged, OccupancyGrid::from_ascii(0.1, ".#..\n.#..\n.#..").unwrap());
        let wider = kept_out(&grid, &thin, true).unwrap();
        assert!(wider.geometry().height > 3 && wider.at(Vector2::new(0.13, 0.39)) == Cell::Occupied);
        assert_eq!(
            (wider.at(Vector2::new(0.05, 0.39)), wider.at(Vector2::new(0.05, 0.05))),
            (Cell::Unknown, Cell::Free)
        );
    }

    #[test]
    fn a_mask_on_the_same_lattice_forbids_exactly_its_cells() {
        let grid = OccupancyGrid::filled(
            GridGeometry::new(0.05, Vector2::new(-3.1, 2.7), 70, 40).unwrap(),
            Cell::Free,
        );
        let mut mask = grid.clone();
        for (col, row) in [(0, 0), (69, 39), (33, 17), (34, 17)] {
            mask.set(CellIndex { col, row }, Cell::Occupied);
        }
        assert_eq!(kept_out(&grid, &mask, false).unwrap(), mask);
    }
}
