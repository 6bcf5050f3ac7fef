//! The geodesic potential: a wave that runs from the start around obstacles until it meets the goal.
//!
//! Problem: the printed potential has local minima. Idea: replace the straight distance in the attraction by the
//! geodesic one, and the repulsion by slowness of the wave near obstacles; such a potential has one minimum, and
//! descending it is following the wave back. The wave runs towards the goal first (A*; Hart, Nilsson, Raphael, IEEE T-SSC
//! 4(2), 1968) on the 8-neighbour lattice of cells where the robot fits, every step checked against the obstacles'
//! squares. Complete: if the lattice connects, the way is found. Costs are whole numbers, so a list for each key makes
//! a queue without comparisons (Dial, CACM 12(11), 1969). Cost: O(cells reached).

use crate::dial::{Dial, Entry};
use crate::space::Space;
use trundle_core::Vector2;

/// What the wave found.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Wave {
    /// The cheapest way: start, cell centres, goal.
    Met(Vec<Vector2>),
    /// The goal cannot be reached; the reachable point nearest to it.
    Stuck(Vector2),
}

/// The wave's memory, kept from plan to plan.
#[derive(Debug, Default)]
pub(crate) struct WaveFront {
    /// Cheapest so far, in units; [`NEVER`] where the wave has not been.
    cost: Vec<u32>,
    /// Which of [`STEPS`] led here, [`SEED`] for the first ring.
    step: Vec<u8>,
    queue: Dial,
}

const STEPS: [(i64, i64); 8] = [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)];
const SEED: u8 = 8;
const NEVER: u32 = u32::MAX;
/// How far around the start and the goal the lattice may be entered, cells.
const RING: i64 = 2;
/// The cost of a cell's side, and of its diagonal, where a metre costs 1.
const SIDE: u32 = 256;
const DIAGONAL: u32 = 362;

impl WaveFront {
    /// Runs the wave from `start` to `goal`, both free and inside the field.
    pub(crate) fn run(&mut self, space: &Space<'_>, start: Vector2, goal: Vector2) -> Wave {
        let Some(target) = cell_of(space, goal) else { return Wave::Stuck(start) };
        let lattice = Lattice::new(space.field.geometry().width, target);
        self.seed(space, start, &lattice);
        let ends = ring(space, goal);
        let mut best: Option<(u32, usize)> = None;
        while let Some((key, Entry { cell, cost })) = self.queue.pop() {
            if best.is_some_and(|(total, _)| key >= total) {
                break;
            }
            let cell = cell as usize;
            if cost > self.cost[cell] {
                continue;
            }
            if ends.contains(&cell) {
                let total = cost + lattice.ahead(lattice.place(cell));
                if best.is_none_or(|(least, _)| total < least) {
                    best = Some((total, cell));
                }
            }
            self.spread(space, cell, &lattice);
        }
        match best {
            Some((_, cell)) => Wave::Met(self.follow_back(space, cell, start, goal)),
            None => Wave::Stuck(self.nearest(space, start, goal)),
        }
    }

    fn seed(&mut self, space: &Space<'_>, start: Vector2, lattice: &Lattice) {
        self.cost.clear();
        self.cost.resize(space.field.geometry().len(), NEVER);
        self.step.resize(self.cost.len(), SEED);
        let resolution = space.field.geometry().resolution;
        let price = |cell| (space.cost(start, space.center(cell)) / resolution * f64::from(SIDE)) as u32;
        let seeds: Vec<_> = ring(space, start).into_iter().map(|cell| (cell, price(cell))).collect();
        let first =
            seeds.iter().map(|(cell, cost)| cost + lattice.ahead(lattice.place(*cell))).min().unwrap_or(0);
        let longest = f64::from(DIAGONAL) * (RING as f64 + 1.0) * 2.0;
        self.queue.reset(first, (longest * (space.highest_density() + 1.0)).ceil() as u32);
        for (cell, cost) in seeds {
            self.reach(cell, cost, SEED, lattice.ahead(lattice.place(cell)));
        }
    }

    fn reach(&mut self, cell: usize, cost: u32, step: u8, ahead: u32) {
        self.cost[cell] = cost;
        self.step[cell] = step;
        self.queue.push(cost + ahead, Entry { cell: cell as u32, cost });
    }

