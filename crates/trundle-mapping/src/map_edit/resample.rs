//! A moved map on other cells, resampled once.

use super::coverage::{Coverage, CoverageSampler};
use super::thinning::{TouchedCell, thinned};
use rayon::prelude::*;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2};

/// Coverage below which an obstacle does not reach into a cell, as a part of the area of the smaller cell. Source: ours.
const MIN_TOUCHED_SHARE: f64 = 0.1;

/// The map moved by `target_from_map`, on the cells of `geometry`. Cells outside the map are unknown.
///
/// A cell that obstacles cover by half or more is occupied. Further cells are occupied where a wall would open or an obstacle vanish
/// otherwise: a wall that was closed stays closed, connected by sides or corners of its cells. Other cells are free or unknown, by the
/// larger part. A map on the same lattice is copied cell by cell. Cost: 64 samples for each cell near an obstacle or an edge of the known
/// floor.
#[must_use]
pub fn resampled(grid: &OccupancyGrid, target_from_map: Pose2, geometry: GridGeometry) -> OccupancyGrid {
    let sampler = CoverageSampler::new(grid, target_from_map, &geometry);
    let larger = (geometry.resolution / grid.geometry().resolution).max(1.0);
    let min_share = MIN_TOUCHED_SHARE / (larger * larger);
    let rows: Vec<Row> =
        (0..geometry.height).into_par_iter().map(|row| row_of(&sampler, &geometry, row, min_share)).collect();
    let (open, touched): (Vec<_>, Vec<_>) = rows.into_iter().unzip();
    let mut cells: Vec<Cell> = open.into_iter().flatten().collect();
    let touched: Vec<TouchedCell> = touched.into_iter().flatten().collect();
    for (cell, is_occupied) in touched.iter().zip(thinned(&geometry, &touched)) {
        if is_occupied {
            cells[cell.linear] = Cell::Occupied;
        }
    }
    OccupancyGrid::new(geometry, cells).expect("invariant: each row has a cell for each column")
}

/// The cells of a row without obstacles, and those of its cells that obstacles touch.
type Row = (Vec<Cell>, Vec<TouchedCell>);

fn row_of(sampler: &CoverageSampler, geometry: &GridGeometry, row: usize, min_share: f64) -> Row {
    let mut touched = Vec::new();
    let cells = (0..geometry.width).map(|col| match sampler.of(CellIndex { col, row }) {
        Coverage::Open(value) => value,
        Coverage::Touched(found) => {
            if found.share >= min_share {
                let linear = row * geometry.width + col;
                touched.push(TouchedCell { linear, share: found.share, sources: found.sources });
            }
            found.otherwise
        }
    });
    (cells.collect(), touched)
}

#[cfg(test)]
mod tests;
