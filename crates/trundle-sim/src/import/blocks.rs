//! Decomposition of a grid's occupied cells into rectangles.

use trundle_core::{Cell, GridGeometry, OccupancyGrid};

/// A rectangle of cells: first and one past the last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Block {
    pub(super) cols: (usize, usize),
    pub(super) rows: (usize, usize),
}

/// The occupied cells as rectangles, greedily: from the lowest left cell the widest run of its row, then all following rows that contain
/// the whole run. O(cells).
pub(super) fn blocks(grid: &OccupancyGrid) -> Vec<Block> {
    let GridGeometry { width, height, .. } = *grid.geometry();
    let mut open: Vec<bool> = grid.cells().iter().map(|&cell| cell == Cell::Occupied).collect();
    let mut blocks = Vec::new();
    for row in 0..height {
        for col in 0..width {
            if !open[row * width + col] {
                continue;
            }
            let run = open[row * width + col..(row + 1) * width].iter().take_while(|&&open| open).count();
            let is_open =
                |row: usize| open[row * width + col..row * width + col + run].iter().all(|&open| open);
            let end = (row..height).find(|&row| !is_open(row)).unwrap_or(height);
            for row in row..end {
                open[row * width + col..row * width + col + run].fill(false);
            }
            blocks.push(Block { cols: (col, col + run), rows: (row, end) });
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_are_wide_first_and_cover_every_cell_once() {
        let map = OccupancyGrid::from_ascii(1.0, "..#.\n###.\n###.\n....").unwrap();
        let found = blocks(&map);
        assert_eq!(found, [Block { cols: (0, 3), rows: (1, 3) }, Block { cols: (2, 3), rows: (3, 4) }]);
    }
}
