//! The most room in each block of 4 x 4 cells: where a robot surely does not fit, and how little a way through may cost.

use super::window::Window;
use trundle_core::GridGeometry;

/// Cells along a block's side.
pub(crate) const SIDE: usize = 4;

/// Greatest distances of blocks.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Blocks {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Of each block, the greatest distance of its cells, m.
    pub(crate) room: Vec<f32>,
}

impl Blocks {
    /// Fits the size to a grid's.
    pub(super) fn resize(&mut self, geometry: &GridGeometry) {
        (self.width, self.height) = (geometry.width.div_ceil(SIDE), geometry.height.div_ceil(SIDE));
        self.room.resize(self.width * self.height, 0.0);
    }

    /// Takes over the distances inside a window.
    pub(super) fn update(&mut self, geometry: &GridGeometry, distance: &[f32], window: &Window) {
        let cols = window.cols.start / SIDE..window.cols.end.div_ceil(SIDE);
        for block_row in window.rows.start / SIDE..window.rows.end.div_ceil(SIDE) {
            let at = block_row * self.width;
            self.room[at + cols.start..at + cols.end].fill(0.0);
            for row in block_row * SIDE..((block_row + 1) * SIDE).min(geometry.height) {
                let line = &distance[row * geometry.width..(row + 1) * geometry.width];
                let line = &line[cols.start * SIDE..(cols.end * SIDE).min(geometry.width)];
                for (room, cells) in
                    self.room[at + cols.start..at + cols.end].iter_mut().zip(line.chunks(SIDE))
                {
                    *room = cells.iter().fold(*room, |most, d| most.max(*d));
                }
            }
        }
    }
}
