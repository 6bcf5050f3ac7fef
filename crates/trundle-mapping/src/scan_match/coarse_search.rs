//! Correlative search about a guess on the coarse likelihood.

use crate::scan_match::likelihood::{RotatedPose, floor};
use crate::scan_match::scan_points::ScanPoints;
use nalgebra::Matrix3;
use trundle_core::Pose2;
use trundle_grid::tiles::{Tile, TileWindow};

/// Side of the coarse field of a tile [samples of two cells].
const SAMPLES_PER_TILE_SIDE: usize = Tile::COARSE_SIDE;

/// Distance of the samples of the coarse likelihood \[cells\]. Source: ours.
const SAMPLE_STEP_CELLS: f64 = 2.0;
/// Maximum reach of the search to each side [samples]. A wider prior is searched up to this reach. Source: ours.
const MAX_REACH_SAMPLES: usize = 7;
/// Number of samples of one vector: a tile's side.
const LANES: usize = 16;
const _: () = assert!(SAMPLES_PER_TILE_SIDE == LANES && 2 * MAX_REACH_SAMPLES < LANES);
/// Maximum number of points of the search. Larger scans are subsampled. Source: ours.
const MAX_SEARCH_POINTS: usize = 80;

/// The correlative search: all poses of a lattice about a guess, on the coarse field (\[Olson09\]).
#[derive(Debug, Clone, Default)]
pub(crate) struct CoarseSearch {
    /// The coarse field as one array, row by row, with a margin of one tile. Zero outside the copied tiles.
    field: Vec<u8>,
    stride: usize,
    rows: usize,
    /// Whether each tile (margin included) is copied.
    laid: Vec<bool>,
    firsts: Vec<usize>,
    /// Whether each tile is copied together with its right, upper and upper right neighbours.
    blocks: Vec<bool>,
    /// The points of the search, base frame, cells.
    points: Vec<(f32, f32)>,
    best: Vec<(f64, Pose2)>,
}

/// Start of the search, and the penalty for distant poses.
pub(crate) struct SearchPrior {
    /// Inverse covariance of the guess: cells, rad.
    pub(crate) information: Matrix3<f64>,
    /// Standard deviation of the guess, cells.
    pub(crate) sigma: f64,
    /// Standard deviation of the guess's heading, rad.
    pub(crate) sigma_turn: f64,
    /// Gain of a point that fits over one that does not, nats.
    pub(crate) gain: f64,
}

/// Sums of likelihoods: row by row, 16 columns each; columns beyond the reach are not used.
type Sums = [[u16; LANES]; 2 * MAX_REACH_SAMPLES + 1];
const NO_SUMS: Sums = [[0; LANES]; 2 * MAX_REACH_SAMPLES + 1];

impl CoarseSearch {
    /// The best poses, at most one per heading, the best first; all within `margin` nats of the best one. `guess` in cells of the window.
    pub(crate) fn search(
        &mut self,
        window: &TileWindow<'_>,
        shape: &ScanPoints,
        guess: Pose2,
        (prior, margin): (&SearchPrior, f64),
    ) -> &[(f64, Pose2)] {
        self.cover(window);
        self.best.clear();
        let reach = ((3.0 * prior.sigma / SAMPLE_STEP_CELLS).ceil() as usize).clamp(2, MAX_REACH_SAMPLES);
        let turn_step = (SAMPLE_STEP_CELLS / shape.spread.lever).clamp(0.004, 0.05);
        let turns = ((3.0 * prior.sigma_turn / turn_step).ceil() as i32)
            .clamp(1, (std::f64::consts::PI / turn_step) as i32);
        let every = shape.points.len().div_ceil(MAX_SEARCH_POINTS).max(1);
        self.points.clear();
        self.points.extend(shape.points.iter().step_by(every).map(|p| (p.x, p.y)));
        let gain = prior.gain * every as f64 / 255.0;
        // Order from the middle outwards: the bound then soon excludes the rest.
        let outwards = (0..=turns).flat_map(|turn| [turn, -turn]).skip(1);
        let mut top = f64::NEG_INFINITY;
        for turn in outwards {
            let theta = f64::from(turn) * turn_step;
            let pose = Pose2 { theta: guess.theta + theta, ..guess };
            let sums = self.sum_up(window, pose, reach);
            let greatest = sums.as_flattened().iter().fold(0, |a, b| a.max(*b));
            if gain * f64::from(greatest) < top - margin {
                continue;
            }
            let best = best_shift(&sums, reach, gain, &Turned { prior: &prior.information, theta });
            top = top.max(best.0);
            let (x, y) = (guess.x + best.1, guess.y + best.2);
            self.best.push((best.0, Pose2 { x, y, ..pose }));
        }
        self.best.sort_by(|a, b| b.0.total_cmp(&a.0));
        &self.best
    }

