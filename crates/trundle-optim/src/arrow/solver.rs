//! Factor, solution, covariances and marginal of an arrow.

use super::covariance::{self, ArrowCovariance};
use super::factor;
use super::marginal::{self, ArrowMarginal};
use super::system::ArrowSystem;

impl<const N: usize, const B: usize> ArrowSystem<N, B> {
    /// Replaces the system by its Cholesky factor; `false` if the system is not positive definite.
    pub fn factorise(&mut self) -> bool {
        factor::factorise(self)
    }

    /// Solves by the factor: [`ArrowSystem::step`] and [`ArrowSystem::border_step`] then hold the solution.
    pub fn solve(&mut self) {
        factor::solve(self);
    }

    /// Joint covariance of block `k` and the border. The system must be factorised, and `k` below [`ArrowSystem::count`].
    pub fn covariance(&self, k: usize) -> ArrowCovariance<N, B> {
        covariance::of_block(self, k)
    }

    /// Removes the first of two blocks and returns the information on the second one and the border; `None` if the first block is not
    /// positive definite, or the system does not have two blocks. The call destroys the system.
    pub fn marginalise_first(&mut self) -> Option<ArrowMarginal<N, B>> {
        marginal::of_first(self)
    }
}
