//! Published occupancy grid of the best particle, updated tile by tile.

use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};
use trundle_grid::tiles::{Tile, TileMap};
use trundle_grid::{MapperConfig, log_odds};

/// The three-valued map that the others see, brought up to date tile by tile.
///
/// It remembers the map that it showed last: what that map still shares with the one to show has not changed, so
/// only tiles that were written are looked at, though another particle may be the best now.
#[derive(Debug, Clone)]
pub(crate) struct MapPublisher {
    shown: TileMap,
    grid: OccupancyGrid,
    /// Lower-left tile and size in tiles of the grid.
    first: (i32, i32),
    size: (usize, usize),
    resolution: f64,
    occupied_above: i8,
    free_below: i8,
    revision: u64,
    /// At which revision each tile of the grid changed last.
    changed: Vec<u64>,
}

impl MapPublisher {
    pub(crate) fn new(config: &MapperConfig) -> Self {
        let units = |probability: f64| (log_odds(probability) / Tile::LOG_ODDS_UNIT) as i8;
        let (first, size) = ((-1, -1), (2, 2));
        Self {
            shown: TileMap::default(),
            grid: empty(config.resolution, first, size),
            first,
            size,
            resolution: config.resolution,
            occupied_above: units(config.occupied_above),
            free_below: units(config.free_below),
            revision: 0,
            changed: vec![0; size.0 * size.1],
        }
    }

    pub(crate) fn grid(&self) -> &OccupancyGrid {
        &self.grid
    }

    pub(crate) fn revision(&self) -> u64 {
        self.revision
    }

    /// Shows `map`; how many tiles changed.
    pub(crate) fn show(&mut self, map: &TileMap) -> usize {
        let mut bounds: Option<((i32, i32), (i32, i32))> = None;
        let mut count = 0;
        map.changed_tiles(&self.shown, |at, _| {
            let (low, high) = bounds.unwrap_or((at, at));
            bounds = Some(((low.0.min(at.0), low.1.min(at.1)), (high.0.max(at.0), high.1.max(at.1))));
            count += 1;
        });
        let Some((low, high)) = bounds else { return 0 };
        self.reach(low, high);
        self.revision += 1;
        let shown = std::mem::take(&mut self.shown);
        map.changed_tiles(&shown, |at, tile| self.redraw(at, tile));
        self.shown = map.clone();
        count
    }

    /// The lowest cell and the size (columns, rows) of the parts that changed after `revision`, row by row.
    pub(crate) fn changes_since(&self, revision: u64) -> impl Iterator<Item = (CellIndex, (usize, usize))> {
        let corner =
            |i: usize| CellIndex { col: i % self.size.0 * Tile::SIDE, row: i / self.size.0 * Tile::SIDE };
        let fresh = self.changed.iter().enumerate().filter(move |(_, changed)| **changed > revision);
        fresh.map(move |(i, _)| (corner(i), (Tile::SIDE, Tile::SIDE)))
    }

    fn redraw(&mut self, at: (i32, i32), tile: Option<&Tile>) {
        let (col, row) = ((at.0 - self.first.0) as usize, (at.1 - self.first.1) as usize);
        self.changed[row * self.size.0 + col] = self.revision;
        let (left, bottom) = (col * Tile::SIDE, row * Tile::SIDE);
        for y in 0..Tile::SIDE {
            for x in 0..Tile::SIDE {
                let log_odds = tile.map_or(0, |tile| tile.log_odds[(y << Tile::BITS) | x]);
                self.grid.set(CellIndex { col: left + x, row: bottom + y }, self.value(log_odds));
            }
        }
    }

    fn value(&self, log_odds: i8) -> Cell {
        if log_odds > self.occupied_above {
            Cell::Occupied
        } else if log_odds < self.free_below {
            Cell::Free
        } else {
            Cell::Unknown
        }
    }

    /// Grows the grid so that it holds the tiles from `low` to `high`.
    fn reach(&mut self, low: (i32, i32), high: (i32, i32)) {
        let last = (self.first.0 + self.size.0 as i32 - 1, self.first.1 + self.size.1 as i32 - 1);
        let first = (self.first.0.min(low.0), self.first.1.min(low.1));
        let end = (last.0.max(high.0), last.1.max(high.1));
        let size = ((end.0 - first.0 + 1) as usize, (end.1 - first.1 + 1) as usize);
        if (first, size) == (self.first, self.size) {
            return;
        }
        let mut grid = empty(self.resolution, first, size);
        let mut changed = vec![0; size.0 * size.1];
        let shift = ((self.first.0 - first.0) as usize, (self.first.1 - first.1) as usize);
        let old = *self.grid.geometry();
        for (i, &value) in self.grid.cells().iter().enumerate() {
            let cell = old.cell(i);
            grid.set(
                CellIndex { col: cell.col + shift.0 * Tile::SIDE, row: cell.row + shift.1 * Tile::SIDE },
                value,
            );
        }
        for (i, &revision) in self.changed.iter().enumerate() {
            changed[(i / self.size.0 + shift.1) * size.0 + i % self.size.0 + shift.0] = revision;
        }
        (self.grid, self.changed, self.first, self.size) = (grid, changed, first, size);
    }
}

fn empty(resolution: f64, first: (i32, i32), size: (usize, usize)) -> OccupancyGrid {
    let metres = resolution * Tile::SIDE as f64;
    let origin = Vector2::new(f64::from(first.0), f64::from(first.1)) * metres;
    let geometry = GridGeometry::new(resolution, origin, size.0 * Tile::SIDE, size.1 * Tile::SIDE)
        .expect("invariant: a map of less than 2^31 cells");
    OccupancyGrid::filled(geometry, Cell::Unknown)
}
