//! Laws of the pose-graph solution.

use super::*;
use crate::pose_graph::equations::FIRST_POSE_INFORMATION;
use nalgebra::{DMatrix, DVector, Vector3};
use proptest::prelude::*;

/// Poses along an arc, odometry between neighbours with errors `noise`, and loops between the `pairs`.
fn graph(count: usize, pairs: &[(usize, usize)], noise: &[f64]) -> (Vec<Pose2>, Vec<Constraint>) {
    let truth: Vec<Pose2> =
        (0..count).map(|i| Pose2::new(0.5 * i as f64, 0.1 * (i as f64).sin(), 0.2 * i as f64)).collect();
    let chain = (1..count).map(|i| (i - 1, i));
    let constraint = |(k, (i, j)): (usize, (usize, usize))| {
        let error = |n: usize| noise[(3 * k + n) % noise.len()];
        Constraint {
            from: i as u32,
            to: j as u32,
            from_to: truth[i].inverse() * truth[j] * Pose2::new(error(0), error(1), error(2)),
            covariance: Matrix3::from_diagonal(&Vector3::new(1e-3, 2e-3, 1e-4)),
        }
    };
    let constraints = chain.chain(pairs.iter().copied()).enumerate().map(constraint).collect();
    (truth, constraints)
}

/// Step of all poses by the dense normal equations.
fn dense_step(poses: &[Pose2], constraints: &[Constraint]) -> DVector<f64> {
    let size = 3 * poses.len();
    let (mut matrix, mut rhs) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for constraint in constraints {
        let (i, j) = constraint.poses();
        let (by_from, by_to) = constraint.jacobians(poses[i], poses[j]);
        let mut jacobian = DMatrix::zeros(3, size);
        jacobian.fixed_view_mut::<3, 3>(0, 3 * i).copy_from(&by_from);
        jacobian.fixed_view_mut::<3, 3>(0, 3 * j).copy_from(&by_to);
        let weighted = jacobian.transpose() * constraint.information();
        matrix += &weighted * &jacobian;
        rhs -= weighted * constraint.residual(poses[i], poses[j]);
    }
    for k in 0..3 {
        matrix[(k, k)] += FIRST_POSE_INFORMATION;
    }
    matrix.lu().solve(&rhs).unwrap()
}

proptest! {
    #[test]
    fn a_step_is_that_of_the_dense_normal_equations(
        noise in prop::collection::vec(-0.02..0.02_f64, 5..20),
        loops in prop::collection::vec((0..12_usize, 0..12_usize), 0..5),
    ) {
        let pairs: Vec<_> = loops.into_iter().filter(|(i, j)| i != j).collect();
        let (poses, constraints) = graph(12, &pairs, &noise);
        let pairs: Vec<_> = constraints.iter().map(Constraint::poses).collect();
        let mut equations = PoseEquations::new(poses.len(), &pairs);
        for constraint in &constraints {
            equations.add_constraint(&poses, constraint, &constraint.information());
        }
        let found = equations.solve().unwrap();
        let expected = dense_step(&poses, &constraints);
        for (i, step) in found.iter().enumerate() {
            prop_assert!((step - expected.fixed_rows::<3>(3 * i)).norm() < 1e-7, "pose {i}: {step}");
        }
    }

    #[test]
    fn exact_constraints_are_met_from_a_bad_start(
        errors in prop::collection::vec((-0.2..0.2_f64, -0.2..0.2_f64, -0.2..0.2_f64), 11),
    ) {
        let (truth, constraints) = graph(12, &[(0, 11), (3, 8)], &[0.0]);
        let start = truth.iter().enumerate().map(|(i, pose)| match i.checked_sub(1) {
            Some(k) => *pose * Pose2::new(errors[k].0, errors[k].1, errors[k].2),
            None => *pose,
        });
        let solved = solve(start.collect(), &constraints).unwrap();
        for (found, truth) in solved.iter().zip(&truth) {
            prop_assert!(found.distance(truth) < 1e-4 && (found.theta - truth.theta).abs() < 1e-4);
        }
    }

    #[test]
    fn the_solution_does_not_depend_on_the_order_of_the_constraints(
        noise in prop::collection::vec(-0.02..0.02_f64, 5..20),
        turn in 1..13_usize,
    ) {
        let (poses, constraints) = graph(12, &[(0, 11), (2, 9)], &noise);
        let mut turned = constraints.clone();
        turned.rotate_left(turn);
        let (a, b) = (solve(poses.clone(), &constraints).unwrap(), solve(poses, &turned).unwrap());
        for (a, b) in a.iter().zip(&b) {
            prop_assert!(a.distance(b) < 1e-8);
        }
    }
}

#[test]
fn poses_without_constraints_have_no_solution() {
    assert!(solve(vec![Pose2::IDENTITY; 3], &[]).is_none());
}

/// Eight poses around a square, each step off by some degrees: the loop closes and the error is spread.
#[test]
fn a_loop_spreads_its_error_evenly() {
    let truth: Vec<Pose2> = (0..9)
        .scan(Pose2::IDENTITY, |at, i| {
            let here = *at;
            *at = *at * Pose2::new(2.0, 0.0, if i % 2 == 1 { std::f64::consts::FRAC_PI_2 } else { 0.0 });
            Some(here)
        })
        .collect();
    let covariance = Matrix3::from_diagonal(&Vector3::new(1e-3, 1e-3, 1e-4));
    let wrong = Pose2::new(0.01, 0.0, 0.06);
    let mut constraints: Vec<Constraint> = (0..8)
        .map(|i| Constraint {
            from: i as u32,
            to: i as u32 + 1,
            from_to: truth[i].inverse() * truth[i + 1] * wrong,
            covariance,
        })
        .collect();
    let mut poses = vec![Pose2::IDENTITY];
    for constraint in &constraints {
        poses.push(*poses.last().unwrap() * constraint.from_to);
    }
    assert!(poses[8].distance(&truth[8]) > 0.5);
    constraints.push(Constraint { from: 0, to: 8, from_to: truth[8], covariance: covariance * 1e-3 });
    let solved = solve(poses, &constraints).unwrap();
    for (found, truth) in solved.iter().zip(&truth) {
        assert!(found.distance(truth) < 0.25, "{found:?} {truth:?}");
    }
    assert!(solved[8].distance(&truth[8]) < 0.01);
}
