//! A lattice between the cells: for gaps that a robot passes, but no cell's centre in them has the room.

use trundle_core::{GridGeometry, OccupancyGrid};

/// Cells of the finer grid above which it is not tried: memory and time would be out of proportion.
const MOST_CELLS: usize = 16_000_000;

/// The same grid in cells of half the side; `None` where it would have too many.
pub(crate) fn finer(grid: &OccupancyGrid) -> Option<OccupancyGrid> {
    let GridGeometry { resolution, origin, width, height } = *grid.geometry();
    let geometry = GridGeometry::new(resolution / 2.0, origin, 2 * width, 2 * height).ok()?;
    if geometry.len() > MOST_CELLS {
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
    fn nothing_moves() {
        let grid = OccupancyGrid::from_ascii(0.4, "#.?\n..#").unwrap();
        let fine = finer(&grid).unwrap();
        for i in 0..600 {
            let at = Vector2::new(f64::from(i % 30) * 0.041, f64::from(i / 30) * 0.041);
            assert_eq!(fine.at(at), grid.at(at), "{at}");
        }
    }
}
