use crate::DistanceField;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};

/// Ways from one place to everywhere that a disc can go, in millimetres; [`NEVER`] where it cannot.
pub(super) struct Reach {
    geometry: GridGeometry,
    way: Vec<u32>,
}

const NEVER: u32 = u32::MAX;
/// A step through the unknown counts for so many: what is there may be a wall.
const UNKNOWN_PRICE: u32 = 3;
/// From so far around it the robot, which may stand nearer to something than a plan would go, gets onto its ways, m.
const FOOTHOLD: f64 = 0.3;

impl Reach {
    /// Dijkstra's ways on the 8-neighbour lattice from `start` of a disc of `radius` m; `field` is that of `grid`.
    pub(super) fn from(grid: &OccupancyGrid, field: &DistanceField, start: Vector2, radius: f64) -> Self {
        let geometry = *grid.geometry();
        let fits = |cell: CellIndex| grid.get(cell) != Cell::Occupied && field.at_cell(cell) >= radius;
        let mut reach = Self { geometry, way: vec![NEVER; geometry.len()] };
        let mut queue = BinaryHeap::new();
        for cell in disc(&geometry, start, FOOTHOLD).filter(|&cell| fits(cell)) {
            let way = ((geometry.center(cell) - start).norm() * 1e3) as u32;
            reach.way[geometry.linear(cell)] = way;
            queue.push(Reverse((way, geometry.linear(cell))));
        }
        let step = geometry.resolution * 1e3;
        let lengths = [step as u32, (step * std::f64::consts::SQRT_2) as u32];
        while let Some(Reverse((way, at))) = queue.pop() {
            if way > reach.way[at] {
                continue;
            }
            let from = geometry.cell(at);
            for to in neighbours(&geometry, from).filter(|&to| fits(to)) {
                let diagonal = usize::from(to.col != from.col && to.row != from.row);
                let price = if grid.get(to) == Cell::Unknown { UNKNOWN_PRICE } else { 1 };
                let (sum, to) = (way + lengths[diagonal] * price, geometry.linear(to));
                if sum < reach.way[to] {
                    reach.way[to] = sum;
                    queue.push(Reverse((sum, to)));
                }
            }
        }
        reach
    }

    /// The way to a cell, m; `None` when there is none.
    pub(super) fn way_to(&self, cell: CellIndex) -> Option<f64> {
        let way = self.way[self.geometry.linear(cell)];
        (way != NEVER).then(|| f64::from(way) * 1e-3)
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
    let place = |value: f64, most: usize| (value / geometry.resolution).clamp(0.0, most as f64) as usize;
    let (low, high) =
        (middle.add_scalar(-radius) - geometry.origin, middle.add_scalar(radius) - geometry.origin);
    let cols = place(low.x, geometry.width)..(place(high.x, geometry.width) + 1).min(geometry.width);
    let rows = place(low.y, geometry.height)..(place(high.y, geometry.height) + 1).min(geometry.height);
    rows.flat_map(move |row| cols.clone().map(move |col| CellIndex { col, row }))
        .filter(move |&cell| (geometry.center(cell) - middle).norm() <= radius)
}
