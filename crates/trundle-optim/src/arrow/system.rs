//! The normal equations of a chain with a border.

use crate::block::{Block, Column};
use nalgebra::{SMatrix, SVector};

/// Normal equations `H x = g` of a chain of blocks of size N with a border of size B, and their solution.
///
/// ```
/// use nalgebra::{Matrix2, SMatrix, Vector2};
/// use trundle_optim::ArrowSystem;
///
/// // Two states of size 2 and one common parameter.
/// let mut system = ArrowSystem::<2, 1>::with_capacity(2);
/// system.reset(2);
/// for i in 0..2 {
///     system.add_diagonal(i, &(Matrix2::identity() * 4.0));
///     system.add_gradient(i, &Vector2::repeat(4.0));
/// }
/// system.add_border(&SMatrix::from_element(1.0), &SMatrix::from_element(3.0));
/// assert!(system.factorise());
/// system.solve();
/// assert_eq!((system.step(0), system.border_step()[0]), (Vector2::repeat(1.0), 3.0));
/// ```
#[derive(Debug, Clone)]
pub struct ArrowSystem<const N: usize, const B: usize> {
    pub(super) links: Vec<Link<N, B>>,
    /// Number of links in use.
    pub(super) count: usize,
    /// Coupling of the border with itself; its lower factor once factorised.
    pub(super) border: Block<B>,
    pub(super) border_rhs: Column<B>,
}

/// A block of the chain, with its coupling to the next one and to the border.
#[derive(Debug, Clone)]
pub(super) struct Link<const N: usize, const B: usize> {
    /// The diagonal block; its lower factor once factorised.
    pub(super) diagonal: Block<N>,
    /// Rows of the next block, columns of this one.
    pub(super) next: Block<N>,
    /// Rows of this block, columns of the border.
    pub(super) border: [Column<N>; B],
    /// Right side, then the step.
    pub(super) rhs: Column<N>,
}

impl<const N: usize, const B: usize> Link<N, B> {
    const ZERO: Self =
        Self { diagonal: [[0.0; N]; N], next: [[0.0; N]; N], border: [[0.0; N]; B], rhs: [0.0; N] };
}

impl<const N: usize, const B: usize> ArrowSystem<N, B> {
    /// A system that holds up to `blocks` blocks without allocating.
    #[must_use]
    pub fn with_capacity(blocks: usize) -> Self {
        Self { links: vec![Link::ZERO; blocks], count: 0, border: [[0.0; B]; B], border_rhs: [0.0; B] }
    }

    /// Zeros for `count` blocks.
    pub fn reset(&mut self, count: usize) {
        if count > self.links.len() {
            self.links.resize(count, Link::ZERO);
        }
        self.links[..count].fill(Link::ZERO);
        self.count = count;
        self.border = [[0.0; B]; B];
        self.border_rhs = [0.0; B];
    }

    /// Number of blocks.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Adds to the diagonal block `i`, which is below [`ArrowSystem::count`].
    pub fn add_diagonal(&mut self, i: usize, block: &SMatrix<f64, N, N>) {
        add(&mut self.links[i].diagonal, &block.data.0);
    }

    /// Adds the coupling of block `i` (rows) with block `i + 1` (columns).
    pub fn add_next(&mut self, i: usize, block: &SMatrix<f64, N, N>) {
        add(&mut self.links[i].next, &block.transpose().data.0);
    }

    /// Adds the coupling of block `i` (rows) with the border (columns).
    pub fn add_coupling(&mut self, i: usize, block: &SMatrix<f64, N, B>) {
        add(&mut self.links[i].border, &block.data.0);
    }

    /// Adds to the right side of block `i`.
    pub fn add_gradient(&mut self, i: usize, gradient: &SVector<f64, N>) {
        add(std::slice::from_mut(&mut self.links[i].rhs), &gradient.data.0);
    }

    /// Adds to the border and its right side.
    pub fn add_border(&mut self, block: &SMatrix<f64, B, B>, gradient: &SVector<f64, B>) {
        add(&mut self.border, &block.data.0);
        add(std::slice::from_mut(&mut self.border_rhs), &gradient.data.0);
    }

    /// Multiplies all diagonals by 1 + `factor`: the damping of Levenberg and Marquardt.
    pub fn damp(&mut self, factor: f64) {
        for link in &mut self.links[..self.count] {
            scale_diagonal(&mut link.diagonal, 1.0 + factor);
        }
        scale_diagonal(&mut self.border, 1.0 + factor);
    }

    /// The part of the solution that belongs to block `i`.
    pub fn step(&self, i: usize) -> SVector<f64, N> {
        self.links[i].rhs.into()
    }

    /// The part of the solution that belongs to the border.
    pub fn border_step(&self) -> SVector<f64, B> {
        self.border_rhs.into()
    }
}

fn add<const R: usize>(sum: &mut [Column<R>], block: &[Column<R>]) {
    for (sum, column) in sum.iter_mut().zip(block) {
        for (sum, value) in sum.iter_mut().zip(column) {
            *sum += value;
        }
    }
}

fn scale_diagonal<const R: usize>(block: &mut Block<R>, factor: f64) {
    for (k, column) in block.iter_mut().enumerate() {
        column[k] *= factor;
    }
}
