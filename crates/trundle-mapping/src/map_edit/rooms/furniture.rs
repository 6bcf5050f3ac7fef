//! Obstacles that stand free.

use super::regions::{connected, neighbours};
use trundle_core::{Cell, OccupancyGrid};

/// The map without the groups of occupied cells that are at most `max_length` m long and wide, and stand on free floor alone.
pub(super) fn without_furniture(grid: &OccupancyGrid, max_length: f64) -> OccupancyGrid {
    let geometry = *grid.geometry();
    let max_cells = (max_length / geometry.resolution).round() as usize;
    let mut floor = grid.clone();
    let mut seen = vec![false; geometry.len()];
    for start in 0..geometry.len() {
        if grid.cells()[start] == Cell::Free || seen[start] {
            continue;
        }
        let group = group(grid, start, &mut seen);
        if group.is_inside && group.side() <= max_cells && group.has_obstacle {
            group.cells.into_iter().for_each(|i| floor.set(geometry.cell(i), Cell::Free));
        }
    }
    floor
}

/// Cells that are not free, connected with each other by sides.
struct Group {
    cells: Vec<usize>,
    cols: (usize, usize),
    rows: (usize, usize),
    /// Whether no cell is at the border of the grid.
    is_inside: bool,
    has_obstacle: bool,
}

impl Group {
    /// Longer side of the box about the cells \[cells\].
    fn side(&self) -> usize {
        (self.cols.1 - self.cols.0).max(self.rows.1 - self.rows.0) + 1
    }
}

fn group(grid: &OccupancyGrid, start: usize, seen: &mut [bool]) -> Group {
    let geometry = grid.geometry();
    seen[start] = true;
    let cells = connected(geometry, start, |i| {
        grid.cells()[i] != Cell::Free && !std::mem::replace(&mut seen[i], true)
    });
    let first = geometry.cell(start);
    let (mut cols, mut rows) = ((first.col, first.col), (first.row, first.row));
    for cell in cells.iter().map(|i| geometry.cell(*i)) {
        cols = (cols.0.min(cell.col), cols.1.max(cell.col));
        rows = (rows.0.min(cell.row), rows.1.max(cell.row));
    }
    let is_inside = cells.iter().all(|i| neighbours(geometry, *i).iter().all(Option::is_some));
    let has_obstacle = cells.iter().any(|i| grid.cells()[*i] == Cell::Occupied);
    Group { cells, cols, rows, is_inside, has_obstacle }
}
