//! Cholesky factor of the arrow, and the solution of its equations.

use super::system::{ArrowSystem, Link};
use crate::block::{
    self, Column, divide_by_transposed, solve_lower, solve_upper, subtract_outer, subtract_product,
    subtract_transposed_product,
};

/// Turns a system into its Cholesky factor. Returns whether the system is positive definite.
pub(super) fn factorise<const N: usize, const B: usize>(system: &mut ArrowSystem<N, B>) -> bool {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx") {
        // SAFETY: the processor has the only feature that the function is compiled for.
        return unsafe { factorise_by_avx(system) };
    }
    factorise_plainly(system)
}

/// The same as [`factorise_plainly`] with four numbers to an operation.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx")]
fn factorise_by_avx<const N: usize, const B: usize>(system: &mut ArrowSystem<N, B>) -> bool {
    factorise_plainly(system)
}

#[inline(always)]
fn factorise_plainly<const N: usize, const B: usize>(system: &mut ArrowSystem<N, B>) -> bool {
    let ArrowSystem { links, count, border, .. } = system;
    for i in 0..*count {
        let (done, rest) = links[..*count].split_at_mut(i + 1);
        let link = &mut done[i];
        if !eliminate(link) {
            return false;
        }
        if let Some(next) = rest.first_mut() {
            carry(link, next);
        }
        subtract_gram(border, &link.border);
    }
    block::factorise(border)
}

/// Solves a factorised system: right sides become solutions.
pub(super) fn solve<const N: usize, const B: usize>(system: &mut ArrowSystem<N, B>) {
    let ArrowSystem { links, count, border, border_rhs } = system;
    let links = &mut links[..*count];
    forward(links, border_rhs);
    solve_lower(border, border_rhs);
    solve_upper(border, border_rhs);
    backward(links, border_rhs);
}

fn forward<const N: usize, const B: usize>(links: &mut [Link<N, B>], border_rhs: &mut Column<B>) {
    for i in 0..links.len() {
        let (done, rest) = links.split_at_mut(i + 1);
        let link = &mut done[i];
        solve_lower(&link.diagonal, &mut link.rhs);
        if let Some(next) = rest.first_mut() {
            subtract_product(&mut next.rhs, &link.next, &link.rhs);
        }
        for (sum, column) in border_rhs.iter_mut().zip(&link.border) {
            *sum -= dot(column, &link.rhs);
        }
    }
}

fn backward<const N: usize, const B: usize>(links: &mut [Link<N, B>], border: &Column<B>) {
    for i in (0..links.len()).rev() {
        let (done, rest) = links.split_at_mut(i + 1);
        let link = &mut done[i];
        if let Some(next) = rest.first() {
            subtract_transposed_product(&mut link.rhs, &link.next, &next.rhs);
        }
        for (factor, column) in border.iter().zip(&link.border) {
            for (sum, value) in link.rhs.iter_mut().zip(column) {
                *sum -= value * factor;
            }
        }
        solve_upper(&link.diagonal, &mut link.rhs);
    }
}

/// Factorises the diagonal of a link and divides its couplings by the factor.
#[inline(always)]
pub(super) fn eliminate<const N: usize, const B: usize>(link: &mut Link<N, B>) -> bool {
    if !block::factorise(&mut link.diagonal) {
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
pub(super) fn carry<const N: usize, const B: usize>(link: &Link<N, B>, next: &mut Link<N, B>) {
    subtract_outer(&mut next.diagonal, &link.next, &link.next);
    for (sum, column) in next.border.iter_mut().zip(&link.border) {
        subtract_product(sum, &link.next, column);
    }
}

/// `border -= columns' columns`, the lower half.
#[inline(always)]
pub(super) fn subtract_gram<const N: usize, const B: usize>(
    border: &mut [[f64; B]; B],
    columns: &[[f64; N]; B],
) {
    for (j, stored) in border.iter_mut().enumerate() {
        for (i, sum) in stored.iter_mut().enumerate().skip(j) {
            *sum -= dot(&columns[i], &columns[j]);
        }
    }
}

#[inline(always)]
pub(super) fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
