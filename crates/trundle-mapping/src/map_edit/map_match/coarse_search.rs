//! The best poses of a coarse lattice over the whole pose space.

use super::coarse_field::{CoarseField, CoarsePoints};
use super::map_shape::MapShape;
use rayon::prelude::*;
use std::f64::consts::TAU;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// Side of a coarse cell, and of the steps of the lattice \[m\]. Source: ours.
const COARSE_CELL_M: f64 = 0.2;
/// Maximum number of additions of a search: larger maps get larger cells. Source: ours, 5 to 10 s on a core.
const MAX_ADDITIONS: f64 = 5e10;
/// Maximum number of candidates of a turn. Source: ours.
const MAX_CANDIDATES_PER_TURN: usize = 20;
/// Maximum number of candidates. Source: ours.
const MAX_CANDIDATES: usize = 80;
/// Distance \[coarse cells\] and turn \[rad\] within which a candidate replaces worse ones. Source: ours.
const CANDIDATE_REACH_CELLS: f64 = 2.5;
const CANDIDATE_REACH_RAD: f64 = 0.09;

/// A pose of the lattice: turn by its index, the cell of the second map's middle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Candidate {
    score: i32,
    turn: usize,
    row: usize,
    col: usize,
}

/// The best poses (first from second) of the lattice, best first, that differ from each other.
pub(super) fn candidates(first: &MapShape, second: &MapShape) -> Vec<Pose2> {
    let cell = cell_side(first, second);
    let points = CoarsePoints::of(second, cell);
    // The middle of the second map lies within its radius of the first map.
    let reach = (second.radius / cell).ceil() as usize + 1;
    let field = CoarseField::of(first, cell, 2 * reach, points.free_weight);
    let turns = turn_count(second, cell);
    let angle = |turn: usize| TAU * turn as f64 / turns as f64;
    let mut all: Vec<Candidate> = (0..turns)
        .into_par_iter()
        .flat_map_iter(|turn| best_of_turn(&field, &points, reach, (turn, angle(turn))))
        .collect();
    all.sort_by(|a, b| b.score.cmp(&a.score).then((a.turn, a.row, a.col).cmp(&(b.turn, b.row, b.col))));
    let mut chosen: Vec<Candidate> = Vec::new();
    for next in all {
        if chosen.len() == MAX_CANDIDATES {
            break;
        }
        let is_near = |other: &Candidate| {
            let (rows, cols) = (next.row.abs_diff(other.row) as f64, next.col.abs_diff(other.col) as f64);
            rows.max(cols) <= CANDIDATE_REACH_CELLS
                && wrap_angle(angle(next.turn) - angle(other.turn)).abs() <= CANDIDATE_REACH_RAD
        };
        if !chosen.iter().any(is_near) {
            chosen.push(next);
        }
    }
    chosen.iter().map(|found| pose(&field, second, found, angle(found.turn))).collect()
}

/// Number of turns of the lattice: neighbours move no wall by more than a cell.
fn turn_count(second: &MapShape, cell: f64) -> usize {
    (TAU * second.radius / cell).ceil().max(8.0) as usize
}

/// The smallest cell whose search has a tolerable cost.
fn cell_side(first: &MapShape, second: &MapShape) -> f64 {
    let smallest = COARSE_CELL_M.max(first.resolution()).max(second.resolution());
    let (_, size) = first.extent();
    let side = |length: f64| (length + 2.0 * second.radius) / smallest;
    let points = (CoarsePoints::of(second, smallest).walls.len() + 200) as f64;
    let additions = side(size.x) * side(size.y) * turn_count(second, smallest) as f64 * points;
    // Positions and turns: the third power of the cell.
    smallest * (additions / MAX_ADDITIONS).max(1.0).cbrt()
}

/// The best local maxima of one turn.
fn best_of_turn(
    field: &CoarseField,
    points: &CoarsePoints,
    reach: usize,
    (turn, angle): (usize, f64),
) -> Vec<Candidate> {
    let rotation = Pose2::new(0.0, 0.0, angle);
    let offset = |p: &Vector2| {
        let at = (rotation.rotate(*p) / field.cell).map(f64::round);
        (at.x as isize, at.y as isize)
    };
    let walls: Vec<_> = points.walls.iter().map(offset).collect();
    let free: Vec<_> = points.free.iter().map(offset).collect();
    let (rows, cols) = (field.height - 2 * reach, field.width - 2 * reach);
    let mut scores = vec![0_i16; rows * cols];
    for (row, line) in scores.chunks_exact_mut(cols).enumerate() {
        let parts = [(&walls, &field.walls), (&free, &field.free)];
        for (offsets, values) in parts {
            for (x, y) in offsets {
                let from = (row + reach).wrapping_add_signed(*y) * field.width;
                let from = (from + reach).wrapping_add_signed(*x);
                add(line, &values[from..from + cols]);
            }
        }
    }
    let mut found = local_maxima(&scores, cols, turn);
    found.sort_by(|a, b| b.score.cmp(&a.score).then((a.row, a.col).cmp(&(b.row, b.col))));
    found.truncate(MAX_CANDIDATES_PER_TURN);
    for candidate in &mut found {
        (candidate.row, candidate.col) = (candidate.row + reach, candidate.col + reach);
    }
    found
}

fn add(line: &mut [i16], values: &[i16]) {
    line.iter_mut().zip(values).for_each(|(sum, value)| *sum = sum.saturating_add(*value));
}

/// The positive scores that none of the eight neighbours exceeds.
fn local_maxima(scores: &[i16], cols: usize, turn: usize) -> Vec<Candidate> {
    let rows = scores.len() / cols;
    let mut found = Vec::new();
    for row in 1..rows.saturating_sub(1) {
        for col in 1..cols - 1 {
            let at = row * cols + col;
            let score = scores[at];
            let near = [
                at - cols - 1,
                at - cols,
                at - cols + 1,
                at - 1,
                at + 1,
                at + cols - 1,
                at + cols,
                at + cols + 1,
            ];
            if score > 0 && near.iter().all(|near| scores[*near] <= score) {
                found.push(Candidate { score: i32::from(score), turn, row, col });
            }
        }
    }
    found
}

fn pose(field: &CoarseField, second: &MapShape, found: &Candidate, angle: f64) -> Pose2 {
    let middle = field.corner + Vector2::new(found.col as f64 + 0.5, found.row as f64 + 0.5) * field.cell;
    Pose2::new(middle.x, middle.y, angle) * Pose2::new(-second.middle.x, -second.middle.y, 0.0)
}
