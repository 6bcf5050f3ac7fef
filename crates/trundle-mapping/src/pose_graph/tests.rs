//! Laws of the pose graph whose answers are known: straight loops, moved frames, reversed constraints, sampled covariances.

use super::{Constraint, reach, solve};
use crate::rbpf::rng::ParticleRng;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use trundle_core::{Pose2, wrap_angle};

fn diagonal(x: f64, y: f64, theta: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(x, y, theta))
}

fn tie(from: usize, to: usize, from_to: Pose2, covariance: Matrix3<f64>) -> Constraint {
    Constraint { from: from as u32, to: to as u32, from_to, covariance }
}

/// Poses on a circle, noisy steps between neighbours, and a loop from the last pose to the first.
fn circle(noise: &[f64]) -> (Vec<Pose2>, Vec<Constraint>) {
    let count = 10;
    let truth: Vec<Pose2> = (0..count)
        .map(|i| Pose2::new(0.0, -2.0, 0.0) * Pose2::exp(Vector3::new(1.2, 0.0, 0.63) * i as f64))
        .collect();
    let constraints = (0..count).map(|i| {
        let (from, to) = (i, (i + 1) % count);
        let error = |k: usize| noise[(3 * i + k) % noise.len()];
        let measured = truth[from].inverse() * truth[to] * Pose2::new(error(0), error(1), error(2));
        tie(from, to, measured, diagonal(1e-3 * (1.0 + i as f64), 2e-3, 1e-4))
    });
    let constraints = constraints.collect();
    (truth, constraints)
}

/// The reversed constraint: its covariance is transported by the adjoint of the measurement.
fn reversed(constraint: &Constraint) -> Constraint {
    let adjoint = constraint.from_to.adjoint();
    let covariance = adjoint * constraint.covariance * adjoint.transpose();
    Constraint { from: constraint.to, to: constraint.from, from_to: constraint.from_to.inverse(), covariance }
}

fn cost(poses: &[Pose2], constraints: &[Constraint]) -> f64 {
    let of = |constraint: &Constraint| {
        let (i, j) = constraint.poses();
        let residual = constraint.residual(poses[i], poses[j]);
        residual.dot(&(constraint.information() * residual))
    };
    constraints.iter().map(of).sum()
}

fn any_noise() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-0.02..0.02_f64, 5..20)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// On a straight line the error of the loop goes to each step in proportion to the step's variance.
    #[test]
    fn a_straight_loop_spreads_its_error_by_the_variances(
        variances in prop::collection::vec(1e-4..1e-2_f64, 2..12), loop_variance in 1e-6..1e-3_f64, error in -0.4..0.4_f64,
    ) {
        let poses: Vec<Pose2> = (0..=variances.len()).map(|i| Pose2::new(i as f64, 0.0, 0.0)).collect();
        let last = variances.len();
        let step = |(i, variance): (usize, &f64)| tie(i, i + 1, Pose2::new(1.0, 0.0, 0.0), diagonal(*variance, 1e-3, 1e-4));
        let mut constraints: Vec<Constraint> = variances.iter().enumerate().map(step).collect();
        constraints.push(tie(0, last, Pose2::new(last as f64 + error, 0.0, 0.0), diagonal(loop_variance, 1e-3, 1e-4)));
        let solved = solve(poses, &constraints).unwrap();
        let all: f64 = variances.iter().sum::<f64>() + loop_variance;
        let mut expected = 0.0;
        for (i, variance) in variances.iter().enumerate() {
            expected += 1.0 + error * variance / all;
            prop_assert!((solved[i + 1].x - expected).abs() < 1e-6, "{} against {expected}", solved[i + 1].x);
            prop_assert!(solved[i + 1].y.abs() < 1e-9 && solved[i + 1].theta.abs() < 1e-9);
        }
    }

    /// The frame is free: a moved graph has the moved solution, and the first pose stays.
    #[test]
    fn a_moved_graph_has_the_moved_solution(noise in any_noise(), x in -50.0..50.0_f64, y in -50.0..50.0_f64, theta in -3.0..3.0_f64) {
        let (poses, constraints) = circle(&noise);
        let by = Pose2::new(x, y, theta);
        let moved = solve(poses.iter().map(|pose| by * *pose).collect(), &constraints).unwrap();
        let plain = solve(poses.clone(), &constraints).unwrap();
        prop_assert!(plain[0].distance(&poses[0]) < 1e-9);
        for (moved, plain) in moved.iter().zip(&plain) {
            let expected = by * *plain;
            prop_assert!(moved.distance(&expected) < 1e-6 && wrap_angle(moved.theta - expected.theta).abs() < 1e-6);
        }
    }

    /// The solution minimises the cost, and the unit of the covariances does not matter.
    #[test]
    fn no_pose_near_the_solution_costs_less(
        noise in any_noise(), steps in prop::collection::vec(-0.01..0.01_f64, 27), scale in 0.1..10.0_f64,
    ) {
        let (poses, constraints) = circle(&noise);
        let solved = solve(poses.clone(), &constraints).unwrap();
        let nudged: Vec<Pose2> = solved.iter().enumerate().map(|(i, pose)| match i.checked_sub(1) {
            Some(k) => *pose * Pose2::new(steps[3 * k], steps[3 * k + 1], steps[3 * k + 2]),
            None => *pose,
        }).collect();
        prop_assert!(cost(&solved, &constraints) <= cost(&nudged, &constraints) + 1e-6);
        let scaled: Vec<Constraint> =
            constraints.iter().map(|c| Constraint { covariance: c.covariance * scale, ..*c }).collect();
        for (a, b) in solve(poses, &scaled).unwrap().iter().zip(&solved) {
            prop_assert!(a.distance(b) < 1e-6);
        }
    }

    /// A constraint says the same in both directions, up to the second order of its error.
    #[test]
    fn a_reversed_constraint_gives_the_same_solution(noise in any_noise(), which in prop::collection::vec(any::<bool>(), 10)) {
        let (poses, constraints) = circle(&noise);
        let turn = |(constraint, turned): (&Constraint, &bool)| if *turned { reversed(constraint) } else { *constraint };
        let turned: Vec<Constraint> = constraints.iter().zip(&which).map(turn).collect();
        let (a, b) = (solve(poses.clone(), &constraints).unwrap(), solve(poses, &turned).unwrap());
        for (a, b) in a.iter().zip(&b) {
            prop_assert!(a.distance(b) < 2e-3 && wrap_angle(a.theta - b.theta).abs() < 1e-3, "{a:?} {b:?}");
        }
    }
}

