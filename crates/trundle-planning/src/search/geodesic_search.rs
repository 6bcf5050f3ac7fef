//! The geodesic search: waypoints around obstacles without local minima.
//!
//! Problem: the artificial potential has local minima. Idea: replace the straight distance in the attraction by the geodesic one, and the
//! repulsion by higher costs near obstacles. Such a potential has one minimum, and its descent is the search's own path back. The search is
//! A* (\[Hart68\]) with the [`CoarseHeuristic`], on the 16-neighbour lattice of cells that fit the robot; every step is checked against the
//! occupied cells. Complete: a path that exists on the lattice is found. Costs are whole numbers: one list per key makes a queue without
//! comparisons (\[Dial69\]). Cost: O(cells reached).

use crate::search::bucket_queue::{BucketQueue, Entry};
use crate::search::coarse_heuristic::CoarseHeuristic;
use crate::search::configuration_space::ConfigurationSpace;
use crate::search::lattice::{LONGEST_STEP, SIDE, STEPS, length};
use trundle_core::Vector2;

/// Result of the geodesic search.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum SearchOutcome {
    /// The cheapest path: start, cell centres, goal.
    Found(Vec<Vector2>),
    /// The goal is unreachable; contains the reachable point nearest to it.
    Unreachable(Vector2),
}

/// The search with its buffers, reused from plan to plan.
#[derive(Debug, Default)]
pub(crate) struct GeodesicSearch {
    /// Lowest cost so far, in units; [`UNREACHED`] for a cell without a cost.
    cost: Vec<u32>,
    /// The step of [`STEPS`] that led here, [`SEED_MARK`] for the first entry_cells.
    step: Vec<u8>,
    queue: BucketQueue,
    heuristic: CoarseHeuristic,
}

/// Mark of a cell in [`GeodesicSearch::step`] from which the search starts.
const SEED_MARK: u8 = 16;
/// Mark of a cell in [`GeodesicSearch::step`] that has been expanded: it is not entered again.
const CLOSED_MARK: u8 = 128;
/// Inverse of the weight on the heuristic: of equal paths one is followed to its end. A path costs at most 1 / this more than the
/// cheapest. Source: ours.
const HEURISTIC_WEIGHT_INVERSE: u32 = 32;
/// Cost of a cell that the search has not reached.
const UNREACHED: u32 = u32::MAX;
/// Radius of the lattice entry around start and goal, cells. Source: ours.
const ENTRY_RADIUS_CELLS: i64 = 2;

impl GeodesicSearch {
    /// Searches from `start` to `goal`, both free and inside the field.
    pub(crate) fn run(
        &mut self,
        space: &ConfigurationSpace<'_>,
        start: Vector2,
        goal: Vector2,
    ) -> SearchOutcome {
        let (Some(from), Some(target)) = (cell_of(space, start), cell_of(space, goal)) else {
            return SearchOutcome::Unreachable(start);
        };
        self.heuristic.prepare(space, from, target);
        self.seed(space, start);
        let ends = entry_cells(space, goal);
        while let Some((_, Entry { cell, cost })) = self.queue.pop() {
            let cell = cell as usize;
            if cost > self.cost[cell] || self.step[cell] & CLOSED_MARK != 0 {
                continue;
            }
            self.step[cell] |= CLOSED_MARK;
            if ends.contains(&cell) {
                return SearchOutcome::Found(self.follow_back(space, cell, start, goal));
            }
            self.spread(space, cell);
        }
        SearchOutcome::Unreachable(self.nearest(space, start, goal))
    }

    fn seed(&mut self, space: &ConfigurationSpace<'_>, start: Vector2) {
        self.cost.clear();
        self.cost.resize(space.field.geometry().len(), UNREACHED);
        self.step.clear();
        self.step.resize(self.cost.len(), SEED_MARK);
        let seeds: Vec<_> = entry_cells(space, start)
            .into_iter()
            .map(|cell| (cell, entry_cost(space, start, cell)))
            .map(|(cell, cost)| (cell, cost, self.key(cost, space.place(cell))))
            .collect();
        let first = seeds.iter().map(|seed| seed.2).min().unwrap_or(0);
        // The heuristic is smooth: a step changes it by little more than the step's own cost.
        let reach = (16 * ((LONGEST_STEP * u32::from(space.highest_price())) >> 8)).min(1 << 18);
        self.queue.reset(first, reach);
        for (cell, cost, key) in seeds {
            self.reach(cell, cost, SEED_MARK, key);
        }
    }

