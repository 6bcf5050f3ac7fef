//! Marginal covariances of a factorised arrow.

use super::system::ArrowSystem;
use crate::block::{Block, Column, solve_lower, solve_upper};
use nalgebra::{ArrayStorage, SMatrix};

/// Joint covariance of a block and the border.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArrowCovariance<const N: usize, const B: usize> {
    /// Covariance of the block.
    pub block: SMatrix<f64, N, N>,
    /// Covariance of the block (rows) with the border (columns).
    pub cross: SMatrix<f64, N, B>,
    /// Covariance of the border.
    pub border: SMatrix<f64, B, B>,
}

/// Joint covariance of block `k` of a factorised system and the border, by a recursion from the newest block to `k` \[Takahashi73\].
pub(super) fn of_block<const N: usize, const B: usize>(
    system: &ArrowSystem<N, B>,
    k: usize,
) -> ArrowCovariance<N, B> {
    let mut found = newest(system, of_border(system));
    for i in (k..system.count - 1).rev() {
        found = before(system, i, &found);
    }
    found
}

/// The inverse of the border's Schur complement.
fn of_border<const N: usize, const B: usize>(system: &ArrowSystem<N, B>) -> SMatrix<f64, B, B> {
    let mut inverse = SMatrix::<f64, B, B>::identity();
    for column in &mut inverse.data.0 {
        solve_lower(&system.border, column);
        solve_upper(&system.border, column);
    }
    inverse
}

fn newest<const N: usize, const B: usize>(
    system: &ArrowSystem<N, B>,
    border: SMatrix<f64, B, B>,
) -> ArrowCovariance<N, B> {
    let link = &system.links[system.count - 1];
    let coupling: SMatrix<f64, N, B> = matrix(&link.border);
    let through = coupling * border;
    let inner = SMatrix::<f64, N, N>::identity() + through * coupling.transpose();
    finish(&link.diagonal, inner, through, border)
}

/// The covariance of block `i`, computed from that of block `i + 1`.
fn before<const N: usize, const B: usize>(
    system: &ArrowSystem<N, B>,
    i: usize,
    later: &ArrowCovariance<N, B>,
) -> ArrowCovariance<N, B> {
    let link = &system.links[i];
    let coupling: SMatrix<f64, N, B> = matrix(&link.border);
    let next: SMatrix<f64, N, N> = matrix(&link.next);
    let through_next = next.transpose() * later.block + coupling * later.cross.transpose();
    let through = next.transpose() * later.cross + coupling * later.border;
    let inner = SMatrix::<f64, N, N>::identity() + through_next * next + through * coupling.transpose();
    finish(&link.diagonal, inner, through, later.border)
}

/// The covariance `L'^-1 inner L^-1` of a block, and `-L'^-1 through` with the border.
fn finish<const N: usize, const B: usize>(
    lower: &Block<N>,
    inner: SMatrix<f64, N, N>,
    through: SMatrix<f64, N, B>,
    border: SMatrix<f64, B, B>,
) -> ArrowCovariance<N, B> {
    let half = solved_upper(lower, inner);
    let block = solved_upper(lower, half.transpose());
    let block = (block + block.transpose()) * 0.5;
    ArrowCovariance { block, cross: -solved_upper(lower, through), border }
}

/// `L'^-1 matrix`.
fn solved_upper<const N: usize, const C: usize>(
    lower: &Block<N>,
    mut matrix: SMatrix<f64, N, C>,
) -> SMatrix<f64, N, C> {
    matrix.data.0.iter_mut().for_each(|column| solve_upper(lower, column));
    matrix
}

fn matrix<const R: usize, const C: usize>(columns: &[Column<R>; C]) -> SMatrix<f64, R, C> {
    SMatrix::from_data(ArrayStorage(*columns))
}
