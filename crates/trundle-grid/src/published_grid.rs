//! Three-valued occupancy grid with in-place updates and a list of its changed tiles.

use crate::GridCell;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};

/// Thresholds that turn log-odds into free, occupied or unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thresholds<T> {
    /// Log-odds above which a cell is occupied.
    pub occupied_above: T,
    /// Log-odds below which a cell is free.
    pub free_below: T,
}

impl<T: PartialOrd> Thresholds<T> {
    /// Class of a cell with these log-odds.
    pub fn classify(&self, log_odds: T) -> Cell {
        if log_odds > self.occupied_above {
            Cell::Occupied
        } else if log_odds < self.free_below {
            Cell::Free
        } else {
            Cell::Unknown
        }
    }
}

/// Occupancy grid of whole tiles. Each tile has a revision number, by which readers fetch only changed tiles.
///
/// Writing a cell is O(1). The grid gets a new layout only when its bounding box grows.
#[derive(Debug, Clone)]
pub struct PublishedGrid {
    grid: OccupancyGrid,
    /// Lowest tile, and (columns, rows) of tiles.
    first: (i32, i32),
    size: (usize, usize),
    /// Side of a tile, cells.
    tile_side: usize,
    resolution: f64,
    revision: u64,
    /// Revision of the last change of each tile, row by row.
    changed: Vec<u64>,
}

impl PublishedGrid {
    /// Grid of unknown cells of `resolution` m. `first` is the lowest tile of `tile_side` x `tile_side` cells, `size` the (columns,
    /// rows) of tiles.
    pub fn new(resolution: f64, tile_side: usize, first: (i32, i32), size: (usize, usize)) -> Self {
        Self {
            grid: unknown(resolution, tile_side, first, size),
            first,
            size,
            tile_side,
            resolution,
            revision: 0,
            changed: vec![0; size.0 * size.1],
        }
    }

    /// The occupancy grid.
    pub fn grid(&self) -> &OccupancyGrid {
        &self.grid
    }

    /// Number of the current revision.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Begins a revision. Later writes belong to this revision.
    pub fn begin_revision(&mut self) {
        self.revision += 1;
    }

    /// Tiles that changed after `revision`, row by row: lowest cell and (columns, rows) of cells.
    pub fn changes_since(&self, revision: u64) -> impl Iterator<Item = (CellIndex, (usize, usize))> {
        let side = self.tile_side;
        let corner = move |i: usize| CellIndex { col: i % self.size.0 * side, row: i / self.size.0 * side };
        let fresh = self.changed.iter().enumerate().filter(move |(_, changed)| **changed > revision);
        fresh.map(move |(i, _)| (corner(i), (side, side)))
    }

    /// Grows the grid to contain the tiles from `low` to `high`.
    pub fn reach(&mut self, low: (i32, i32), high: (i32, i32)) {
        let last = (self.first.0 + self.size.0 as i32 - 1, self.first.1 + self.size.1 as i32 - 1);
        let first = (self.first.0.min(low.0), self.first.1.min(low.1));
        let end = (last.0.max(high.0), last.1.max(high.1));
        let size = ((end.0 - first.0 + 1) as usize, (end.1 - first.1 + 1) as usize);
        if (first, size) != (self.first, self.size) {
            self.lay_out(first, size);
        }
    }

    /// Writes a cell inside the grid. The tile counts as changed if the value differs.
    pub fn set(&mut self, cell: GridCell, value: Cell) {
        let side = self.tile_side as i32;
        let index = CellIndex {
            col: (cell.x - self.first.0 * side) as usize,
            row: (cell.y - self.first.1 * side) as usize,
        };
        if self.grid.get(index) != value {
            self.grid.set(index, value);
            self.changed[index.row / self.tile_side * self.size.0 + index.col / self.tile_side] =
                self.revision;
        }
    }

