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
        (self.grid, self.corner) = (grid, corner);
    }

    /// Shows a cell whose evidence changed.
    pub(crate) fn show(&mut self, cell: GridCell, log_odds: f32) {
        let index =
            CellIndex { col: (cell.x - self.corner.x) as usize, row: (cell.y - self.corner.y) as usize };
        self.grid.set(index, self.value(log_odds));
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