    /// Clears the field for a new window.
    fn cover(&mut self, window: &TileWindow<'_>) {
        for first in self.firsts.drain(..) {
            for k in 0..SAMPLES_PER_TILE_SIDE {
                self.field[first + k * self.stride..][..SAMPLES_PER_TILE_SIDE].fill(0);
            }
        }
        let (cols, rows) = window.size();
        (self.stride, self.rows) = ((cols + 2) * SAMPLES_PER_TILE_SIDE, (rows + 2) * SAMPLES_PER_TILE_SIDE);
        if self.field.len() < self.stride * self.rows {
            self.field.resize(self.stride * self.rows, 0);
        }
        self.laid.clear();
        self.laid.resize((cols + 2) * (rows + 2), false);
        self.blocks.clear();
        self.blocks.resize((cols + 2) * (rows + 2), false);
    }

    /// Copies a tile (margin included) to its place, unless outside the window or copied before.
    fn lay_out(&mut self, window: &TileWindow<'_>, (col, row): (usize, usize)) {
        let (cols, rows) = window.size();
        let laid = &mut self.laid[row * (cols + 2) + col];
        if *laid {
            return;
        }
        *laid = true;
        if (1..=cols).contains(&col) && (1..=rows).contains(&row) {
            let first = row * SAMPLES_PER_TILE_SIDE * self.stride + col * SAMPLES_PER_TILE_SIDE;
            let tile = window.tiles()[(row - 1) * cols + col - 1];
            for (k, line) in tile.coarse.chunks_exact(SAMPLES_PER_TILE_SIDE).enumerate() {
                self.field[first + k * self.stride..][..SAMPLES_PER_TILE_SIDE].copy_from_slice(line);
            }
            self.firsts.push(first);
        }
    }

    /// Copies a tile (margin included) and its right, upper and upper right neighbours: the tiles that shifts of a point can reach.
    #[cold]
    fn lay_out_block(&mut self, window: &TileWindow<'_>, (col, row): (usize, usize)) {
        let (cols, rows) = window.size();
        self.blocks[row * (cols + 2) + col] = true;
        for row in row..(row + 2).min(rows + 2) {
            for col in col..(col + 2).min(cols + 2) {
                self.lay_out(window, (col, row));
            }
        }
    }

    /// The sums of all shifts at a heading.
    fn sum_up(&mut self, window: &TileWindow<'_>, pose: Pose2, reach: usize) -> Sums {
        let mut sums = NO_SUMS;
        match reach {
            2 => self.sum_rows::<5>(window, pose, &mut sums),
            3 => self.sum_rows::<7>(window, pose, &mut sums),
            4 => self.sum_rows::<9>(window, pose, &mut sums),
            5 => self.sum_rows::<11>(window, pose, &mut sums),
            6 => self.sum_rows::<13>(window, pose, &mut sums),
            _ => self.sum_rows::<{ 2 * MAX_REACH_SAMPLES + 1 }>(window, pose, &mut sums),
        }
        sums
    }

    fn sum_rows<const ROWS: usize>(&mut self, window: &TileWindow<'_>, pose: Pose2, sums: &mut Sums) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.sum_rows_by_avx2::<ROWS>(window, pose, sums) };
        }
        self.sum_rows_plainly::<ROWS>(window, pose, sums);
    }

    /// The same sums in vectors of sixteen.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn sum_rows_by_avx2<const ROWS: usize>(&mut self, window: &TileWindow<'_>, pose: Pose2, sums: &mut Sums) {
        self.sum_rows_each::<ROWS>(window, pose, sums);
    }

    fn sum_rows_plainly<const ROWS: usize>(&mut self, window: &TileWindow<'_>, pose: Pose2, sums: &mut Sums) {
        self.sum_rows_each::<ROWS>(window, pose, sums);
    }

    /// `ROWS` is known at compile time, which keeps the sums in registers.
    #[inline(always)]
    fn sum_rows_each<const ROWS: usize>(&mut self, window: &TileWindow<'_>, pose: Pose2, all: &mut Sums) {
        let reach = (ROWS / 2) as i32;
        let (place, tile_cols) = (RotatedPose::new(pose), window.size().0 + 2);
        let (max_col, max_row) = (self.stride as i32 - LANES as i32, self.rows as i32 - ROWS as i32);
        // Samples are at the middles of even cells: 0.5, 2.5 and so on.
        let sample = |v: f32| floor((v + 0.5) * 0.5) + SAMPLES_PER_TILE_SIDE as i32 - reach;
        let mut sums = [[0_u16; LANES]; ROWS];
        for i in 0..self.points.len() {
            let (rx, ry) = place.rotate(self.points[i].0, self.points[i].1);
            let (col, row) = (sample(rx + place.x), sample(ry + place.y));
            if col < 0 || row < 0 || col > max_col || row > max_row {
                continue;
            }
            let (col, row) = (col as usize, row as usize);
            let block = (col / SAMPLES_PER_TILE_SIDE, row / SAMPLES_PER_TILE_SIDE);
            if !self.blocks[block.1 * tile_cols + block.0] {
                self.lay_out_block(window, block);
            }
            let first = row * self.stride + col;
            let field = &self.field[first..first + (ROWS - 1) * self.stride + LANES];
            for (j, sums) in sums.iter_mut().enumerate() {
                let values = field[j * self.stride..].first_chunk::<LANES>();
                let values = values.expect("invariant: a row of the field is longer");
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += u16::from(*value);
                }
            }
        }
        all[..ROWS].copy_from_slice(&sums);
    }
}

