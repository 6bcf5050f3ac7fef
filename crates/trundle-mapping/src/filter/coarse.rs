use super::{
    ScanShape,
    likelihood::{Placed, floor},
};
use crate::tiles::{TILE_SIDE, TileWindow};
use nalgebra::{Matrix3, Vector3};
use trundle_core::Pose2;

/// Half a tile: samples of the coarse field are two cells apart.
const HALF: usize = TILE_SIDE / 2;
/// Cells between samples.
const STEP: f64 = 2.0;
/// Widest search, samples to each side.
const MOST_REACH: usize = 7;
const LANES: usize = 16;
/// Points that the coarse search looks at, at most.
const MOST_POINTS: usize = 80;

/// The correlative search: all poses of a lattice about a guess, on the coarse field (\[Olson09\]).
#[derive(Debug, Clone, Default)]
pub(crate) struct CoarseSearch {
    field: Vec<u8>,
    stride: usize,
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

/// Sums of likelihoods: row by row, 16 columns each.
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
        self.lay_out(window);
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
            self.sum_up(shape, every, pose, reach, &mut sums);
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

    /// The coarse field of the window in one piece, row by row, with a margin in which nothing is.
    fn lay_out(&mut self, window: &TileWindow<'_>) {
        let (cols, rows) = window.size();
        self.stride = cols * HALF + 2 * LANES;
        self.field.clear();
        self.field.resize(self.stride * (rows * HALF + 2 * LANES), 0);
        for (i, tile) in window.tiles().iter().enumerate() {
            let (col, row) = (i % cols, i / cols);
            let first = (row * HALF + LANES) * self.stride + col * HALF + LANES;
            for (k, line) in tile.coarse.chunks_exact(HALF).enumerate() {
                let at = first + k * self.stride;
                self.field[at..at + HALF].copy_from_slice(line);
            }
        }
    }

    fn sum_up(&self, shape: &ScanShape, every: usize, pose: Pose2, reach: usize, sums: &mut Sums) {
        let place = Placed::new(pose);
        for point in shape.points.iter().step_by(every) {
            let (rx, ry) = place.rotate(point.x, point.y);
            // Samples are at the middles of even cells: 0.5, 2.5 and so on.
            let sample = |v: f32| i64::from(floor((v + 0.5) * 0.5)) + LANES as i64 - reach as i64;
            let (col, row) = (sample(rx + place.x), sample(ry + place.y));
            let rows = (self.field.len() / self.stride) as i64;
            let inside = col >= 0
                && row >= 0
                && col + LANES as i64 <= self.stride as i64
                && row + (2 * reach as i64) < rows;
            if inside {
                let first = row as usize * self.stride + col as usize;
                for (j, sums) in sums.iter_mut().enumerate().take(2 * reach + 1) {
                    let at = first + j * self.stride;
                    add(sums, &self.field[at..at + LANES]);
                }
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
