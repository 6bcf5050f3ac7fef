//! Maximum distance in each block of 4 x 4 cells, for coarse lower bounds.

use super::window::Window;
use trundle_core::GridGeometry;

/// Side of a block \[cells\]. Source: ours.
pub const BLOCK_SIDE_CELLS: usize = 4;

/// Maximum distances of blocks of cells.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BlockMaxima {
    /// Columns of blocks.
    pub width: usize,
    /// Rows of blocks.
    pub height: usize,
    /// Maximum distance of the cells of each block, m, row by row.
    pub distance: Vec<f32>,
}

impl BlockMaxima {
    /// Resizes to the blocks of a grid.
    pub(super) fn resize(&mut self, geometry: &GridGeometry) {
        (self.width, self.height) =
            (geometry.width.div_ceil(BLOCK_SIDE_CELLS), geometry.height.div_ceil(BLOCK_SIDE_CELLS));
        self.distance.resize(self.width * self.height, 0.0);
    }

    /// Recomputes the blocks that meet a window.
    pub(super) fn update(&mut self, geometry: &GridGeometry, distance: &[f32], window: &Window) {
        let cols = window.cols.start / BLOCK_SIDE_CELLS..window.cols.end.div_ceil(BLOCK_SIDE_CELLS);
        for block_row in window.rows.start / BLOCK_SIDE_CELLS..window.rows.end.div_ceil(BLOCK_SIDE_CELLS) {
            let at = block_row * self.width;
            self.distance[at + cols.start..at + cols.end].fill(0.0);
            for row in block_row * BLOCK_SIDE_CELLS..((block_row + 1) * BLOCK_SIDE_CELLS).min(geometry.height)
            {
                let line = &distance[row * geometry.width..(row + 1) * geometry.width];
                let line =
                    &line[cols.start * BLOCK_SIDE_CELLS..(cols.end * BLOCK_SIDE_CELLS).min(geometry.width)];
                for (maximum, cells) in self.distance[at + cols.start..at + cols.end]
                    .iter_mut()
                    .zip(line.chunks(BLOCK_SIDE_CELLS))
                {
                    *maximum = cells.iter().fold(*maximum, |max, d| max.max(*d));
                }
            }
        }
    }
}
