//! Cholesky factor of a sparse symmetric matrix of square blocks.

use crate::block::{
    Block, Column, divide_by_transposed, factorise, solve_lower, solve_upper, subtract_outer,
    subtract_product, subtract_transposed_product,
};
use crate::narrow_order::narrow_order;
use nalgebra::{ArrayStorage, SMatrix, SVector};

/// Symmetric positive definite matrix of N x N blocks in profile storage, and its Cholesky factor in place.
///
/// Block rows contain the lower half from their first non-zero block on. A factor has the same profile. Rows are ordered by reverse
/// Cuthill-McKee. The profile of a chain with few loops is a few blocks wide: O(n) work and memory.
///
/// ```
/// use nalgebra::{Matrix3, Vector3};
/// use trundle_optim::BlockMatrix;
///
/// let mut matrix = BlockMatrix::<3>::new(2, &[(0, 1)]);
/// matrix.add(0, 0, &(Matrix3::identity() * 2.0));
/// matrix.add(1, 1, &Matrix3::identity());
/// matrix.add(0, 1, &Matrix3::identity());
/// let mut solution = vec![Vector3::repeat(3.0), Vector3::repeat(2.0)];
/// assert!(matrix.factorise() && matrix.solve(&mut solution));
/// assert!((solution[0] - Vector3::repeat(1.0)).norm() < 1e-12);
/// assert!((solution[1] - Vector3::repeat(1.0)).norm() < 1e-12);
/// ```
#[derive(Debug, Clone, Default)]
pub struct BlockMatrix<const N: usize = 6> {
    /// Place of node i among the rows.
    row_of: Vec<usize>,
    /// First block column of each row.
    first: Vec<usize>,
    /// Index of each row's first block.
    start: Vec<usize>,
    blocks: Vec<Block<N>>,
    /// The unknowns while solving, by row.
    unknowns: Vec<Column<N>>,
    /// The inverse within the profile, as far as computed.
    inverse: Vec<Block<N>>,
    /// The column of the inverse in computation.
    column: InverseColumn<N>,
}

/// A column of the inverse during its computation.
#[derive(Debug, Clone)]
struct InverseColumn<const N: usize> {
    /// Number of remaining columns, including this one.
    left: usize,
    /// The rows below the diagonal in the profile.
    below: Vec<usize>,
    /// Blocks of the factor in these rows, divided by the diagonal block.
    factors: Vec<Block<N>>,
    /// Number of finished rows.
    done: usize,
    /// The diagonal block, accumulated from the finished blocks.
    diagonal: Block<N>,
}

impl<const N: usize> Default for InverseColumn<N> {
    fn default() -> Self {
        Self { left: 0, below: Vec::new(), factors: Vec::new(), done: 0, diagonal: [[0.0; N]; N] }
    }
}

impl<const N: usize> BlockMatrix<N> {
    const ZERO: Block<N> = [[0.0; N]; N];

    /// Zeros for `count` nodes that are coupled by `pairs`.
    pub fn new(count: usize, pairs: &[(usize, usize)]) -> Self {
        let mut matrix = Self::default();
        matrix.shape(count, pairs);
        matrix
    }

    /// Zeros as by [`BlockMatrix::new`]; `None` if the factor would hold more than `max_blocks` blocks, as with many parallel passes.
    #[must_use]
    pub fn new_within(count: usize, pairs: &[(usize, usize)], max_blocks: usize) -> Option<Self> {
        let mut matrix = Self::default();
        matrix.arrange(count, pairs);
        let blocks: usize = matrix.first.iter().enumerate().map(|(row, first)| row - first + 1).sum();
        (blocks <= max_blocks).then(|| {
            matrix.allot();
            matrix
        })
    }

    /// Shapes this matrix in place for `count` nodes and the linked `pairs`.
    pub(crate) fn shape(&mut self, count: usize, pairs: &[(usize, usize)]) {
        self.arrange(count, pairs);
        self.allot();
    }

