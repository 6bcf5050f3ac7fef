use nalgebra::{Matrix6, Vector6};
use std::collections::VecDeque;

/// A symmetric positive definite matrix of 6 x 6 blocks in profile storage, and its Cholesky factor in place.
///
/// Block rows hold their lower half from the first block that is not zero on; that is all a factor can fill. Ordered by
/// reverse Cuthill-McKee, whose profile of a chain with few loops is a few blocks wide: O(n) work and memory for it.
#[derive(Debug, Clone, Default)]
pub(crate) struct BlockMatrix {
    /// Place of node i among the rows.
    row_of: Vec<usize>,
    /// First block column of each row.
    first: Vec<usize>,
    /// Where each row's first block stands.
    start: Vec<usize>,
    blocks: Vec<Matrix6<f64>>,
}

impl BlockMatrix {
    /// Zeros for `count` nodes that are coupled by `pairs`.
    pub(crate) fn new(count: usize, pairs: &[(usize, usize)]) -> Self {
        let row_of = narrow_order(count, pairs);
        let mut first: Vec<usize> = (0..count).collect();
        for &(a, b) in pairs {
            let (low, high) = ordered(row_of[a], row_of[b]);
            first[high] = first[high].min(low);
        }
        let mut start = Vec::with_capacity(count);
        let mut size = 0;
        for (row, first) in first.iter().enumerate() {
            start.push(size);
            size += row - first + 1;
        }
        Self { row_of, first, start, blocks: vec![Matrix6::zeros(); size] }
    }

    pub(crate) fn clear(&mut self) {
        self.blocks.fill(Matrix6::zeros());
    }

    /// Adds a block at (a, b), and its transpose at (b, a) where these differ.
    pub(crate) fn add(&mut self, a: usize, b: usize, block: &Matrix6<f64>) {
        let (i, j) = (self.row_of[a], self.row_of[b]);
        let at = self.at(i.max(j), i.min(j));
        self.blocks[at] += if i >= j { *block } else { block.transpose() };
    }

    /// Multiplies the diagonal by 1 + `factor`, and adds a little where it is zero.
    pub(crate) fn damp(&mut self, factor: f64) {
        for row in 0..self.first.len() {
            let at = self.at(row, row);
            for k in 0..6 {
                self.blocks[at][(k, k)] += factor * (self.blocks[at][(k, k)] + 1e-9);
            }
        }
    }

    /// Turns the matrix into its Cholesky factor; `None` when it is not positive definite.
    pub(crate) fn factorise(mut self) -> Option<BlockFactor> {
        for i in 0..self.first.len() {
            for j in self.first[i]..=i {
                let mut sum = self.blocks[self.at(i, j)];
                for k in self.first[i].max(self.first[j])..j {
                    sum -= self.blocks[self.at(i, k)] * self.blocks[self.at(j, k)].transpose();
                }
                let at = self.at(i, j);
                self.blocks[at] = if i == j {
                    sum.cholesky()?.l()
                } else {
                    let diagonal = self.blocks[self.at(j, j)];
                    // X L' = S, row by row: L X' = S'.
                    diagonal.solve_lower_triangular(&sum.transpose())?.transpose()
                };
            }
        }
        Some(BlockFactor(self))
    }

    fn at(&self, row: usize, column: usize) -> usize {
        self.start[row] + column - self.first[row]
    }
}

/// The Cholesky factor of a [`BlockMatrix`].
#[derive(Debug, Clone)]
pub(crate) struct BlockFactor(BlockMatrix);

impl BlockFactor {
    /// The solution for a right-hand side of one block a node; `None` when it is not finite.
    pub(crate) fn solve(&self, rhs: &[Vector6<f64>]) -> Option<Vec<Vector6<f64>>> {
        let m = &self.0;
        let mut x = vec![Vector6::zeros(); rhs.len()];
        m.row_of.iter().zip(rhs).for_each(|(&row, b)| x[row] = *b);
        for i in 0..x.len() {
            for k in m.first[i]..i {
                let known = m.blocks[m.at(i, k)] * x[k];
                x[i] -= known;
            }
            x[i] = m.blocks[m.at(i, i)].solve_lower_triangular(&x[i])?;
        }
        for i in (0..x.len()).rev() {
            x[i] = m.blocks[m.at(i, i)].tr_solve_lower_triangular(&x[i])?;
            for k in m.first[i]..i {
                let known = m.blocks[m.at(i, k)].transpose() * x[i];
                x[k] -= known;
            }
        }
        let solution: Vec<Vector6<f64>> = m.row_of.iter().map(|&row| x[row]).collect();
        solution.iter().all(|v| v.iter().all(|c| c.is_finite())).then_some(solution)
    }
}

