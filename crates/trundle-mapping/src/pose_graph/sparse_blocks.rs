//! Sparse symmetric matrix of 3 x 3 blocks and its elimination.

use nalgebra::{Matrix3, Vector3};
use std::collections::{BTreeMap, BTreeSet};

/// A sparse symmetric positive matrix of 3 x 3 blocks, solved by elimination of the row with the fewest neighbours first.
///
/// Of a chain with loops the links of the chain go first, each at the cost of one block; what remains is as small as the
/// loops are many.
#[derive(Debug, Clone)]
pub(crate) struct SparseBlocks {
    diagonal: Vec<Matrix3<f64>>,
    /// Off the diagonal, both halves.
    rows: Vec<BTreeMap<u32, Matrix3<f64>>>,
}

struct Eliminated {
    row: usize,
    inverse: Matrix3<f64>,
    others: BTreeMap<u32, Matrix3<f64>>,
}

impl SparseBlocks {
    pub(crate) fn new(count: usize) -> Self {
        Self { diagonal: vec![Matrix3::zeros(); count], rows: vec![BTreeMap::new(); count] }
    }

    pub(crate) fn add_diagonal(&mut self, row: usize, block: &Matrix3<f64>) {
        self.diagonal[row] += block;
    }

    /// Adds a block at (row, col) and its transpose at (col, row), which differ.
    pub(crate) fn add(&mut self, row: usize, col: usize, block: &Matrix3<f64>) {
        *self.rows[row].entry(col as u32).or_insert_with(Matrix3::zeros) += block;
        *self.rows[col].entry(row as u32).or_insert_with(Matrix3::zeros) += block.transpose();
    }

    /// Solves for `right`; `None` where the matrix is not positive.
    pub(crate) fn solve(mut self, mut right: Vec<Vector3<f64>>) -> Option<Vec<Vector3<f64>>> {
        let mut queue: BTreeSet<(usize, usize)> =
            self.rows.iter().enumerate().map(|(i, row)| (row.len(), i)).collect();
        let mut done: Vec<Eliminated> = Vec::with_capacity(right.len());
        while let Some((_, row)) = queue.pop_first() {
            let gone = self.eliminate(row, &mut queue, &mut right)?;
            done.push(gone);
        }
        let mut solution = right;
        for gone in done.iter().rev() {
            let mut rest = solution[gone.row];
            for (other, block) in &gone.others {
                rest -= block * solution[*other as usize];
            }
            solution[gone.row] = gone.inverse * rest;
        }
        Some(solution)
    }

    fn eliminate(
        &mut self,
        row: usize,
        queue: &mut BTreeSet<(usize, usize)>,
        right: &mut [Vector3<f64>],
    ) -> Option<Eliminated> {
        let inverse = self.diagonal[row].cholesky()?.inverse();
        let others = std::mem::take(&mut self.rows[row]);
        for (i, block) in &others {
            let i = *i as usize;
            let factor = block.transpose() * inverse;
            right[i] -= factor * right[row];
            self.diagonal[i] -= factor * block;
            queue.remove(&(self.rows[i].len(), i));
            self.rows[i].remove(&(row as u32));
            for (j, other) in &others {
                if *j as usize != i {
                    *self.rows[i].entry(*j).or_insert_with(Matrix3::zeros) -= factor * other;
                }
            }
            queue.insert((self.rows[i].len(), i));
        }
        Some(Eliminated { row, inverse, others })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn is_what_the_dense_solver_finds() {
        let count = 12;
        let pairs: Vec<_> = (1..count).map(|i| (i - 1, i)).chain([(0, 7), (2, 11), (2, 9)]).collect();
        let mut sparse = SparseBlocks::new(count);
        let mut dense = DMatrix::zeros(3 * count, 3 * count);
        for (k, &(i, j)) in pairs.iter().enumerate() {
            let block = Matrix3::from_fn(|r, c| ((k * 7 + r * 3 + c) as f64).sin());
            sparse.add(i, j, &block);
            let mut view = dense.view_mut((3 * i, 3 * j), (3, 3));
            view += block;
            let mut view = dense.view_mut((3 * j, 3 * i), (3, 3));
            view += block.transpose();
        }
        for i in 0..count {
            let block = Matrix3::from_diagonal_element(20.0 + i as f64);
            sparse.add_diagonal(i, &block);
            let mut view = dense.view_mut((3 * i, 3 * i), (3, 3));
            view += block;
        }
        let right: Vec<_> = (0..count).map(|i| Vector3::new(i as f64, 1.0, -2.0)).collect();
        let expected = dense.lu().solve(&DVector::from_iterator(
            3 * count,
            right.iter().flat_map(|v| v.iter().copied().collect::<Vec<_>>()),
        ));
        let (expected, found) = (expected.unwrap(), sparse.solve(right).unwrap());
        for (i, v) in found.iter().enumerate() {
            assert!(
                (v - Vector3::new(expected[3 * i], expected[3 * i + 1], expected[3 * i + 2])).norm() < 1e-9
            );
        }
    }
}
