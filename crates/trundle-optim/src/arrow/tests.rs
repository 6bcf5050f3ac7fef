//! The arrow against dense matrices.

use super::ArrowSystem;
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Number of unknowns of a block of the chain, and of the border.
const BLOCK_SIZE: usize = 3;
const BORDER_SIZE: usize = 4;

/// Random factors of a chain with a border, as a system and as dense normal equations.
fn random(count: usize, seed: u64) -> (ArrowSystem<BLOCK_SIZE, BORDER_SIZE>, DMatrix<f64>, DVector<f64>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut system = ArrowSystem::with_capacity(count);
    system.reset(count);
    let size = count * BLOCK_SIZE + BORDER_SIZE;
    let (mut dense, mut rhs) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for i in 0..count {
        let j = (i + 1).min(count - 1);
        let mut jacobian = DMatrix::zeros(8, size);
        for row in 0..8 {
            for column in (i * BLOCK_SIZE..(j + 1) * BLOCK_SIZE).chain(count * BLOCK_SIZE..size) {
                jacobian[(row, column)] = rng.random_range(-1.0..1.0);
            }
        }
        let residual = DVector::from_fn(8, |_, _| rng.random_range(-1.0..1.0));
        let hessian = jacobian.transpose() * &jacobian;
        let gradient = jacobian.transpose() * residual;
        let block = |a: usize, b: usize| {
            SMatrix::<f64, BLOCK_SIZE, BLOCK_SIZE>::from(
                hessian.fixed_view::<BLOCK_SIZE, BLOCK_SIZE>(a * BLOCK_SIZE, b * BLOCK_SIZE),
            )
        };
        system.add_diagonal(i, &block(i, i));
        if j > i {
            system.add_diagonal(j, &block(j, j));
            system.add_next(i, &block(i, j));
            system.add_coupling(
                j,
                &hessian.fixed_view::<BLOCK_SIZE, BORDER_SIZE>(j * BLOCK_SIZE, count * BLOCK_SIZE).into(),
            );
            system.add_gradient(j, &gradient.fixed_rows::<BLOCK_SIZE>(j * BLOCK_SIZE).into());
        }
        system.add_coupling(
            i,
            &hessian.fixed_view::<BLOCK_SIZE, BORDER_SIZE>(i * BLOCK_SIZE, count * BLOCK_SIZE).into(),
        );
        system.add_gradient(i, &gradient.fixed_rows::<BLOCK_SIZE>(i * BLOCK_SIZE).into());
        system.add_border(
            &hessian.fixed_view::<BORDER_SIZE, BORDER_SIZE>(count * BLOCK_SIZE, count * BLOCK_SIZE).into(),
            &gradient.fixed_rows::<BORDER_SIZE>(count * BLOCK_SIZE).into(),
        );
        dense += hessian;
        rhs += gradient;
    }
    (system, dense, rhs)
}

proptest! {
    #[test]
    fn steps_and_covariances_are_those_of_the_dense_system(count in 1_usize..12, seed in 0_u64..1000) {
        let (mut system, mut dense, rhs) = random(count, seed);
        system.damp(0.01);
        for i in 0..dense.nrows() {
            dense[(i, i)] *= 1.01;
        }
        prop_assert!(system.factorise());
        system.solve();
        let inverse = dense.try_inverse().unwrap();
        let solution = &inverse * rhs;
        let end = count * BLOCK_SIZE;
        for i in 0..count {
            let expected: SVector<f64, BLOCK_SIZE> = solution.fixed_rows::<BLOCK_SIZE>(i * BLOCK_SIZE).into();
            prop_assert!((system.step(i) - expected).norm() < 1e-7 * (1.0 + expected.norm()));
            let found = system.covariance(i);
            let block = inverse.fixed_view::<BLOCK_SIZE, BLOCK_SIZE>(i * BLOCK_SIZE, i * BLOCK_SIZE);
            let cross = inverse.fixed_view::<BLOCK_SIZE, BORDER_SIZE>(i * BLOCK_SIZE, end);
            prop_assert!((found.block - block).norm() < 1e-7 * (1.0 + block.norm()));
            prop_assert!((found.cross - cross).norm() < 1e-7 * (1.0 + cross.norm()));
        }
        let border: SVector<f64, BORDER_SIZE> = solution.fixed_rows::<BORDER_SIZE>(end).into();
        prop_assert!((system.border_step() - border).norm() < 1e-7 * (1.0 + border.norm()));
        let border = inverse.fixed_view::<BORDER_SIZE, BORDER_SIZE>(end, end);
        prop_assert!((system.covariance(0).border - border).norm() < 1e-7 * (1.0 + border.norm()));
    }
}

#[test]
fn an_indefinite_system_is_refused() {
    let mut system = ArrowSystem::<BLOCK_SIZE, BORDER_SIZE>::with_capacity(2);
    system.reset(2);
    assert!(!system.factorise());
}

#[test]
fn a_removed_block_is_the_schur_complement() {
    let (mut system, dense, rhs) = random(2, 5);
    let rest = BLOCK_SIZE + BORDER_SIZE;
    let first = dense.view((0, 0), (BLOCK_SIZE, BLOCK_SIZE)).into_owned().try_inverse().unwrap();
    let coupling = dense.view((BLOCK_SIZE, 0), (rest, BLOCK_SIZE));
    let information =
        dense.view((BLOCK_SIZE, BLOCK_SIZE), (rest, rest)) - coupling * &first * coupling.transpose();
    let gradient = rhs.rows(BLOCK_SIZE, rest) - coupling * &first * rhs.rows(0, BLOCK_SIZE);
    let found = system.marginalise_first().unwrap();
    assert!((found.block - information.fixed_view::<BLOCK_SIZE, BLOCK_SIZE>(0, 0)).norm() < 1e-9);
    assert!(
        (found.coupling - information.fixed_view::<BLOCK_SIZE, BORDER_SIZE>(0, BLOCK_SIZE)).norm() < 1e-9
    );
    assert!(
        (found.border - information.fixed_view::<BORDER_SIZE, BORDER_SIZE>(BLOCK_SIZE, BLOCK_SIZE)).norm()
            < 1e-9
    );
    assert!((found.gradient - gradient.fixed_rows::<BLOCK_SIZE>(0)).norm() < 1e-9);
    assert!((found.border_gradient - gradient.fixed_rows::<BORDER_SIZE>(BLOCK_SIZE)).norm() < 1e-9);
    assert!(random(3, 5).0.marginalise_first().is_none());
}