    /// Orders the rows, and finds the first column of each.
    fn arrange(&mut self, count: usize, pairs: &[(usize, usize)]) {
        self.row_of = narrow_order(count, pairs);
        self.first.clear();
        self.first.extend(0..count);
        for &(a, b) in pairs {
            let (low, high) = ordered(self.row_of[a], self.row_of[b]);
            self.first[high] = self.first[high].min(low);
        }
    }

    /// Zeros for `count` nodes each of which may be coupled with each, in place and in their own order.
    pub(crate) fn shape_full(&mut self, count: usize) {
        self.row_of.clear();
        self.row_of.extend(0..count);
        self.first.clear();
        self.first.resize(count, 0);
        self.allot();
    }

    fn allot(&mut self) {
        self.start.clear();
        let mut size = 0;
        for (row, first) in self.first.iter().enumerate() {
            self.start.push(size);
            size += row - first + 1;
        }
        self.blocks.clear();
        self.blocks.resize(size, Self::ZERO);
    }

    /// Number of nodes.
    pub(crate) fn count(&self) -> usize {
        self.first.len()
    }

    /// The row of a node.
    pub(crate) fn row(&self, node: usize) -> usize {
        self.row_of[node]
    }

    /// Sets all blocks to zero.
    pub fn clear(&mut self) {
        self.blocks.fill(Self::ZERO);
    }

    /// Adds a block at (a, b), and for a != b its transpose at (b, a).
    pub fn add(&mut self, a: usize, b: usize, block: &SMatrix<f64, N, N>) {
        let (i, j) = (self.row_of[a], self.row_of[b]);
        let sum = self.block_mut(i.max(j), i.min(j));
        for (column, sum) in sum.iter_mut().enumerate() {
            for (row, sum) in sum.iter_mut().enumerate() {
                *sum += if i >= j { block[(row, column)] } else { block[(column, row)] };
            }
        }
    }

    /// The block at a row and a column up to that row, within the profile.
    #[inline(always)]
    pub(crate) fn block_mut(&mut self, row: usize, column: usize) -> &mut Block<N> {
        &mut self.blocks[self.start[row] + column - self.first[row]]
    }

    /// Multiplies the diagonal by 1 + `factor`, and adds a small number to zeros.
    pub(crate) fn damp(&mut self, factor: f64) {
        for row in 0..self.first.len() {
            let block = self.block_mut(row, row);
            for (k, column) in block.iter_mut().enumerate() {
                column[k] += factor * (column[k] + 1e-9);
            }
        }
    }

    /// Number of block products for the factor of a row.
    pub(crate) fn row_work(&self, row: usize) -> usize {
        let width = row - self.first[row] + 1;
        width * width / 2 + 1
    }

