//! The geodesic potential: a wave that runs from the start around obstacles until it meets the goal.
//!
//! Problem: the printed potential has local minima. Idea: replace the straight distance in the attraction by the
//! geodesic one, and the repulsion by slowness of the wave near obstacles; such a potential has one minimum, and
//! descending it is following the wave back. The wave runs towards the goal first (A*, \[Hart68\]) on the 8-neighbour
//! lattice of cells where the robot fits, every step checked against the obstacles' squares. Complete: if the lattice
//! connects, the way is found. Cost: O(cells reached), in buckets whose turn sorts them.

use crate::buckets::{Buckets, Entry};
use crate::space::Space;
use std::f64::consts::SQRT_2;
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
    cost: Vec<f32>,
    /// Which of [`STEPS`] led here, [`SEED`] for the first ring.
    step: Vec<u8>,
    queue: Buckets,
}

const STEPS: [(i64, i64); 8] = [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)];
const SEED: u8 = 8;
/// How far around the start and the goal the lattice may be entered, cells.
const RING: i64 = 2;

impl WaveFront {
    /// Runs the wave from `start` to `goal`, both free and inside the field.
    pub(crate) fn run(&mut self, space: &Space<'_>, start: Vector2, goal: Vector2) -> Wave {
        let resolution = space.field.geometry().resolution;
        self.reset(space, octile(goal - start), resolution);
        let mut nearest = start;
        for (cell, length) in ring(space, start) {
            self.reach(
                cell,
                space.cost(start, space.center(cell)).max(length),
                SEED,
                octile_to(space, cell, goal),
            );
        }
        let ends = ring(space, goal);
        let mut best: Option<(f64, usize)> = None;
        while let Some(Entry { key, cell, cost }) = self.queue.pop() {
            if best.is_some_and(|(total, _)| key >= total) {
                break;
            }
            let cell = cell as usize;
            if cost > self.cost[cell] {
                continue;
            }
            if ends.iter().any(|end| end.0 == cell) {
                let total = f64::from(cost) + octile_to(space, cell, goal);
                if best.is_none_or(|(least, _)| total < least) {
                    best = Some((total, cell));
                }
            }
            let center = space.center(cell);
            if best.is_none() && (center - goal).norm_squared() < (nearest - goal).norm_squared() {
                nearest = center;
            }
            self.spread(space, cell, goal);
        }
        match best {
            Some((_, cell)) => Wave::Met(self.follow_back(space, cell, start, goal)),
            None => Wave::Stuck(nearest),
        }
    }

    fn reset(&mut self, space: &Space<'_>, base: f64, step: f64) {
        let cells = space.field.geometry().len();
        self.cost.clear();
        self.cost.resize(cells, f32::INFINITY);
        self.step.resize(cells, SEED);
        self.queue.reset(base, step);
    }

    fn reach(&mut self, cell: usize, cost: f64, step: u8, ahead: f64) {
        let stored = cost as f32;
        // Costs of the same length differ in their last bits by the order of their sums: no reason to start again.
        if stored < self.cost[cell] * (1.0 - 1e-6) || self.cost[cell] == f32::INFINITY {
            self.cost[cell] = stored;
            self.step[cell] = step;
            self.queue.push(Entry { key: cost + ahead, cost: stored, cell: cell as u32 });
        }
    }

    fn spread(&mut self, space: &Space<'_>, from: usize, goal: Vector2) {
        let geometry = space.field.geometry();
        let (width, height) = (geometry.width as i64, geometry.height as i64);
        let (col, row) = ((from % geometry.width) as i64, (from / geometry.width) as i64);
        let here = space.cell_density(from);
        let so_far = f64::from(self.cost[from]);
        for (step, (dx, dy)) in STEPS.into_iter().enumerate() {
            let (c, r) = (col + dx, row + dy);
            if c < 0 || r < 0 || c >= width || r >= height {
                continue;
            }
            let to = (r * width + c) as usize;
            let length = geometry.resolution * if step < 4 { 1.0 } else { SQRT_2 };
            if f64::from(self.cost[to]) <= so_far + length || !space.is_free_cell(to) {
                continue;
            }
            let cost = so_far + length * (here + space.cell_density(to)) / 2.0;
            if (cost as f32) < self.cost[to] && space.joins(from, to, length) {
                self.reach(to, cost, step as u8, octile_to(space, to, goal));
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
}

/// The free cells around a point that it can reach straight, with the way there, m.
fn ring(space: &Space<'_>, point: Vector2) -> Vec<(usize, f64)> {
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
                cells.push((cell, (space.center(cell) - point).norm()));
            }
        }
    }
    cells
}

/// The length of the shortest way over the 8-neighbour lattice, were it empty, m.
fn octile(off: Vector2) -> f64 {
    let (x, y) = (off.x.abs(), off.y.abs());
    x.max(y) + (SQRT_2 - 1.0) * x.min(y)
}

fn octile_to(space: &Space<'_>, cell: usize, goal: Vector2) -> f64 {
    octile(goal - space.center(cell))
}
