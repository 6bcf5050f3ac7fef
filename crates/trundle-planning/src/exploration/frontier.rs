//! Frontiers: borders between free and unknown space.

use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};

/// A connected line of free cells with unknown neighbours.
#[derive(Debug, Clone, PartialEq)]
pub struct Frontier {
    /// The frontier cell nearest to the frontier's mean, map frame, m.
    pub middle: Vector2,
    /// Number of cells times the resolution, m.
    pub length: f64,
}

/// Distance of two middles that still are the same frontier, m. Source: ours.
const SAME_FRONTIER_M: f64 = 0.5;

impl Frontier {
    /// Whether this is the frontier whose middle was at `middle` on an older map.
    pub fn is_that_at(&self, middle: Vector2) -> bool {
        (self.middle - middle).norm() < SAME_FRONTIER_M
    }
}

/// All frontiers of at least `min` metres, ordered by their first cell in the grid.
///
/// A frontier cell is free and has an unknown 4-neighbour; cells that touch (8-neighbours) are one frontier. O(cells).
pub(super) fn frontiers(grid: &OccupancyGrid, min: f64) -> Vec<Frontier> {
    let geometry = grid.geometry();
    let mut open: Vec<bool> = (0..geometry.len()).map(|i| is_frontier(grid, geometry.cell(i))).collect();
    let mut found = Vec::new();
    for first in 0..open.len() {
        if open[first] {
            let cells = component(geometry, &mut open, first);
            let length = cells.len() as f64 * geometry.resolution;
            if length >= min {
                found.push(Frontier { middle: middle(geometry, &cells), length });
            }
        }
    }
    found
}

fn is_frontier(grid: &OccupancyGrid, cell: CellIndex) -> bool {
    let geometry = grid.geometry();
    // ConfigurationSpace beyond the grid is unknown.
    let unknown = |col: Option<usize>, row: Option<usize>| match (col, row) {
        (Some(col), Some(row)) if col < geometry.width && row < geometry.height => {
            grid.get(CellIndex { col, row }) == Cell::Unknown
        }
        _ => true,
    };
    let CellIndex { col, row } = cell;
    grid.get(cell) == Cell::Free
        && (unknown(col.checked_sub(1), Some(row))
            || unknown(Some(col + 1), Some(row))
            || unknown(Some(col), row.checked_sub(1))
            || unknown(Some(col), Some(row + 1)))
}

/// The cells connected with `first`; they are removed from `open`.
fn component(geometry: &GridGeometry, open: &mut [bool], first: usize) -> Vec<usize> {
    let mut cells = vec![first];
    open[first] = false;
    let mut next = 0;
    while next < cells.len() {
        let CellIndex { col, row } = geometry.cell(cells[next]);
        next += 1;
        for row in row.saturating_sub(1)..(row + 2).min(geometry.height) {
            for col in col.saturating_sub(1)..(col + 2).min(geometry.width) {
                let cell = geometry.linear(CellIndex { col, row });
                if std::mem::take(&mut open[cell]) {
                    cells.push(cell);
                }
            }
        }
    }
    cells
}

fn middle(geometry: &GridGeometry, cells: &[usize]) -> Vector2 {
    let centers = || cells.iter().map(|&cell| geometry.center(geometry.cell(cell)));
    let mean = centers().sum::<Vector2>() / cells.len() as f64;
    centers()
        .min_by(|a, b| (a - mean).norm_squared().total_cmp(&(b - mean).norm_squared()))
        .expect("invariant: a component has its first cell")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_opening_to_unknown_space_is_one_frontier_and_a_closed_room_has_none() {
        let open = OccupancyGrid::from_ascii(0.1, "#######\n#.....?\n#.....?\n#.....?\n#######\n").unwrap();
        let found = frontiers(&open, 0.2);
        assert_eq!(found.len(), 1);
        assert!((found[0].length - 0.3).abs() < 1e-9);
        assert!((found[0].middle - Vector2::new(0.55, 0.25)).norm() < 1e-9, "{found:?}");
        assert!(frontiers(&open, 0.4).is_empty(), "too short");
        let closed = OccupancyGrid::from_ascii(0.1, "####\n#..#\n####\n").unwrap();
        assert!(frontiers(&closed, 0.05).is_empty());
    }

    #[test]
    fn the_edge_of_the_grid_is_a_frontier() {
        let grid = OccupancyGrid::from_ascii(0.1, "###\n...\n###\n").unwrap();
        assert_eq!(frontiers(&grid, 0.05).len(), 2);
    }
}