    /// Writes all cells of a tile inside the grid. `value` maps column and row within the tile to the class of the cell. The tile
    /// counts as changed.
    pub fn set_tile(&mut self, tile: (i32, i32), value: impl Fn(usize, usize) -> Cell) {
        let (col, row) = ((tile.0 - self.first.0) as usize, (tile.1 - self.first.1) as usize);
        self.changed[row * self.size.0 + col] = self.revision;
        let (left, bottom) = (col * self.tile_side, row * self.tile_side);
        for y in 0..self.tile_side {
            for x in 0..self.tile_side {
                self.grid.set(CellIndex { col: left + x, row: bottom + y }, value(x, y));
            }
        }
    }

    fn lay_out(&mut self, first: (i32, i32), size: (usize, usize)) {
        let mut grid = unknown(self.resolution, self.tile_side, first, size);
        let mut changed = vec![0; size.0 * size.1];
        let shift = ((self.first.0 - first.0) as usize, (self.first.1 - first.1) as usize);
        let old = *self.grid.geometry();
        for (i, &value) in self.grid.cells().iter().enumerate() {
            let CellIndex { col, row } = old.cell(i);
            let moved =
                CellIndex { col: col + shift.0 * self.tile_side, row: row + shift.1 * self.tile_side };
            grid.set(moved, value);
        }
        for (i, &revision) in self.changed.iter().enumerate() {
            changed[(i / self.size.0 + shift.1) * size.0 + i % self.size.0 + shift.0] = revision;
        }
        (self.grid, self.changed, self.first, self.size) = (grid, changed, first, size);
    }
}

fn unknown(resolution: f64, tile_side: usize, first: (i32, i32), size: (usize, usize)) -> OccupancyGrid {
    let cells = |tile: i32| f64::from(tile * tile_side as i32);
    let origin = Vector2::new(cells(first.0), cells(first.1)) * resolution;
    let geometry = GridGeometry::new(resolution, origin, size.0 * tile_side, size.1 * tile_side)
        .expect("invariant: the configuration limits the extent to less than 2^31 cells");
    OccupancyGrid::filled(geometry, Cell::Unknown)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn thresholds_split_the_log_odds_in_three() {
        let thresholds = Thresholds { occupied_above: 1.0_f32, free_below: -1.0 };
        let class = [-1.5, -1.0, 0.0, 1.0, 1.5].map(|log_odds| thresholds.classify(log_odds));
        assert_eq!(class, [Cell::Free, Cell::Unknown, Cell::Unknown, Cell::Unknown, Cell::Occupied]);
    }

    proptest! {
        /// A reader that copies the reported tiles after each revision holds the whole grid.
        #[test]
        fn the_reported_tiles_are_all_that_changed(
            writes in prop::collection::vec((-40..40_i32, -40..40_i32, any::<bool>()), 1..40),
        ) {
            let mut published = PublishedGrid::new(0.5, 8, (0, 0), (1, 1));
            let mut copy = published.grid().clone();
            for (x, y, occupied) in writes {
                let before = (published.revision(), *published.grid().geometry());
                published.begin_revision();
                published.reach((x >> 3, y >> 3), (x >> 3, y >> 3));
                let cell = GridCell { x, y };
                published.set(cell, if occupied { Cell::Occupied } else { Cell::Free });
                prop_assert_ne!(published.grid().at(cell.center_cells() * 0.5), Cell::Unknown);
                let changes: Vec<_> = published.changes_since(before.0).collect();
                prop_assert!(changes.len() <= 1);
                let grid = published.grid();
                if before.1 != *grid.geometry() {
                    // A copy gets the new layout; the old cells retain their positions in the map.
                    let centres = |i: usize| grid.geometry().center(grid.geometry().cell(i));
                    let moved: Vec<Cell> = (0..grid.geometry().len()).map(|i| copy.at(centres(i))).collect();
                    copy = OccupancyGrid::new(*grid.geometry(), moved).unwrap();
                }
                for (corner, (cols, rows)) in changes {
                    for (col, row) in (0..cols).flat_map(|col| (0..rows).map(move |row| (col, row))) {
                        let index = CellIndex { col: corner.col + col, row: corner.row + row };
                        copy.set(index, grid.get(index));
                    }
                }
                prop_assert_eq!(&copy, grid);
            }
        }
    }
}