fn ordered(a: usize, b: usize) -> (usize, usize) {
    (a.min(b), a.max(b))
}

/// The row of each node by reverse Cuthill-McKee (Cuthill, McKee 1969; George 1971): breadth first from a node of least
/// degree, neighbours by rising degree, then backwards. Ties go to the lower number.
fn narrow_order(count: usize, pairs: &[(usize, usize)]) -> Vec<usize> {
    let mut neighbours = vec![Vec::new(); count];
    for &(a, b) in pairs.iter().filter(|(a, b)| a != b) {
        neighbours[a].push(b);
        neighbours[b].push(a);
    }
    for own in &mut neighbours {
        own.sort_unstable();
        own.dedup();
    }
    let degree: Vec<usize> = neighbours.iter().map(Vec::len).collect();
    neighbours.iter_mut().for_each(|own| own.sort_by_key(|&n| (degree[n], n)));
    let mut starts: Vec<usize> = (0..count).collect();
    starts.sort_by_key(|&n| (degree[n], n));
    let mut order = Vec::with_capacity(count);
    let mut is_met = vec![false; count];
    for start in starts {
        if std::mem::replace(&mut is_met[start], true) {
            continue;
        }
        let mut queue = VecDeque::from([start]);
        while let Some(node) = queue.pop_front() {
            order.push(node);
            for &next in &neighbours[node] {
                if !std::mem::replace(&mut is_met[next], true) {
                    queue.push_back(next);
                }
            }
        }
    }
    let mut row_of = vec![0; count];
    order.iter().rev().enumerate().for_each(|(row, &node)| row_of[node] = row);
    row_of
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn it_solves_what_the_dense_solver_solves() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let count = 15;
        let mut pairs: Vec<(usize, usize)> = (1..count).map(|i| (i - 1, i)).collect();
        pairs.extend([(14, 0), (3, 11), (7, 2)]);
        let mut blocks = BlockMatrix::new(count, &pairs);
        let mut dense = DMatrix::zeros(6 * count, 6 * count);
        for &(a, b) in &pairs {
            // J'J of a random coupling, and something on the diagonal.
            let (ja, jb) = (
                Matrix6::from_fn(|_, _| rng.random_range(-1.0..1.0)),
                Matrix6::from_fn(|_, _| rng.random_range(-1.0..1.0)),
            );
            for (i, j, block) in [
                (a, a, ja.transpose() * ja + Matrix6::identity()),
                (b, b, jb.transpose() * jb + Matrix6::identity()),
                (a, b, ja.transpose() * jb),
            ] {
                blocks.add(i, j, &block);
                let mut view = dense.fixed_view_mut::<6, 6>(6 * i, 6 * j);
                view += block;
                if i != j {
                    let mut view = dense.fixed_view_mut::<6, 6>(6 * j, 6 * i);
                    view += block.transpose();
                }
            }
        }
        let rhs: Vec<Vector6<f64>> =
            (0..count).map(|_| Vector6::from_fn(|_, _| rng.random_range(-1.0..1.0))).collect();
        let flat = DVector::from_iterator(6 * count, rhs.iter().flat_map(|v| v.iter().copied()));
        let expected = dense.cholesky().unwrap().solve(&flat);
        let found = blocks.factorise().unwrap().solve(&rhs).unwrap();
        for (i, v) in found.iter().enumerate() {
            assert!((v - expected.fixed_rows::<6>(6 * i)).norm() < 1e-10);
        }
    }

    #[test]
    fn a_ring_is_stored_narrowly_and_what_is_not_definite_is_refused() {
        let ring: Vec<(usize, usize)> = (0..100).map(|i| (i, (i + 1) % 100)).collect();
        let blocks = BlockMatrix::new(100, &ring);
        assert!(blocks.blocks.len() < 310, "{}", blocks.blocks.len());
        assert!(blocks.factorise().is_none());
    }
}
