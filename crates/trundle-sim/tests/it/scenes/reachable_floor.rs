//! The floor that a disc reaches from a start.

use trundle_core::{Cell, CellIndex, Hypotenuse, OccupancyGrid, Vector2};

/// Free positions of a disc on a true grid.
pub struct ReachableFloor<'g> {
    grid: &'g OccupancyGrid,
    /// Reached from the start.
    reached: Vec<bool>,
}

impl<'g> ReachableFloor<'g> {
    /// Everywhere that a disc of `radius` m can go from `start`, keeping off every occupied cell's square.
    pub fn new(grid: &'g OccupancyGrid, radius: f64, start: Vector2) -> Self {
        let mut free = free_for(grid, radius);
        let (geometry, mut reached) = (grid.geometry(), vec![false; grid.cells().len()]);
        let mut front: Vec<CellIndex> = geometry.cell_at(start).into_iter().collect();
        while let Some(cell) = front.pop() {
            let at = geometry.linear(cell);
            if !std::mem::replace(&mut free[at], false) {
                continue;
            }
            reached[at] = true;
            let CellIndex { col, row } = cell;
            let beside =
                [(col.wrapping_sub(1), row), (col + 1, row), (col, row.wrapping_sub(1)), (col, row + 1)];
            let inside = beside.into_iter().filter(|&(c, r)| c < geometry.width && r < geometry.height);
            front.extend(inside.map(|(col, row)| CellIndex { col, row }));
        }
        Self { grid, reached }
    }

    /// Whether `place` is a free position of the disc.
    pub fn reaches(&self, place: Vector2) -> bool {
        let geometry = self.grid.geometry();
        geometry.cell_at(place).is_some_and(|cell| self.reached[geometry.linear(cell)])
    }
}

/// Cells whose middle is farther than `radius` m from every occupied cell's square.
fn free_for(grid: &OccupancyGrid, radius: f64) -> Vec<bool> {
    let geometry = grid.geometry();
    let reach = (radius / geometry.resolution + 0.5).ceil() as i64;
    let is_near = |dc: i64, dr: i64| {
        let gap = |d: i64| ((d.abs() as f64 - 0.5) * geometry.resolution).max(0.0);
        gap(dc).hypotenuse(gap(dr)) <= radius
    };
    let offsets: Vec<(i64, i64)> = (-reach..=reach)
        .flat_map(|dr| (-reach..=reach).map(move |dc| (dc, dr)))
        .filter(|&(dc, dr)| is_near(dc, dr))
        .collect();
    let (width, height) = (geometry.width as i64, geometry.height as i64);
    let occupied = |col: i64, row: i64| {
        let inside = (0..width).contains(&col) && (0..height).contains(&row);
        inside && grid.cells()[(row * width + col) as usize] == Cell::Occupied
    };
    let mut free: Vec<bool> = grid.cells().iter().map(|&cell| cell != Cell::Occupied).collect();
    for (row, col) in (0..height).flat_map(|row| (0..width).map(move |col| (row, col))) {
        // A cell with only occupied neighbours is never the nearest.
        let is_rim = [(1, 0), (-1, 0), (0, 1), (0, -1)].iter().any(|(dc, dr)| !occupied(col + dc, row + dr));
        if !(occupied(col, row) && is_rim) {
            continue;
        }
        for (dc, dr) in &offsets {
            let (col, row) = (col + dc, row + dr);
            if (0..width).contains(&col) && (0..height).contains(&row) {
                free[(row * width + col) as usize] = false;
            }
        }
    }
    free
}
