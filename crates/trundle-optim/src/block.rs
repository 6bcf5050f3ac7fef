//! Square blocks and the operations that dominate the time of a sparse factorisation.
//!
//! All operations are column by column, one vector operation per line. They are inlined into callers that are compiled twice: without and
//! with AVX. Both variants have the same order of operations without fusing, and give equal bits.

/// Column of N rows; six for a pose in space, three for one in the plane.
pub(crate) type Column<const N: usize = 6> = [f64; N];
/// Block of N columns.
pub(crate) type Block<const N: usize = 6> = [Column<N>; N];

/// `block -= left right'`, both of K columns.
#[inline(always)]
pub(crate) fn subtract_outer<const N: usize, const K: usize>(
    block: &mut Block<N>,
    left: &[Column<N>; K],
    right: &[Column<N>; K],
) {
    for (column, stored) in block.iter_mut().enumerate() {
        // A copy: with sums in memory, the compiler must expect `left` to change with them, and leaves them single on aarch64.
        let mut sums = *stored;
        for k in 0..K {
            let factor = right[k][column];
            for (sum, value) in sums.iter_mut().zip(&left[k]) {
                *sum -= value * factor;
            }
        }
        *stored = sums;
    }
}

/// `vector -= block x`.
#[inline(always)]
pub(crate) fn subtract_product<const N: usize>(vector: &mut Column<N>, block: &Block<N>, x: &Column<N>) {
    for (column, factor) in block.iter().zip(x) {
        for (sum, value) in vector.iter_mut().zip(column) {
            *sum -= value * factor;
        }
    }
}

/// `vector -= block' x`.
#[inline(always)]
pub(crate) fn subtract_transposed_product<const N: usize>(
    vector: &mut Column<N>,
    block: &Block<N>,
    x: &Column<N>,
) {
    for (sum, column) in vector.iter_mut().zip(block) {
        *sum -= column.iter().zip(x).map(|(a, b)| a * b).sum::<f64>();
    }
}

/// Replaces a symmetric block, of which the lower half is read, by its lower Cholesky factor. Returns whether the block is positive
/// definite.
#[inline(always)]
pub(crate) fn factorise<const N: usize>(block: &mut Block<N>) -> bool {
    for j in 0..N {
        for k in 0..j {
            let (known, factor) = (block[k], block[k][j]);
            for (sum, value) in block[j][j..].iter_mut().zip(&known[j..]) {
                *sum -= value * factor;
            }
        }
        let pivot = block[j][j];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        let inverse = 1.0 / pivot.sqrt();
        block[j].iter_mut().skip(j).for_each(|value| *value *= inverse);
        block[j].iter_mut().take(j).for_each(|value| *value = 0.0);
    }
    true
}

/// `block L'^-1` in place, for a lower factor L.
#[inline(always)]
pub(crate) fn divide_by_transposed<const N: usize>(block: &mut Block<N>, lower: &Block<N>) {
    for j in 0..N {
        for k in 0..j {
            let (known, factor) = (block[k], lower[k][j]);
            for (sum, value) in block[j].iter_mut().zip(&known) {
                *sum -= value * factor;
            }
        }
        let inverse = 1.0 / lower[j][j];
        block[j].iter_mut().for_each(|value| *value *= inverse);
    }
}

/// `L^-1 x` in place.
#[inline(always)]
pub(crate) fn solve_lower<const N: usize>(lower: &Block<N>, x: &mut Column<N>) {
    for j in 0..N {
        x[j] /= lower[j][j];
        for row in j + 1..N {
            x[row] -= lower[j][row] * x[j];
        }
    }
}

/// `L'^-1 x` in place.
#[inline(always)]
pub(crate) fn solve_upper<const N: usize>(lower: &Block<N>, x: &mut Column<N>) {
    for j in (0..N).rev() {
        for row in j + 1..N {
            x[j] -= lower[j][row] * x[row];
        }
        x[j] /= lower[j][j];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix6, Matrix6x3, Vector6};
    use proptest::prelude::*;

    fn any_block() -> impl Strategy<Value = Block> {
        prop::array::uniform6(prop::array::uniform6(-1.0..1.0))
    }

    fn matrix(block: &Block) -> Matrix6<f64> {
        Matrix6::from_fn(|row, column| block[column][row])
    }

    proptest! {
        #[test]
        fn block_operations_agree_with_dense_matrices(a in any_block(), b in any_block(), x in prop::array::uniform6(-1.0..1.0)) {
            let (ma, mb, vx) = (matrix(&a), matrix(&b), Vector6::from(x));
            let (mut out, three) = (a, |m: &Block| [m[0], m[1], m[2]]);
            subtract_outer(&mut out, &three(&a), &three(&b));
            let thin = |m: Matrix6<f64>| -> Matrix6x3<f64> { m.fixed_columns::<3>(0).into_owned() };
            prop_assert!((matrix(&out) - (ma - thin(ma) * thin(mb).transpose())).norm() < 1e-12);
            let mut definite = matrix(&b);
            definite = definite * definite.transpose() + Matrix6::identity();
            let mut lower: Block = definite.data.0;
            prop_assert!(factorise(&mut lower));
            prop_assert!((matrix(&lower) * matrix(&lower).transpose() - definite).norm() < 1e-10);
            let mut quotient = a;
            divide_by_transposed(&mut quotient, &lower);
            prop_assert!((matrix(&quotient) * matrix(&lower).transpose() - ma).norm() < 1e-10);
            let mut solved = x;
            solve_lower(&lower, &mut solved);
            solve_upper(&lower, &mut solved);
            prop_assert!((definite * Vector6::from(solved) - vx).norm() < 1e-9);
            let (mut plain, mut transposed) = (x, x);
            subtract_product(&mut plain, &a, &x);
            subtract_transposed_product(&mut transposed, &a, &x);
            prop_assert!((Vector6::from(plain) - (vx - ma * vx)).norm() < 1e-12);
            prop_assert!((Vector6::from(transposed) - (vx - ma.transpose() * vx)).norm() < 1e-12);
        }
    }

    #[test]
    fn an_indefinite_block_is_refused() {
        assert!(!factorise(&mut [[0.0; 6]; 6]));
        assert!(!factorise(&mut [[f64::NAN; 6]; 6]));
    }
}