/// The covariance of a chain of measurements is that of sampled chains, whichever way each constraint runs.
#[test]
fn the_covariance_along_a_path_is_that_of_samples() {
    let truth = [
        Pose2::new(1.0, -2.0, 0.7),
        Pose2::new(2.5, -1.0, -1.1),
        Pose2::new(2.0, 1.5, 2.3),
        Pose2::new(-0.5, 1.0, 0.2),
    ];
    let sigmas = Vector3::new(0.02, 0.01, 0.008);
    let covariance = diagonal(sigmas.x * sigmas.x, sigmas.y * sigmas.y, sigmas.z * sigmas.z);
    let pairs = [(0, 1), (2, 1), (2, 3)];
    let constraints =
        pairs.map(|(i, j): (usize, usize)| tie(i, j, truth[i].inverse() * truth[j], covariance));
    let reached = reach(&truth, &constraints, 0)[3].unwrap();
    let mut rng = ParticleRng::new(5, 0, 0);
    let mut sum = Matrix3::zeros();
    const SAMPLE_COUNT: usize = 20_000;
    for _ in 0..SAMPLE_COUNT {
        let mut at = truth[0];
        for (k, constraint) in constraints.iter().enumerate() {
            let error = rng.normal3().component_mul(&sigmas);
            let measured = constraint.from_to * Pose2::exp(error);
            at = at * if k == 1 { measured.inverse() } else { measured };
        }
        let off = Vector3::new(at.x - truth[3].x, at.y - truth[3].y, wrap_angle(at.theta - truth[3].theta));
        sum += off * off.transpose();
    }
    let sampled = sum / SAMPLE_COUNT as f64;
    let error = (sampled - reached.covariance).norm();
    assert!(error < 0.04 * sampled.norm(), "{sampled} {}", reached.covariance);
    let length: f64 = truth.windows(2).map(|pair| pair[0].distance(&pair[1])).sum();
    assert!((reached.path_length - length).abs() < 1e-9);
}

/// A pose without a path has no uncertainty relative to the start; the start itself is certain.
#[test]
fn a_pose_without_a_path_is_not_reached() {
    let poses: Vec<Pose2> = (0..5).map(|i| Pose2::new(f64::from(i), 0.0, 0.0)).collect();
    let step = |i: usize| tie(i, i + 1, Pose2::new(1.0, 0.0, 0.0), diagonal(1e-3, 1e-3, 1e-4));
    let reached = reach(&poses, &[step(0), step(1), step(3)], 1);
    assert_eq!(reached.iter().map(Option::is_some).collect::<Vec<_>>(), [true, true, true, false, false]);
    let here = reached[1].unwrap();
    assert_eq!((here.covariance, here.path_length), (Matrix3::zeros(), 0.0));
}
