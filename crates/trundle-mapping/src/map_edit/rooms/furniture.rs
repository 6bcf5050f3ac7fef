//! Obstacles that stand free.

use super::regions::neighbours;
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
    let first = geometry.cell(start);
    let mut group = Group {
        cells: Vec::new(),
        cols: (first.col, first.col),
        rows: (first.row, first.row),
        is_inside: true,
        has_obstacle: false,
    };
    let mut open = vec![start];
    seen[start] = true;
    while let Some(i) = open.pop() {
        let cell = geometry.cell(i);
        group.cells.push(i);
        group.cols = (group.cols.0.min(cell.col), group.cols.1.max(cell.col));
        group.rows = (group.rows.0.min(cell.row), group.rows.1.max(cell.row));
        group.has_obstacle |= grid.cells()[i] == Cell::Occupied;
        for near in neighbours(geometry, i) {
            let Some(near) = near else {
                group.is_inside = false;
                continue;
            };
            if grid.cells()[near] != Cell::Free && !std::mem::replace(&mut seen[near], true) {
                open.push(near);
            }
        }
    }
    group
}
