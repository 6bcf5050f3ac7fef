//! A lower bound of the cost to the goal on a coarse grid: the heuristic of the search.
//!
//! Problem: a search led by the straight distance expands every dead end on its path. Idea: search first over blocks of cells; each block
//! is as free and as cheap as its best cell. This search is small. Its costs are, up to a block's side, a lower bound of the true ones that
//! includes walls and dead ends. The search runs from the goal towards the start (A*) and slightly farther, to cover all blocks that the
//! fine search may reach. Cost: O(blocks between start and goal).

use crate::search::bucket_queue::{BucketQueue, Entry};
use crate::search::configuration_space::ConfigurationSpace;
use crate::search::lattice::{self, LONGEST_STEP, STEPS};
use trundle_grid::{BLOCK_SIDE_CELLS, BlockMaxima};

/// Cost of a block that the search has not reached.
const UNREACHED: u32 = u32::MAX;
/// Side of a block \[cells\].
const BLOCK_LENGTH: u32 = BLOCK_SIDE_CELLS as u32;

/// The heuristic with its buffers, reused from plan to plan.
#[derive(Debug, Default)]
pub(crate) struct CoarseHeuristic {
    /// Cost to the goal from each block's middle, in units.
    cost: Vec<u32>,
    /// Cost of a unit of length in each block, in 1/256; 0 if the robot does not fit.
    price: Vec<u16>,
    queue: BucketQueue,
    width: usize,
    height: usize,
    /// Lower bound of the cost through blocks that were not reached; [`UNREACHED`] when all reachable blocks have costs.
    frontier: u32,
    target: (u32, u32),
    /// The block that the search runs towards, column and row.
    towards: (u32, u32),
    found: bool,
}

impl CoarseHeuristic {
    /// Prepares the heuristic for a search from cell `start` to cell `target` (columns and rows).
    pub(crate) fn prepare(&mut self, space: &ConfigurationSpace<'_>, start: (u32, u32), target: (u32, u32)) {
        let BlockMaxima { width, height, distance: room } = space.field.blocks();
        (self.width, self.height, self.target) = (*width, *height, target);
        self.price.clear();
        self.price.extend(room.iter().map(|room| space.price_of_room(*room)));
        self.cost.clear();
        self.cost.resize(room.len(), UNREACHED);
        let block =
            |(col, row): (u32, u32)| (row / BLOCK_LENGTH) as usize * width + (col / BLOCK_LENGTH) as usize;
        self.towards = (start.0 / BLOCK_LENGTH, start.1 / BLOCK_LENGTH);
        // A step's own cost, and as much again for the change of the remaining distance.
        let reach = LONGEST_STEP * BLOCK_LENGTH * (u32::from(space.highest_price()) + 256);
        self.queue.reset(self.remaining(block(target)), reach >> 8);
        self.reach(block(target), 0);
        self.spread(block(start));
    }

    fn reach(&mut self, block: usize, cost: u32) {
        self.cost[block] = cost;
        self.queue.push(cost + self.remaining(block), Entry { cell: block as u32, cost });
    }

    /// Lower bound of the cost from a block to the start.
    fn remaining(&self, block: usize) -> u32 {
        let (col, row) = ((block % self.width) as u32, (block / self.width) as u32);
        BLOCK_LENGTH * lattice::between((col.abs_diff(self.towards.0), row.abs_diff(self.towards.1)))
    }

    /// Runs until every block has its cost if the path through it to the block `last` costs little more than the cheapest path.
    fn spread(&mut self, last: usize) {
        let beyond = 4 * LONGEST_STEP * BLOCK_LENGTH;
        let mut limit = UNREACHED;
        (self.found, self.frontier) = (false, 0);
        while let Some((key, Entry { cell, cost })) = self.queue.pop() {
            self.frontier = key;
            if key > limit {
                return;
            }
            let block = cell as usize;
            if cost > self.cost[block] {
                continue;
            }
            if block == last {
                (self.found, limit) = (true, key + beyond);
            }
            self.step_from(block);
        }
        self.frontier = UNREACHED;
    }

