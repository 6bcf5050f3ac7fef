//! A grid with cells of half the side: it finds paths through gaps in which no cell centre of the original grid is free.

use trundle_core::{GridGeometry, OccupancyGrid};

/// Largest number of cells of a refined grid. Larger grids are not tried: memory and time grow with the cells. Source: ours.
const MAX_REFINED_CELLS: usize = 16_000_000;

/// The same grid in cells of half the side; `None` if it would have too many.
pub(crate) fn refined(grid: &OccupancyGrid) -> Option<OccupancyGrid> {
    let GridGeometry { resolution, origin, width, height } = *grid.geometry();
    let geometry = GridGeometry::new(resolution / 2.0, origin, 2 * width, 2 * height).ok()?;
    if geometry.len() > MAX_REFINED_CELLS {
        return None;
    }
    let mut cells = Vec::with_capacity(geometry.len());
    for row in grid.cells().chunks_exact(width) {
        for _ in 0..2 {
            cells.extend(row.iter().flat_map(|cell| [*cell, *cell]));
        }
    }
    OccupancyGrid::new(geometry, cells).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    #[test]
    fn refinement_keeps_every_point() {
        let grid = OccupancyGrid::from_ascii(0.4, "#.?\n..#").unwrap();
        let fine = refined(&grid).unwrap();
        for i in 0..600 {
            let at = Vector2::new(f64::from(i % 30) * 0.041, f64::from(i / 30) * 0.041);
            assert_eq!(fine.at(at), grid.at(at), "{at}");
        }
    }
}