    /// Replaces one row by that of the Cholesky factor, after all rows above it; `false` if the matrix is not positive definite.
    pub(crate) fn factorise_row(&mut self, row: usize) -> bool {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.factorise_row_by_avx(row) };
        }
        self.factorise_row_plainly(row)
    }

    /// The same as [`BlockMatrix::factorise_row_plainly`] with four numbers to an operation.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx")]
    fn factorise_row_by_avx(&mut self, row: usize) -> bool {
        self.factorise_row_plainly(row)
    }

    #[inline(always)]
    fn factorise_row_plainly(&mut self, i: usize) -> bool {
        let (above, own) = self.blocks.split_at_mut(self.start[i]);
        let own_first = self.first[i];
        for j in own_first..i {
            let (known, rest) = own.split_at_mut(j - own_first);
            let (first, start) = (self.first[j], self.start[j]);
            let from = own_first.max(first);
            let others = &above[start + from - first..start + j - first];
            for (left, right) in known[from - own_first..].iter().zip(others) {
                subtract_outer(&mut rest[0], left, right);
            }
            divide_by_transposed(&mut rest[0], &above[start + j - first]);
        }
        let (known, diagonal) = own.split_at_mut(i - own_first);
        for left in known.iter() {
            subtract_outer(&mut diagonal[0], left, left);
        }
        factorise(&mut diagonal[0])
    }

    /// Replaces the whole matrix by its Cholesky factor; `false` if the matrix is not positive definite.
    pub fn factorise(&mut self) -> bool {
        (0..self.count()).all(|row| self.factorise_row(row))
    }

    /// Starts the inverse, once every row is factorised.
    pub(crate) fn begin_inverse(&mut self) {
        self.inverse.clear();
        self.inverse.resize(self.blocks.len(), Self::ZERO);
        self.column.left = self.count();
        self.begin_column();
    }

    /// The next block of the inverse within the profile, column by column from the last (Takahashi et al. 1973): with Z L = L'^-1, Z_ij =
    /// -sum Z_ik L_kj L_jj^-1. Returns the approximate number of block products; `None` if the inverse is complete.
    pub(crate) fn invert_on(&mut self) -> Option<usize> {
        let j = self.column.left.checked_sub(1)?;
        if self.column.done < self.column.below.len() {
            self.invert_row(j);
            return Some(self.column.below.len() + 1);
        }
        let place = self.start[j] + j - self.first[j];
        self.inverse[place] = self.column.diagonal;
        self.column.left = j;
        self.begin_column();
        Some(self.column.below.len() + 1)
    }

    fn begin_column(&mut self) {
        let Self { column, blocks, start, first, .. } = self;
        column.below.clear();
        column.factors.clear();
        column.done = 0;
        let Some(j) = column.left.checked_sub(1) else { return };
        let at = |row: usize| SMatrix::from_data(ArrayStorage(blocks[start[row] + j - first[row]]));
        let own: SMatrix<f64, N, N> = at(j).try_inverse().unwrap_or_else(SMatrix::zeros);
        column.below.extend((j + 1..first.len()).filter(|row| first[*row] <= j));
        column.factors.extend(column.below.iter().map(|row| (at(*row) * own).data.0));
        column.diagonal = (own.transpose() * own).data.0;
    }

    fn invert_row(&mut self, j: usize) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.invert_row_by_avx(j) };
        }
        self.invert_row_plainly(j);
    }

    /// The same as [`BlockMatrix::invert_row_plainly`] with four numbers to an operation.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx")]
    fn invert_row_by_avx(&mut self, j: usize) {
        self.invert_row_plainly(j);
    }

    #[inline(always)]
    fn invert_row_plainly(&mut self, j: usize) {
        let Self { column, inverse, start, first, .. } = self;
        let i = column.below[column.done];
        let mut sum = Self::ZERO;
        for (&k, factor) in column.below.iter().zip(&column.factors) {
            let (high, low) = (i.max(k), i.min(k));
            let known = &inverse[start[high] + low - first[high]];
            for (sum, factor) in sum.iter_mut().zip(factor) {
                if i >= k {
                    subtract_product(sum, known, factor);
                } else {
                    subtract_transposed_product(sum, known, factor);
                }
            }
        }
        for (diagonal, factor) in column.diagonal.iter_mut().zip(&column.factors[column.done]) {
            subtract_transposed_product(diagonal, &sum, factor);
        }
        inverse[start[i] + j - first[i]] = sum;
        column.done += 1;
    }

    /// The diagonal block of the inverse for a node, after its column is computed.
    pub(crate) fn inverse_of(&self, node: usize) -> SMatrix<f64, N, N> {
        let row = self.row_of[node];
        SMatrix::from_data(ArrayStorage(self.inverse[self.start[row] + row - self.first[row]]))
    }

    /// Solves in place for a right-hand side of one block a node, once every row is factorised. Returns whether the solution is
    /// finite.
    pub fn solve(&mut self, rhs: &mut [SVector<f64, N>]) -> bool {
        self.unknowns.clear();
        self.unknowns.resize(rhs.len(), [0.0; N]);
        self.row_of.iter().zip(rhs.iter()).for_each(|(&row, b)| self.unknowns[row] = b.data.0[0]);
        let x = &mut self.unknowns;
        for i in 0..x.len() {
            let (known, rest) = x.split_at_mut(i);
            let row = &self.blocks[self.start[i]..];
            for (block, x) in row.iter().zip(&known[self.first[i]..]) {
                subtract_product(&mut rest[0], block, x);
            }
            solve_lower(&row[i - self.first[i]], &mut rest[0]);
        }
        for i in (0..x.len()).rev() {
            let (above, rest) = x.split_at_mut(i);
            let row = &self.blocks[self.start[i]..];
            solve_upper(&row[i - self.first[i]], &mut rest[0]);
            for (block, above) in row.iter().zip(&mut above[self.first[i]..]) {
                subtract_transposed_product(above, block, &rest[0]);
            }
        }
        self.row_of.iter().zip(rhs.iter_mut()).for_each(|(&row, b)| *b = SVector::from(self.unknowns[row]));
        rhs.iter().all(|b| b.iter().all(|value| value.is_finite()))
    }
}