    fn step_from(&mut self, block: usize) {
        let (col, row) = ((block % self.width) as i32, (block / self.width) as i32);
        let (so_far, here) = (self.cost[block], u32::from(self.price[block]).max(256));
        for (step, (dx, dy)) in STEPS.into_iter().enumerate() {
            let Some(to) = self.block_at(col + dx, row + dy) else { continue };
            let length = lattice::length(step) * BLOCK_LENGTH;
            let there = u32::from(self.price[to]);
            let cost = so_far + ((length * (here + there)) >> 9);
            if there != 0 && cost < self.cost[to] && self.passes((col, row), (dx, dy)) {
                self.reach(to, cost);
            }
        }
    }

    /// Whether either of the blocks crossed by a knight's move is free.
    fn passes(&self, (col, row): (i32, i32), (dx, dy): (i32, i32)) -> bool {
        if dx.abs() + dy.abs() < 3 {
            return true;
        }
        let near = (col + dx / 2, row + dy / 2);
        let far = (
            col + dx - dx.signum() * i32::from(dx.abs() == 2),
            row + dy - dy.signum() * i32::from(dy.abs() == 2),
        );
        [near, far].into_iter().any(|(c, r)| self.block_at(c, r).is_some_and(|block| self.price[block] != 0))
    }

    fn block_at(&self, col: i32, row: i32) -> Option<usize> {
        let inside = col >= 0 && row >= 0 && (col as usize) < self.width && (row as usize) < self.height;
        inside.then(|| row as usize * self.width + col as usize)
    }

    /// A lower bound (up to a block's side) of the cost from a cell to the target.
    pub(crate) fn ahead(&self, (col, row): (u32, u32)) -> u32 {
        let straight = lattice::between((col.abs_diff(self.target.0), row.abs_diff(self.target.1)));
        if self.found { straight.max(self.interpolated(col, row)) } else { straight }
    }

    /// Bilinear interpolation between the middles of blocks; a block without a cost counts as the cheapest of its neighbours.
    fn interpolated(&self, col: u32, row: u32) -> u32 {
        // Offset in eighths of a block, from the middle of the lower left block.
        let place = |at: u32, size: usize| {
            let eighths = (2 * at + 1) as i32 - BLOCK_SIDE_CELLS as i32;
            let low = eighths.div_euclid(2 * BLOCK_SIDE_CELLS as i32);
            let part = eighths.rem_euclid(2 * BLOCK_SIDE_CELLS as i32) as u64;
            let clamp = |index: i32| index.clamp(0, size as i32 - 1) as usize;
            (clamp(low), clamp(low + 1), part)
        };
        let (left, right, u) = place(col, self.width);
        let (low, high, v) = place(row, self.height);
        let corners = [(left, low), (right, low), (left, high), (right, high)];
        let blocks = corners.map(|(c, r)| r * self.width + c);
        let costs = blocks.map(|block| self.cost[block]);
        let mut min = costs.into_iter().fold(UNREACHED, u32::min);
        if self.frontier < UNREACHED && costs.contains(&UNREACHED) {
            let bound = |block: usize| self.frontier.saturating_sub(self.remaining(block));
            min = blocks.into_iter().map(bound).fold(min, u32::min);
        }
        if min == UNREACHED {
            return 0;
        }
        let [a, b, c, d] = costs.map(|cost| u64::from(if cost == UNREACHED { min } else { cost }));
        let side = 2 * BLOCK_SIDE_CELLS as u64;
        let (below, above) = (a * (side - u) + b * u, c * (side - u) + d * u);
        let middle = (below * (side - v) + above * v) / (side * side);
        middle.saturating_sub(u64::from(lattice::SIDE * BLOCK_LENGTH / 2)) as u32
    }
}
