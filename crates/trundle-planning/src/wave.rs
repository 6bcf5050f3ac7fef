//! The geodesic potential: a wave that runs from the start around obstacles until it meets the goal.
//!
//! Problem: the printed potential has local minima. Idea: replace the straight distance in the attraction by the
//! geodesic one, and the repulsion by slowness of the wave near obstacles; such a potential has one minimum, and
//! descending it is following the wave back. The wave runs towards the goal first (A*, \[Hart68\]), led by the [`Guide`],
//! on the 16-neighbour lattice of cells where the robot fits, every step checked against the obstacles' squares. Complete: if the lattice connects, the way is found. Costs are whole numbers, so a list
//! for each key makes a queue without comparisons (\[Dial69\]). Cost: O(cells reached).

use crate::dial::{Dial, Entry};
use crate::guide::Guide;
use crate::lattice::{LONGEST, SIDE, STEPS, length};
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
    guide: Guide,
}

const SEED: u8 = 16;
/// Marks a cell in [`WaveFront::step`] that has been spread from: it is not entered again.
const CLOSED: u8 = 128;
/// The way ahead counts for 1 / this more than the guide says, so that of equal ways one is followed to its end. A way costs
/// about so much more than the cheapest, at most.
const EAGERNESS: u32 = 32;
const NEVER: u32 = u32::MAX;
/// How far around the start and the goal the lattice may be entered, cells.
const RING: i64 = 2;

impl WaveFront {
    /// Runs the wave from `start` to `goal`, both free and inside the field.
    pub(crate) fn run(&mut self, space: &Space<'_>, start: Vector2, goal: Vector2) -> Wave {
        let (Some(from), Some(target)) = (place_of(space, start), place_of(space, goal)) else {
            return Wave::Stuck(start);
        };
        self.guide.prepare(space, from, target);
        self.seed(space, start);
        let ends = ring(space, goal);
        while let Some((_, Entry { cell, cost })) = self.queue.pop() {
            let cell = cell as usize;
            if cost > self.cost[cell] || self.step[cell] & CLOSED != 0 {
                continue;
            }
            self.step[cell] |= CLOSED;
            if ends.contains(&cell) {
                return Wave::Met(self.follow_back(space, cell, start, goal));
            }
            self.spread(space, cell);
        }
        Wave::Stuck(self.nearest(space, start, goal))
    }

    fn seed(&mut self, space: &Space<'_>, start: Vector2) {
        self.cost.clear();
        self.cost.resize(space.field.geometry().len(), NEVER);
        self.step.clear();
        self.step.resize(self.cost.len(), SEED);
        let seeds: Vec<_> = ring(space, start)
            .into_iter()
            .map(|cell| (cell, entry_cost(space, start, cell)))
            .map(|(cell, cost)| (cell, cost, self.key(cost, space.place(cell))))
            .collect();
        let first = seeds.iter().map(|seed| seed.2).min().unwrap_or(0);
        // The guide is smooth: a step changes it by little more than the step's own cost.
        let reach = (16 * ((LONGEST * u32::from(space.highest_price())) >> 8)).min(1 << 18);
        self.queue.reset(first, reach);
        for (cell, cost, key) in seeds {
            self.reach(cell, cost, SEED, key);
        }
    }

    fn key(&self, cost: u32, place: (u32, u32)) -> u32 {
        let ahead = self.guide.ahead(place);
        cost.saturating_add(ahead).saturating_add(ahead / EAGERNESS)
    }

    fn reach(&mut self, cell: usize, cost: u32, step: u8, key: u32) {
        self.cost[cell] = cost;
        self.step[cell] = step;
        self.queue.push_near(key, Entry { cell: cell as u32, cost });
    }

    fn spread(&mut self, space: &Space<'_>, from: usize) {
        let geometry = space.field.geometry();
        let (width, height) = (geometry.width as i32, geometry.height as i32);
        let (col, row) = space.place(from);
        let here = u32::from(space.cell_price(from));
        let so_far = self.cost[from];
        for (step, (dx, dy)) in STEPS.into_iter().enumerate() {
            let (c, r) = (col as i32 + dx, row as i32 + dy);
            if c < 0 || r < 0 || c >= width || r >= height {
                continue;
            }
            let to = r as usize * width as usize + c as usize;
            if self.cost[to] <= so_far.saturating_add(length(step))
                || self.step[to] & CLOSED != 0
                || !space.is_free_cell(to)
            {
                continue;
            }
            let cost = so_far.saturating_add((length(step) * (here + u32::from(space.cell_price(to)))) >> 9);
            let metres = geometry.resolution * f64::from(length(step)) / f64::from(SIDE);
            if cost < self.cost[to] && space.joins(from, to, metres) {
                self.reach(to, cost, step as u8, self.key(cost, (c as u32, r as u32)));
            }
        }
    }

    fn follow_back(&self, space: &Space<'_>, last: usize, start: Vector2, goal: Vector2) -> Vec<Vector2> {
        let width = space.field.geometry().width as i64;
        let mut points = vec![goal];
        let mut cell = last;
        loop {
            points.push(space.center(cell));
            let step = self.step[cell] & !CLOSED;
            if step == SEED {
                break;
            }
            let (dx, dy) = STEPS[usize::from(step)];
            cell = (cell as i64 - i64::from(dy) * width - i64::from(dx)) as usize;
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

/// Column and row of the cell that holds a point.
fn place_of(space: &Space<'_>, point: Vector2) -> Option<(u32, u32)> {
    space.field.geometry().cell_at(point).map(|cell| (cell.col as u32, cell.row as u32))
}

/// The cost of the straight move between a point and the centre of a cell.
fn entry_cost(space: &Space<'_>, point: Vector2, cell: usize) -> u32 {
    let resolution = space.field.geometry().resolution;
    (space.cost(point, space.center(cell)) / resolution * f64::from(SIDE)) as u32
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
