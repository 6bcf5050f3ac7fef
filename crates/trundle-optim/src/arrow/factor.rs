//! Cholesky factor of the arrow, and the solution by it.

use super::system::{ArrowSystem, Link};
use crate::block::{
    divide_by_transposed, factorise, solve_lower, solve_upper, subtract_outer, subtract_product,
    subtract_transposed_product,
};

impl<const N: usize, const B: usize> ArrowSystem<N, B> {
    /// Turns the system into its Cholesky factor; `false` when it is not positive definite.
    pub fn factorise(&mut self) -> bool {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx") {
            // SAFETY: the processor has the one feature that the function is compiled for.
            return unsafe { self.factorise_by_avx() };
        }
        self.factorise_plainly()
    }

    /// The same as [`ArrowSystem::factorise_plainly`] with four numbers to an operation.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx")]
    fn factorise_by_avx(&mut self) -> bool {
        self.factorise_plainly()
    }

    #[inline(always)]
    fn factorise_plainly(&mut self) -> bool {
        for i in 0..self.count {
            let (done, rest) = self.links.split_at_mut(i + 1);
            let link = &mut done[i];
            if !eliminate(link) {
                return false;
            }
            if i + 1 < self.count {
                carry(link, &mut rest[0]);
            }
            subtract_gram(&mut self.border, &link.border);
        }
        factorise(&mut self.border)
    }

    /// Solves by the factor: [`ArrowSystem::step`] and [`ArrowSystem::border_step`] then hold the solution.
    pub fn solve(&mut self) {
        for i in 0..self.count {
            let (done, rest) = self.links.split_at_mut(i + 1);
            let link = &mut done[i];
            solve_lower(&link.diagonal, &mut link.rhs);
            if i + 1 < self.count {
                subtract_product(&mut rest[0].rhs, &link.next, &link.rhs);
            }
            for (sum, column) in self.border_rhs.iter_mut().zip(&link.border) {
                *sum -= dot(column, &link.rhs);
            }
        }
        solve_lower(&self.border, &mut self.border_rhs);
        solve_upper(&self.border, &mut self.border_rhs);
        for i in (0..self.count).rev() {
            let (done, rest) = self.links.split_at_mut(i + 1);
            let link = &mut done[i];
            if i + 1 < self.count {
                subtract_transposed_product(&mut link.rhs, &link.next, &rest[0].rhs);
            }
            for (factor, column) in self.border_rhs.iter().zip(&link.border) {
                for (sum, value) in link.rhs.iter_mut().zip(column) {
                    *sum -= value * factor;
                }
            }
            solve_upper(&link.diagonal, &mut link.rhs);
        }
    }
}

/// Factorises the diagonal of a link and divides its couplings by the factor.
#[inline(always)]
fn eliminate<const N: usize, const B: usize>(link: &mut Link<N, B>) -> bool {
    if !factorise(&mut link.diagonal) {
        return false;
    }
    divide_by_transposed(&mut link.next, &link.diagonal);
    for column in &mut link.border {
        solve_lower(&link.diagonal, column);
    }
    true
}

/// Subtracts what an eliminated link explains of the next one.
#[inline(always)]
fn carry<const N: usize, const B: usize>(link: &Link<N, B>, next: &mut Link<N, B>) {
    subtract_outer(&mut next.diagonal, &link.next, &link.next);
    for (sum, column) in next.border.iter_mut().zip(&link.border) {
        subtract_product(sum, &link.next, column);
    }
}

/// `border -= columns' columns`, the lower half.
#[inline(always)]
fn subtract_gram<const N: usize, const B: usize>(border: &mut [[f64; B]; B], columns: &[[f64; N]; B]) {
    for (j, stored) in border.iter_mut().enumerate() {
        for (i, sum) in stored.iter_mut().enumerate().skip(j) {
            *sum -= dot(&columns[i], &columns[j]);
        }
    }
}

#[inline(always)]
fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