fn ordered(a: usize, b: usize) -> (usize, usize) {
    (a.min(b), a.max(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector, Matrix6};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Solution and inverse of a random chain with loops against the dense factorisation.
    fn agrees_with_a_dense_solver<const N: usize>(seed: u64) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let count = 15;
        let mut pairs: Vec<(usize, usize)> = (1..count).map(|i| (i - 1, i)).collect();
        pairs.extend([(14, 0), (3, 11), (7, 2)]);
        let mut blocks = BlockMatrix::<N>::new(count, &pairs);
        let mut dense = DMatrix::zeros(N * count, N * count);
        let mut random = || SMatrix::<f64, N, N>::from_fn(|_, _| rng.random_range(-1.0..1.0));
        for &(a, b) in &pairs {
            // J'J of a random coupling, and the identity on the diagonal.
            let (ja, jb) = (random(), random());
            for (i, j, block) in [
                (a, a, ja.transpose() * ja + SMatrix::identity()),
                (b, b, jb.transpose() * jb + SMatrix::identity()),
                (a, b, ja.transpose() * jb),
            ] {
                blocks.add(i, j, &block);
                let mut view = dense.fixed_view_mut::<N, N>(N * i, N * j);
                view += block;
                if i != j {
                    let mut view = dense.fixed_view_mut::<N, N>(N * j, N * i);
                    view += block.transpose();
                }
            }
        }
        let rhs: Vec<SVector<f64, N>> = (0..count).map(|_| random().column(0).into_owned()).collect();
        let flat = DVector::from_iterator(N * count, rhs.iter().flat_map(|v| v.iter().copied()));
        let expected = dense.clone().cholesky().unwrap().solve(&flat);
        let mut found = rhs.clone();
        assert!(blocks.factorise() && blocks.solve(&mut found));
        for (i, v) in found.iter().enumerate() {
            assert!((v - expected.fixed_rows::<N>(N * i)).norm() < 1e-10);
        }
        blocks.begin_inverse();
        while blocks.invert_on().is_some() {}
        let inverse = dense.try_inverse().unwrap();
        for i in 0..count {
            assert!((blocks.inverse_of(i) - inverse.fixed_view::<N, N>(N * i, N * i)).norm() < 1e-10);
        }
    }

    #[test]
    fn the_block_solver_agrees_with_a_dense_solver_for_every_block_size() {
        agrees_with_a_dense_solver::<6>(4);
        agrees_with_a_dense_solver::<3>(4);
        agrees_with_a_dense_solver::<2>(4);
        agrees_with_a_dense_solver::<1>(4);
    }

    #[test]
    fn four_numbers_to_an_operation_change_nothing() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let mut plain = BlockMatrix::<6>::default();
        plain.shape_full(6);
        for i in 0..6 {
            for j in 0..=i {
                let block = Matrix6::from_fn(|_, _| rng.random_range(-1.0..1.0));
                plain.add(i, j, &(block + Matrix6::identity() * if i == j { 40.0 } else { 0.0 }));
            }
        }
        let mut fast = plain.clone();
        for row in 0..6 {
            assert!(plain.factorise_row_plainly(row) && fast.factorise_row(row));
        }
        assert_eq!(plain.blocks, fast.blocks);
    }

    #[test]
    fn a_ring_is_stored_narrowly_and_what_is_not_definite_is_refused() {
        let ring: Vec<(usize, usize)> = (0..100).map(|i| (i, (i + 1) % 100)).collect();
        let mut blocks = BlockMatrix::<6>::new(100, &ring);
        assert!(blocks.blocks.len() < 310, "{}", blocks.blocks.len());
        assert!(!blocks.factorise());
    }
}