/// Penalty of a shift at a heading.
struct Turned<'a> {
    prior: &'a Matrix3<f64>,
    theta: f64,
}

/// The best score at a heading, and its shift, cells.
fn best_shift(sums: &Sums, reach: usize, gain: f64, turned: &Turned<'_>) -> (f64, f64, f64) {
    let Turned { prior, theta } = turned;
    let shift = |k: usize| (k as f64 - reach as f64) * SAMPLE_STEP_CELLS;
    let mut best = (f64::NEG_INFINITY, 0.0, 0.0);
    for (j, row) in sums.iter().enumerate().take(2 * reach + 1) {
        // The quadratic form as a function of x alone.
        let y = shift(j);
        let alone = 0.5 * (prior[(1, 1)] * y * y + prior[(2, 2)] * theta * theta) + prior[(1, 2)] * y * theta;
        let linear = prior[(0, 1)] * y + prior[(0, 2)] * theta;
        for (i, &sum) in row.iter().enumerate().take(2 * reach + 1) {
            let x = shift(i);
            let score = gain * f64::from(sum) - (alone + x * (linear + 0.5 * prior[(0, 0)] * x));
            if score > best.0 {
                best = (score, x, y);
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particle_config::ParticleConfig;
    use proptest::prelude::*;
    use trundle_core::{Beam, Scan, Stamp, Vector2};
    use trundle_grid::tiles::{NearestField, NearestObstacle, TileMap};

    proptest! {
        #[test]
        fn vectors_add_up_what_plain_code_does_and_nothing_within_the_margin_is_missed(
            ranges in prop::collection::vec(0.3..4.0_f64, 40..100), x in 70.0..90.0_f64, theta in -3.0..3.0_f64,
        ) {
            let config = ParticleConfig::default();
            let (mut map, model) = (TileMap::default(), NearestField::new(4, 2.0));
            for k in 0..160 {
                model.insert(&mut map, (k, 40 + k / 7), NearestObstacle::own(k % 7, -k % 5));
            }
            let beams = ranges.iter().map(|&range| Beam::Hit { range }).collect();
            let scan = Scan::new(Stamp::default(), Vector2::zeros(), -1.5, 0.03, beams).unwrap();
            let mut shape = ScanPoints::default();
            shape.set(&config, &scan);
            let window = TileWindow::new(&map, (0, 0), (191, 127));
            let guess = Pose2::new(x, 60.0, theta);
            let information = Matrix3::new(0.1, 0.02, 0.1, 0.02, 0.08, -0.1, 0.1, -0.1, 400.0);
            let prior = SearchPrior { information, sigma: 3.0, sigma_turn: 0.05, gain: 0.7 };
            let mut search = CoarseSearch::default();
            let few: Vec<_> = search.search(&window, &shape, guess, (&prior, 2.0)).to_vec();
            let all: Vec<_> = search.search(&window, &shape, guess, (&prior, f64::INFINITY)).to_vec();
            let near: Vec<_> = all.iter().filter(|(score, _)| *score > all[0].0 - 2.0).collect();
            prop_assert!(few.len() >= near.len() && few.iter().zip(near).all(|(a, b)| a == b));
            search.cover(&window);
            let (mut one, mut other) = (NO_SUMS, NO_SUMS);
            search.sum_rows::<11>(&window, guess, &mut one);
            search.sum_rows_plainly::<11>(&window, guess, &mut other);
            prop_assert!(one == other);
            // A scan that looks away from the wall meets nothing; too many of them fail the test.
            prop_assume!(one.as_flattened().iter().any(|sum| *sum > 0));
        }
    }
}
