//! Squared distances of one row: the minimum of parabolas at the vertical edges of its cells.
//!
//! The point of a square nearest to the centre of another column is on the square's near edge. Therefore width + 1 parabolas give distances
//! to squares instead of centres; the height of each comes from the nearer of its two columns. A cell tries the edges at 1/2, 3/2, ...
//! cells on either side, until the edge itself is farther than the best distance. Whole blocks of cells are processed without a branch
//! \[Huang94\]. The lower envelope of \[Felzenszwalb12\] tries fewer edges on free floor, but has a branch at each. Lengths are in half
//! cells, so squares are whole numbers: exact in f32 up to 2048 cells.

use std::ops::Range;

/// Cells that are processed together. Source: ours.
const CELLS_PER_BLOCK: usize = 32;
/// Edges between two checks for the end of the search. Source: ours.
const EDGES_PER_CHECK: usize = 4;

/// The memory of a row.
#[derive(Debug, Default)]
pub(super) struct Erosion {
    /// Heights of columns, and of the edges between them.
    column: Vec<f32>,
    edge: Vec<f32>,
    /// Squared distances of the requested columns, and padding of the last block.
    squared: Vec<f32>,
}

/// Gaps of a row's columns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gaps<'a> {
    pub(super) of: &'a [u16],
    /// Smallest count that means a column without an obstacle.
    pub(super) none: u16,
    /// Count of the columns outside the grid.
    pub(super) border: u16,
}

impl Erosion {
    /// Computes the columns `cols` of a row.
    pub(super) fn erode(&mut self, gaps: Gaps<'_>, cols: Range<usize>) {
        self.squared.clear();
        self.squared.extend(gaps.of[cols.clone()].iter().map(|gap| height(*gap, gaps.none)));
        let max = self.squared.iter().fold(0.0_f32, |max, own| if *own > max { *own } else { max });
        let farthest = height(gaps.none - 1, gaps.none);
        let reach = edge_count(max.min(farthest), gaps.of.len() + 1);
        let blocks = cols.len().div_ceil(CELLS_PER_BLOCK);
        self.squared.resize(blocks * CELLS_PER_BLOCK, 0.0);
        self.fill_edges(gaps, cols.start, blocks * CELLS_PER_BLOCK, reach);
        for (i, block) in self.squared.chunks_exact_mut(CELLS_PER_BLOCK).enumerate() {
            let block: &mut [f32; CELLS_PER_BLOCK] = block.try_into().expect("invariant: a whole block");
            erode_block(block, &self.edge, i * CELLS_PER_BLOCK + reach, reach);
        }
    }

    /// Heights of the edges for the cells from `first` on, each from the nearer of its two columns. The border is one column: further
    /// columns are farther away.
    fn fill_edges(&mut self, gaps: Gaps<'_>, first: usize, cells: usize, reach: usize) {
        // From the column left of the first edge to the column right of the last.
        let before = (reach + 1).saturating_sub(first);
        let begin = (first + before) - (reach + 1);
        let end = (first + cells + reach + 1).min(gaps.of.len());
        let wanted = cells + 2 * reach + 2;
        let beside = height(gaps.border, gaps.none);
        self.column.clear();
        self.column.resize(before, f32::INFINITY);
        if let Some(border) = self.column.last_mut() {
            *border = beside;
        }
        self.column.extend(gaps.of[begin..end].iter().map(|gap| height(*gap, gaps.none)));
        if self.column.len() < wanted {
            self.column.push(beside);
        }
        self.column.resize(wanted, f32::INFINITY);
        self.edge.clear();
        let beside = self.column.iter().zip(&self.column[1..]);
        self.edge.extend(beside.map(|(left, right)| if left < right { *left } else { *right }));
    }

    /// Distances of the columns, m, at most `reach`.
    pub(super) fn write(&self, distance: &mut [f32], resolution: f64, reach: f64) {
        let (half, reach) = ((resolution / 2.0) as f32, reach as f32);
        for (distance, squared) in distance.iter_mut().zip(&self.squared) {
            let exact = squared.sqrt() * half;
            *distance = if exact < reach { exact } else { reach };
        }
    }
}

/// Number of edges on either side before the foot of a parabola, 2k + 1, is as far as `squared`.
fn edge_count(squared: f32, at_most: usize) -> usize {
    let edge_count = (squared.sqrt() / 2.0).ceil();
    ((edge_count as usize).min(at_most) + 1).next_multiple_of(EDGES_PER_CHECK)
}

/// Processes the cells from the one with the left edge `edge[at]` on; all have `reach` more edges on either side.
fn erode_block(block: &mut [f32; CELLS_PER_BLOCK], edge: &[f32], at: usize, reach: usize) {
    let mut best = *block;
    for begin in (0..reach).step_by(EDGES_PER_CHECK) {
        for k in begin..begin + EDGES_PER_CHECK {
            let foot = ((2 * k + 1) * (2 * k + 1)) as f32;
            let left: &[f32; CELLS_PER_BLOCK] =
                edge[at - k..][..CELLS_PER_BLOCK].try_into().expect("invariant: edges around");
            let right: &[f32; CELLS_PER_BLOCK] =
                edge[at + 1 + k..][..CELLS_PER_BLOCK].try_into().expect("invariant: edges around");
            for i in 0..CELLS_PER_BLOCK {
                let lower = if left[i] < right[i] { left[i] } else { right[i] } + foot;
                best[i] = if lower < best[i] { lower } else { best[i] };
            }
        }
        let next = ((2 * (begin + EDGES_PER_CHECK) + 1) * (2 * (begin + EDGES_PER_CHECK) + 1)) as f32;
        if best.iter().fold(0.0_f32, |max, b| if *b > max { *b } else { max }) <= next {
            break;
        }
    }
    *block = best;
}

/// The squared vertical gap, in half cells, between a cell's centre and a square `count` rows away.
fn height(count: u16, none: u16) -> f32 {
    let halves = (2.0 * f32::from(count) - 1.0).max(0.0);
    if count >= none { f32::INFINITY } else { halves * halves }
}
