//! The first block of an arrow removed: a Schur complement.

use super::system::{ArrowSystem, Link};
use crate::block::{divide_by_transposed, factorise, solve_lower, subtract_outer, subtract_product};
use nalgebra::{SMatrix, SVector};

/// What a removed block says of the next one and the border: information and right side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArrowMarginal<const N: usize, const B: usize> {
    /// Information of the next block.
    pub block: SMatrix<f64, N, N>,
    /// Of the next block (rows) with the border (columns).
    pub coupling: SMatrix<f64, N, B>,
    /// Of the border.
    pub border: SMatrix<f64, B, B>,
    /// Right side of the next block.
    pub gradient: SVector<f64, N>,
    /// Right side of the border.
    pub border_gradient: SVector<f64, B>,
}

impl<const N: usize, const B: usize> ArrowSystem<N, B> {
    /// Removes the first of two blocks and returns what is known of the second one and the border; `None` where the first block is not
    /// positive definite, or there are not two blocks. The system is used up.
    pub fn marginalise_first(&mut self) -> Option<ArrowMarginal<N, B>> {
        let [first, second] = &mut self.links[..self.count] else { return None };
        if !factorise(&mut first.diagonal) {
            return None;
        }
        divide_by_transposed(&mut first.next, &first.diagonal);
        first.border.iter_mut().for_each(|column| solve_lower(&first.diagonal, column));
        solve_lower(&first.diagonal, &mut first.rhs);
        carry(first, second);
        for j in 0..B {
            for i in 0..B {
                self.border[j][i] -=
                    first.border[i].iter().zip(&first.border[j]).map(|(a, b)| a * b).sum::<f64>();
            }
            let explained: f64 = first.border[j].iter().zip(&first.rhs).map(|(a, b)| a * b).sum();
            self.border_rhs[j] -= explained;
        }
        Some(ArrowMarginal {
            block: SMatrix::from_fn(|row, column| second.diagonal[column][row]),
            coupling: SMatrix::from_fn(|row, column| second.border[column][row]),
            border: SMatrix::from_fn(|row, column| self.border[column][row]),
            gradient: second.rhs.into(),
            border_gradient: self.border_rhs.into(),
        })
    }
}

fn carry<const N: usize, const B: usize>(first: &Link<N, B>, second: &mut Link<N, B>) {
    subtract_outer(&mut second.diagonal, &first.next, &first.next);
    for (sum, column) in second.border.iter_mut().zip(&first.border) {
        subtract_product(sum, &first.next, column);
    }
    subtract_product(&mut second.rhs, &first.next, &first.rhs);
}