    fn spread(&mut self, space: &Space<'_>, from: usize, lattice: &Lattice) {
        let geometry = space.field.geometry();
        let (width, height) = (geometry.width as i64, geometry.height as i64);
        let (col, row) = lattice.place(from);
        let here = space.cell_density(from);
        let so_far = self.cost[from];
        for (step, (dx, dy)) in STEPS.into_iter().enumerate() {
            let (c, r) = (col + dx, row + dy);
            if c < 0 || r < 0 || c >= width || r >= height {
                continue;
            }
            let to = (r * width + c) as usize;
            let length = if step < 4 { SIDE } else { DIAGONAL };
            if self.cost[to] <= so_far + length || !space.is_free_cell(to) {
                continue;
            }
            let cost = so_far + (f64::from(length) * (here + space.cell_density(to)) * 0.5) as u32;
            let metres = geometry.resolution * f64::from(length) / f64::from(SIDE);
            if cost < self.cost[to] && space.joins(from, to, metres) {
                self.reach(to, cost, step as u8, lattice.ahead((c, r)));
            }
        }
    }

    fn follow_back(&self, space: &Space<'_>, last: usize, start: Vector2, goal: Vector2) -> Vec<Vector2> {
        let width = space.field.geometry().width as i64;
        let mut points = vec![goal];
        let mut cell = last;
        loop {
            points.push(space.center(cell));
            if self.step[cell] == SEED {
                break;
            }
            let (dx, dy) = STEPS[usize::from(self.step[cell])];
            cell = (cell as i64 - dy * width - dx) as usize;
        }
        points.push(start);
        points.reverse();
        points
    }

    /// Of all cells the wave has been to, the one nearest to the goal.
    fn nearest(&self, space: &Space<'_>, start: Vector2, goal: Vector2) -> Vector2 {
        let reached =
            (0..self.cost.len()).filter(|cell| self.cost[*cell] != NEVER).map(|cell| space.center(cell));
        let nearer =
            |a: &Vector2, b: &Vector2| (a - goal).norm_squared().total_cmp(&(b - goal).norm_squared());
        reached.min_by(nearer).unwrap_or(start)
    }
}

/// Columns and rows of cells, and the way that is at least ahead of them.
struct Lattice {
    width: i64,
    target: (i64, i64),
}

impl Lattice {
    fn new(width: usize, target: usize) -> Self {
        let lattice = Self { width: width as i64, target: (0, 0) };
        Self { target: lattice.place(target), ..lattice }
    }

    /// Column and row.
    fn place(&self, cell: usize) -> (i64, i64) {
        (cell as i64 % self.width, cell as i64 / self.width)
    }

    /// The cost of the shortest way over the 8-neighbour lattice to the target, were it empty.
    fn ahead(&self, (col, row): (i64, i64)) -> u32 {
        let (x, y) = (col.abs_diff(self.target.0) as u32, row.abs_diff(self.target.1) as u32);
        x.max(y) * SIDE + x.min(y) * (DIAGONAL - SIDE)
    }
}

fn cell_of(space: &Space<'_>, point: Vector2) -> Option<usize> {
    space.field.geometry().cell_at(point).map(|cell| space.field.geometry().linear(cell))
}

/// The free cells around a point that it can reach straight.
fn ring(space: &Space<'_>, point: Vector2) -> Vec<usize> {
    let geometry = space.field.geometry();
    let Some(middle) = geometry.cell_at(point) else { return Vec::new() };
    let mut cells = Vec::new();
    for dy in -RING..=RING {
        for dx in -RING..=RING {
            let (c, r) = (middle.col as i64 + dx, middle.row as i64 + dy);
            if c < 0 || r < 0 || c >= geometry.width as i64 || r >= geometry.height as i64 {
                continue;
            }
            let cell = r as usize * geometry.width + c as usize;
            if space.is_free_cell(cell) && space.sees(point, space.center(cell)) {
                cells.push(cell);
            }
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{DistanceField, RoomConfig, UnknownIs};
    use trundle_core::OccupancyGrid;

    #[test]
    fn the_wave_goes_round_and_stops_where_it_cannot() {
        let art = "
            ...........
            .#########.
            .........#.
            .#######.##
            ........#..";
        let grid = OccupancyGrid::from_ascii(1.0, art).unwrap();
        let field = DistanceField::from_grid(&grid, UnknownIs::Free);
        let at = Vector2::new;
        let space = Space::new(&field, &grid, RoomConfig::default(), 0.4, at(0.5, 4.5));
        let mut wave = WaveFront::default();
        let Wave::Met(path) = wave.run(&space, at(0.5, 4.5), at(8.5, 2.5)) else { panic!("stuck") };
        assert_eq!((path[0], path[path.len() - 1]), (at(0.5, 4.5), at(8.5, 2.5)));
        assert!(path.iter().all(|p| space.is_free(*p)));
        let stuck = wave.run(&space, at(0.5, 4.5), at(9.5, 0.5));
        assert_eq!(stuck, Wave::Stuck(at(8.5, 1.5)));
    }
}
