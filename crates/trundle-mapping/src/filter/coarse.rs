use super::{
    ScanShape,
    likelihood::{Placed, floor},
};
use crate::tiles::{COARSE_SIDE as HALF, TileWindow};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// Cells between samples.
const STEP: f64 = 2.0;
/// Widest search, samples to each side.
const MOST_REACH: usize = 7;
const LANES: usize = 16;
const _: () = assert!(HALF == LANES && 2 * MOST_REACH < LANES);
/// Points that the coarse search looks at, at most.
const MOST_POINTS: usize = 80;

/// The correlative search: all poses of a lattice about a guess, on the coarse field (\[Olson09\]).
#[derive(Debug, Clone, Default)]
pub(crate) struct CoarseSearch {
    /// The coarse field in one piece, row by row, a tile's margin about it. Zero but for the tiles laid out.
    field: Vec<u8>,
    stride: usize,
    rows: usize,
    /// Which tiles (margin counted) are laid out, and where they begin.
    laid: Vec<bool>,
    firsts: Vec<usize>,
    best: Vec<(f64, Pose2)>,
}

/// Where to search, and what speaks against going far.
pub(crate) struct SearchPrior {
    /// Inverse covariance of the guess: cells, rad.
    pub(crate) information: Matrix3<f64>,
    /// One sigma of the guess, cells.
    pub(crate) sigma: f64,
    /// One sigma of its heading, rad.
    pub(crate) sigma_turn: f64,
    /// What a point that fits is worth against one that does not, nats.
    pub(crate) gain: f64,
}

/// Sums of likelihoods: row by row, 16 columns each, of which those beyond the reach say nothing.
type Sums = [[u16; LANES]; 2 * MOST_REACH + 1];

impl CoarseSearch {
    /// The best poses, at most one for each heading, the best first. `guess` in cells of the window.
    pub(crate) fn search(
        &mut self,
        window: &TileWindow<'_>,
        shape: &ScanShape,
        guess: Pose2,
        prior: &SearchPrior,
    ) -> &[(f64, Pose2)] {
        self.cover(window);
        self.best.clear();
        let reach = ((3.0 * prior.sigma / STEP).ceil() as usize).clamp(2, MOST_REACH);
        let turn_step = (STEP / shape.lever).clamp(0.004, 0.05);
        let turns = ((3.0 * prior.sigma_turn / turn_step).ceil() as i32)
            .clamp(1, (std::f64::consts::PI / turn_step) as i32);
        let every = shape.points.len().div_ceil(MOST_POINTS).max(1);
        let gain = prior.gain * every as f64 / 255.0;
        for turn in -turns..=turns {
            let theta = f64::from(turn) * turn_step;
            let pose = Pose2 { theta: guess.theta + theta, ..guess };
            let mut sums: Sums = [[0; LANES]; 2 * MOST_REACH + 1];
            self.sum_up(window, (shape, every), pose, reach, &mut sums);
            let mut best = (f64::NEG_INFINITY, pose);
            for (j, row) in sums.iter().enumerate().take(2 * reach + 1) {
                for (i, &sum) in row.iter().enumerate().take(2 * reach + 1) {
                    let shift = |k: usize| (k as f64 - reach as f64) * STEP;
                    let off = Vector3::new(shift(i), shift(j), theta);
                    let score = gain * f64::from(sum) - 0.5 * off.dot(&(prior.information * off));
                    if score > best.0 {
                        best = (score, Pose2 { x: guess.x + off.x, y: guess.y + off.y, ..pose });
                    }
                }
            }
            self.best.push(best);
        }
        self.best.sort_by(|a, b| b.0.total_cmp(&a.0));
        &self.best
    }

    /// Begins anew for a window: nothing is laid out.
    fn cover(&mut self, window: &TileWindow<'_>) {
        for first in self.firsts.drain(..) {
            for k in 0..HALF {
                self.field[first + k * self.stride..][..HALF].fill(0);
            }
        }
        let (cols, rows) = window.size();
        (self.stride, self.rows) = ((cols + 2) * HALF, (rows + 2) * HALF);
        if self.field.len() < self.stride * self.rows {
            self.field.resize(self.stride * self.rows, 0);
        }
        self.laid.clear();
        self.laid.resize((cols + 2) * (rows + 2), false);
    }

    /// Copies a tile (margin counted) to its place, if it is one of the window and was not copied before.
    fn lay_out(&mut self, window: &TileWindow<'_>, (col, row): (usize, usize)) {
        let (cols, rows) = window.size();
        let laid = &mut self.laid[row * (cols + 2) + col];
        if *laid {
            return;
        }
        *laid = true;
        if (1..=cols).contains(&col) && (1..=rows).contains(&row) {
            let first = row * HALF * self.stride + col * HALF;
            let tile = window.tiles()[(row - 1) * cols + col - 1];
            for (k, line) in tile.coarse.chunks_exact(HALF).enumerate() {
                self.field[first + k * self.stride..][..HALF].copy_from_slice(line);
            }
            self.firsts.push(first);
        }
    }

    fn sum_up(
        &mut self,
        window: &TileWindow<'_>,
        (shape, every): (&ScanShape, usize),
        pose: Pose2,
        reach: usize,
        sums: &mut Sums,
    ) {
        let place = Placed::new(pose);
        for point in shape.points.iter().step_by(every) {
            let (rx, ry) = place.rotate(point.x, point.y);
            // Samples are at the middles of even cells: 0.5, 2.5 and so on.
            let sample = |v: f32| i64::from(floor((v + 0.5) * 0.5)) + HALF as i64 - reach as i64;
            let (col, row) = (sample(rx + place.x), sample(ry + place.y));
            let inside = col >= 0
                && row >= 0
                && col + LANES as i64 <= self.stride as i64
                && row + (2 * reach as i64) < self.rows as i64;
            if !inside {
                continue;
            }
            let (col, row) = (col as usize, row as usize);
            for tile_row in row / HALF..=(row + 2 * reach) / HALF {
                for tile_col in col / HALF..=(col + 2 * reach) / HALF {
                    self.lay_out(window, (tile_col, tile_row));
                }
            }
            let first = row * self.stride + col;
            for (j, sums) in sums.iter_mut().enumerate().take(2 * reach + 1) {
                let at = first + j * self.stride;
                add(sums, &self.field[at..at + LANES]);
            }
        }
    }
}

/// Adds 16 likelihoods to their sums.
#[inline]
fn add(sums: &mut [u16; LANES], values: &[u8]) {
    for (sum, &value) in sums.iter_mut().zip(values) {
        *sum += u16::from(value);
    }
}
