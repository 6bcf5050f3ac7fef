use crate::{GridCell, LogOddsGrid, MapperConfig, evidence::TILE_CELLS, mapper_config::log_odds};
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};

/// The three-valued map that the others see, kept up to date cell by cell; laid out anew only when the map grows.
#[derive(Debug, Clone)]
pub(crate) struct LiveGrid {
    grid: OccupancyGrid,
    corner: GridCell,
    resolution: f64,
    occupied_above: f32,
    free_below: f32,
    revision: u64,
    /// At which revision a cell of each tile changed last, row by row.
    changed: Vec<u64>,
}

impl LiveGrid {
    /// Unknown everywhere.
    pub(crate) fn new(config: &MapperConfig, evidence: &LogOddsGrid) -> Self {
        let (corner, size) = evidence.bounds();
        Self {
            grid: OccupancyGrid::filled(geometry(corner, size, config.resolution), Cell::Unknown),
            corner,
            resolution: config.resolution,
            occupied_above: log_odds(config.occupied_above) as f32,
            free_below: log_odds(config.free_below) as f32,
            revision: 0,
            changed: vec![0; size.0 / TILE_CELLS * (size.1 / TILE_CELLS)],
        }
    }

    pub(crate) fn grid(&self) -> &OccupancyGrid {
        &self.grid
    }

    /// Takes over the bounds of `evidence`, whose cells must all be within.
    pub(crate) fn fit(&mut self, evidence: &LogOddsGrid) {
        let (corner, size) = evidence.bounds();
        let old = *self.grid.geometry();
        if (corner, size) == (self.corner, (old.width, old.height)) {
            return;
        }
        let mut grid = OccupancyGrid::filled(geometry(corner, size, self.resolution), Cell::Unknown);
        let shift =
            CellIndex { col: (self.corner.x - corner.x) as usize, row: (self.corner.y - corner.y) as usize };
        for (i, &value) in self.grid.cells().iter().enumerate() {
            let cell = old.cell(i);
            grid.set(CellIndex { col: cell.col + shift.col, row: cell.row + shift.row }, value);
        }
        let (cols, old_cols) = (size.0 / TILE_CELLS, old.width / TILE_CELLS);
        let mut changed = vec![0; cols * (size.1 / TILE_CELLS)];
        for (i, &revision) in self.changed.iter().enumerate() {
            let (col, row) = (i % old_cols + shift.col / TILE_CELLS, i / old_cols + shift.row / TILE_CELLS);
            changed[row * cols + col] = revision;
        }
        (self.grid, self.corner, self.changed) = (grid, corner, changed);
    }

    /// From here on changes are of a new revision.
    pub(crate) fn begin(&mut self) {
        self.revision += 1;
    }

    pub(crate) fn revision(&self) -> u64 {
        self.revision
    }

    /// The lowest cell and the size (columns, rows) of the tiles that changed after `revision`, row by row.
    pub(crate) fn changes_since(&self, revision: u64) -> impl Iterator<Item = (CellIndex, (usize, usize))> {
        let cols = self.grid.geometry().width / TILE_CELLS;
        let corner = move |i: usize| CellIndex { col: i % cols * TILE_CELLS, row: i / cols * TILE_CELLS };
        let fresh = self.changed.iter().enumerate().filter(move |(_, changed)| **changed > revision);
        fresh.map(move |(i, _)| (corner(i), (TILE_CELLS, TILE_CELLS)))
    }

    /// Shows all cells of `evidence`, whose bounds are the grid's.
    pub(crate) fn show_all(&mut self, evidence: &LogOddsGrid) {
        let (corner, (cols, rows)) = evidence.bounds();
        for row in 0..rows as i32 {
            for col in 0..cols as i32 {
                let cell = GridCell { x: corner.x + col, y: corner.y + row };
                self.show(cell, evidence.log_odds(cell));
            }
        }
    }

    /// Shows a cell whose evidence changed.
    pub(crate) fn show(&mut self, cell: GridCell, log_odds: f32) {
        let index =
            CellIndex { col: (cell.x - self.corner.x) as usize, row: (cell.y - self.corner.y) as usize };
        let value = self.value(log_odds);
        if self.grid.get(index) != value {
            self.grid.set(index, value);
            let tile =
                index.row / TILE_CELLS * (self.grid.geometry().width / TILE_CELLS) + index.col / TILE_CELLS;
            self.changed[tile] = self.revision;
        }
    }

    /// What a cell of these log-odds is called.
    pub(crate) fn value(&self, log_odds: f32) -> Cell {
        if log_odds > self.occupied_above {
            Cell::Occupied
        } else if log_odds < self.free_below {
            Cell::Free
        } else {
            Cell::Unknown
        }
    }
}

fn geometry(corner: GridCell, (width, height): (usize, usize), resolution: f64) -> GridGeometry {
    debug_assert!(width.is_multiple_of(TILE_CELLS) && height.is_multiple_of(TILE_CELLS));
    let origin = Vector2::new(f64::from(corner.x), f64::from(corner.y)) * resolution;
    GridGeometry::new(resolution, origin, width, height)
        .expect("invariant: the extent is limited by the config")
}
