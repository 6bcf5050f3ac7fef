//! The first block of an arrow removed: a Schur complement.

use super::factor::{carry, dot, eliminate, subtract_gram};
use super::system::ArrowSystem;
use crate::block::{solve_lower, subtract_product};
use nalgebra::{ArrayStorage, SMatrix, SVector};

/// Marginal of a removed block on the next one and the border: information and right side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArrowMarginal<const N: usize, const B: usize> {
    /// Information of the next block.
    pub block: SMatrix<f64, N, N>,
    /// Coupling of the next block (rows) with the border (columns).
    pub coupling: SMatrix<f64, N, B>,
    /// Information of the border.
    pub border: SMatrix<f64, B, B>,
    /// Right side of the next block.
    pub gradient: SVector<f64, N>,
    /// Right side of the border.
    pub border_gradient: SVector<f64, B>,
}

/// Removes the first of two blocks.
pub(super) fn of_first<const N: usize, const B: usize>(
    system: &mut ArrowSystem<N, B>,
) -> Option<ArrowMarginal<N, B>> {
    let ArrowSystem { links, count, border, border_rhs } = system;
    let [first, second] = &mut links[..*count] else { return None };
    if !eliminate(first) {
        return None;
    }
    solve_lower(&first.diagonal, &mut first.rhs);
    carry(first, second);
    subtract_product(&mut second.rhs, &first.next, &first.rhs);
    subtract_gram(border, &first.border);
    for (sum, column) in border_rhs.iter_mut().zip(&first.border) {
        *sum -= dot(column, &first.rhs);
    }
    Some(ArrowMarginal {
        block: SMatrix::from_data(ArrayStorage(second.diagonal)),
        coupling: SMatrix::from_data(ArrayStorage(second.border)),
        // The upper half was not touched.
        border: SMatrix::from_fn(|row, column| border[row.min(column)][row.max(column)]),
        gradient: second.rhs.into(),
        border_gradient: (*border_rhs).into(),
    })
}
