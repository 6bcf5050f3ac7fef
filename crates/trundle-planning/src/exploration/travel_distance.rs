//! Path lengths from one place to every cell that a disc can travel.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};
use trundle_grid::DistanceField;

/// Path lengths from one place to every cell that a disc can reach, mm; [`UNREACHED`] elsewhere.
pub(super) struct TravelDistances {
    geometry: GridGeometry,
    length: Vec<u32>,
}

/// Length of a cell that the disc cannot reach.
const UNREACHED: u32 = u32::MAX;
/// Factor on the length of a step through unknown space: it may hold a wall. Source: ours.
const UNKNOWN_STEP_FACTOR: u32 = 3;
/// Distance around the robot in which the search starts, m: the robot may be nearer to an obstacle than a path. Source: ours.
const START_RADIUS_M: f64 = 0.3;

impl TravelDistances {
    /// Dijkstra's search on the 8-neighbour lattice from `start` for a disc of `radius` m; `field` is that of `grid`.
    pub(super) fn from(grid: &OccupancyGrid, field: &DistanceField, start: Vector2, radius: f64) -> Self {
        let geometry = *grid.geometry();
        let fits = |cell: CellIndex| grid.get(cell) != Cell::Occupied && field.at_cell(cell) >= radius;
        let mut travel = Self { geometry, length: vec![UNREACHED; geometry.len()] };
        let mut queue = BinaryHeap::new();
        for cell in disc(&geometry, start, START_RADIUS_M).filter(|&cell| fits(cell)) {
            let length = ((geometry.center(cell) - start).norm() * 1e3) as u32;
            travel.length[geometry.linear(cell)] = length;
            queue.push(Reverse((length, geometry.linear(cell))));
        }
        let step = geometry.resolution * 1e3;
        let lengths = [step as u32, (step * std::f64::consts::SQRT_2) as u32];
        while let Some(Reverse((length, at))) = queue.pop() {
            if length > travel.length[at] {
                continue;
            }
            let from = geometry.cell(at);
            for to in neighbours(&geometry, from).filter(|&to| fits(to)) {
                let diagonal = usize::from(to.col != from.col && to.row != from.row);
                let price = if grid.get(to) == Cell::Unknown { UNKNOWN_STEP_FACTOR } else { 1 };
                let (sum, to) = (length + lengths[diagonal] * price, geometry.linear(to));
                if sum < travel.length[to] {
                    travel.length[to] = sum;
                    queue.push(Reverse((sum, to)));
                }
            }
        }
        travel
    }

    /// The path length to a cell, m; `None` if it cannot be reached.
    pub(super) fn length_to(&self, cell: CellIndex) -> Option<f64> {
        let length = self.length[self.geometry.linear(cell)];
        (length != UNREACHED).then(|| f64::from(length) * 1e-3)
    }
}

fn neighbours(geometry: &GridGeometry, cell: CellIndex) -> impl Iterator<Item = CellIndex> + use<> {
    let (width, height) = (geometry.width, geometry.height);
    let cols = cell.col.saturating_sub(1)..(cell.col + 2).min(width);
    let rows = cell.row.saturating_sub(1)..(cell.row + 2).min(height);
    rows.flat_map(move |row| cols.clone().map(move |col| CellIndex { col, row })).filter(move |c| *c != cell)
}

/// The cells whose centres are within `radius` of `middle`, by rows.
pub(super) fn disc(
    geometry: &GridGeometry,
    middle: Vector2,
    radius: f64,
) -> impl Iterator<Item = CellIndex> + use<> {
    let geometry = *geometry;
    let place = |value: f64, max: usize| (value / geometry.resolution).clamp(0.0, max as f64) as usize;
    let (low, high) =
        (middle.add_scalar(-radius) - geometry.origin, middle.add_scalar(radius) - geometry.origin);
    let cols = place(low.x, geometry.width)..(place(high.x, geometry.width) + 1).min(geometry.width);
    let rows = place(low.y, geometry.height)..(place(high.y, geometry.height) + 1).min(geometry.height);
    rows.flat_map(move |row| cols.clone().map(move |col| CellIndex { col, row }))
        .filter(move |&cell| (geometry.center(cell) - middle).norm() <= radius)
}