    fn key(&self, cost: u32, place: (u32, u32)) -> u32 {
        let ahead = self.heuristic.ahead(place);
        cost.saturating_add(ahead).saturating_add(ahead / HEURISTIC_WEIGHT_INVERSE)
    }

    fn reach(&mut self, cell: usize, cost: u32, step: u8, key: u32) {
        self.cost[cell] = cost;
        self.step[cell] = step;
        self.queue.push_near(key, Entry { cell: cell as u32, cost });
    }

    fn spread(&mut self, space: &ConfigurationSpace<'_>, from: usize) {
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
                || self.step[to] & CLOSED_MARK != 0
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

    fn follow_back(
        &self,
        space: &ConfigurationSpace<'_>,
        last: usize,
        start: Vector2,
        goal: Vector2,
    ) -> Vec<Vector2> {
        let width = space.field.geometry().width as i64;
        let mut points = vec![goal];
        let mut cell = last;
        loop {
            points.push(space.point_of(cell));
            let step = self.step[cell] & !CLOSED_MARK;
            if step == SEED_MARK {
                break;
            }
            let (dx, dy) = STEPS[usize::from(step)];
            cell = (cell as i64 - i64::from(dy) * width - i64::from(dx)) as usize;
        }
        points.push(start);
        points.reverse();
        points
    }

    /// The reached cell nearest to the goal.
    fn nearest(&self, space: &ConfigurationSpace<'_>, start: Vector2, goal: Vector2) -> Vector2 {
        let reached = (0..self.cost.len())
            .filter(|cell| self.cost[*cell] != UNREACHED)
            .map(|cell| space.point_of(cell));
        let nearer =
            |a: &Vector2, b: &Vector2| (a - goal).norm_squared().total_cmp(&(b - goal).norm_squared());
        reached.min_by(nearer).unwrap_or(start)
    }
}

/// Column and row of the cell that holds a point.
fn cell_of(space: &ConfigurationSpace<'_>, point: Vector2) -> Option<(u32, u32)> {
    space.field.geometry().cell_at(point).map(|cell| (cell.col as u32, cell.row as u32))
}

/// The cost of a straight move between a point and the centre of a cell.
fn entry_cost(space: &ConfigurationSpace<'_>, point: Vector2, cell: usize) -> u32 {
    let resolution = space.field.geometry().resolution;
    (space.cost(point, space.point_of(cell)) / resolution * f64::from(SIDE)) as u32
}

/// The free cells around a point that are reachable from it along a straight line.
fn entry_cells(space: &ConfigurationSpace<'_>, point: Vector2) -> Vec<usize> {
    let geometry = space.field.geometry();
    let Some(middle) = geometry.cell_at(point) else { return Vec::new() };
    let mut cells = Vec::new();
    for dy in -ENTRY_RADIUS_CELLS..=ENTRY_RADIUS_CELLS {
        for dx in -ENTRY_RADIUS_CELLS..=ENTRY_RADIUS_CELLS {
            let (c, r) = (middle.col as i64 + dx, middle.row as i64 + dy);
            if c < 0 || r < 0 || c >= geometry.width as i64 || r >= geometry.height as i64 {
                continue;
            }
            let cell = r as usize * geometry.width + c as usize;
            if space.is_free_cell(cell) && space.connects(point, space.point_of(cell)) {
                cells.push(cell);
            }
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::clearance_cost::ClearanceCostConfig;
    use trundle_core::OccupancyGrid;
    use trundle_grid::{DistanceField, UnknownIs};

    #[test]
    fn the_search_goes_around_walls_and_reports_the_nearest_reachable_point() {
        let art = "
            ...........
            .#########.
            .........#.
            .#######.##
            ........#..";
        let grid = OccupancyGrid::from_ascii(1.0, art).unwrap();
        let field = DistanceField::from_grid(&grid, UnknownIs::Free);
        let at = Vector2::new;
        let space = ConfigurationSpace::new(&field, &grid, ClearanceCostConfig::default(), 0.4, at(0.5, 4.5));
        let mut search = GeodesicSearch::default();
        let SearchOutcome::Found(path) = search.run(&space, at(0.5, 4.5), at(8.5, 2.5)) else {
            panic!("stuck")
        };
        assert_eq!((path[0], path[path.len() - 1]), (at(0.5, 4.5), at(8.5, 2.5)));
        assert!(path.iter().all(|p| space.is_free(*p)));
        let stuck = search.run(&space, at(0.5, 4.5), at(9.5, 0.5));
        assert_eq!(stuck, SearchOutcome::Unreachable(at(8.5, 1.5)));
    }
}
