//! Laws of pose graphs.

use crate::support::{any_pose, gap};
use nalgebra::{Matrix6, Vector6};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::Pose3;
use trundle_optim::{PoseConstraint, PoseGraph, PoseGraphConfig, PoseGraphSolution};

fn constraint(from: usize, to: usize, from_to: Pose3, weight: f64) -> PoseConstraint {
    PoseConstraint { from, to, from_to, information: Matrix6::identity() * weight }
}

/// A ring of twelve poses with slightly contradictory constraints, and a start near the solution.
fn ring() -> (Vec<Pose3>, Vec<PoseConstraint>) {
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    let mut shake = |size: f64| Pose3::exp(Vector6::from_fn(|_, _| rng.random_range(-size..size)));
    let truth: Vec<Pose3> = (0..12)
        .map(|i| f64::from(i) * std::f64::consts::TAU / 12.0)
        .map(|t| Pose3::from_pose2(trundle_core::Pose2::new(2.0 * t.cos(), 2.0 * t.sin(), t)))
        .collect();
    let step = |i: usize, error: Pose3| {
        let j = (i + 1) % 12;
        constraint(i, j, truth[i].inverse() * truth[j] * error, 1.0 + i as f64)
    };
    let constraints = (0..12).map(|i| step(i, shake(0.02))).collect();
    let start =
        truth.iter().enumerate().map(|(i, pose)| if i == 0 { *pose } else { *pose * shake(0.1) }).collect();
    (start, constraints)
}

fn first_fixed(count: usize) -> Vec<bool> {
    (0..count).map(|i| i == 0).collect()
}

fn solved(start: Vec<Pose3>, constraints: Vec<PoseConstraint>) -> PoseGraphSolution {
    let mut config = PoseGraphConfig::default();
    config.steps = 50;
    config.converged = 1e-12;
    let fixed = first_fixed(start.len());
    PoseGraph::new(start, &fixed, constraints).unwrap().solve(&config)
}

fn largest_gap(a: &[Pose3], b: &[Pose3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| gap(*a, *b)).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    #[test]
    fn a_graph_has_the_same_solution_in_every_world_frame(world in any_pose(1.5)) {
        let (start, constraints) = ring();
        let moved = start.iter().map(|pose| world * *pose).collect();
        let (here, there) = (solved(start, constraints.clone()), solved(moved, constraints));
        let carried: Vec<Pose3> = here.poses.iter().map(|pose| world * *pose).collect();
        prop_assert!(largest_gap(&carried, &there.poses) < 1e-6);
        prop_assert!((here.final_cost - there.final_cost).abs() < 1e-9);
    }

    #[test]
    fn common_weights_scale_the_cost_and_leave_the_poses(weight in 0.01..100.0_f64) {
        let (start, constraints) = ring();
        let heavy = constraints.iter().map(|c| PoseConstraint { information: c.information * weight, ..c.clone() }).collect();
        let (one, other) = (solved(start.clone(), constraints), solved(start, heavy));
        prop_assert!(largest_gap(&one.poses, &other.poses) < 1e-5);
        prop_assert!((one.final_cost * weight - other.final_cost).abs() < 1e-6 * other.final_cost);
    }
}

#[test]
fn the_order_of_the_constraints_does_not_matter() {
    let (start, constraints) = ring();
    let reversed = constraints.iter().rev().cloned().collect();
    let (one, other) = (solved(start.clone(), constraints), solved(start, reversed));
    assert!(largest_gap(&one.poses, &other.poses) < 1e-6);
    assert!(one.chi2.iter().zip(other.chi2.iter().rev()).all(|(a, b)| (a - b).abs() < 1e-6));
}

#[test]
fn a_constraint_may_be_stated_from_either_of_its_poses() {
    let (start, constraints) = ring();
    // A right perturbation x of from_to is the right perturbation -adjoint x of its inverse.
    let turned = constraints.iter().map(|c| {
        let back = c.from_to.inverse().adjoint();
        let information = back.transpose() * c.information * back;
        PoseConstraint { from: c.to, to: c.from, from_to: c.from_to.inverse(), information }
    });
    let (one, other) = (solved(start.clone(), constraints.clone()), solved(start, turned.collect()));
    assert!(largest_gap(&one.poses, &other.poses) < 1e-3, "{}", largest_gap(&one.poses, &other.poses));
}

#[test]
fn the_cost_falls_and_is_the_sum_of_the_squared_residuals() {
    let (start, constraints) = ring();
    let solution = solved(start, constraints);
    assert!(solution.final_cost < 0.1 * solution.initial_cost && solution.final_cost > 0.0);
    assert!((solution.chi2.iter().sum::<f64>() - solution.final_cost).abs() < 1e-12);
    assert!(solution.steps > 1 && solution.steps <= 50);
}

#[test]
fn two_measurements_of_one_pose_are_averaged_by_their_weights() {
    let at = |x: f64| Pose3::exp(Vector6::new(x, 0.0, 0.0, 0.0, 0.0, 0.0));
    let constraints = vec![constraint(0, 1, at(1.0), 1.0), constraint(0, 1, at(2.0), 3.0)];
    let solution = solved(vec![Pose3::identity(); 2], constraints);
    assert!((solution.poses[1].translation.x - 1.75).abs() < 1e-9);
}

#[test]
fn the_more_certain_constraint_is_met_more_closely() {
    let (start, mut constraints) = ring();
    let residual = |constraints: &[PoseConstraint]| {
        let poses = solved(start.clone(), constraints.to_vec()).poses;
        gap(constraints[4].from_to, poses[4].inverse() * poses[5])
    };
    let before = residual(&constraints);
    constraints[4].information *= 1e4;
    assert!(residual(&constraints) < 0.01 * before);
}

#[test]
fn fixed_poses_and_poses_without_constraints_stay() {
    let (mut start, constraints) = ring();
    start.push(Pose3::exp(Vector6::repeat(0.3)));
    let mut fixed = first_fixed(13);
    fixed[6] = true;
    let solution =
        PoseGraph::new(start.clone(), &fixed, constraints).unwrap().solve(&PoseGraphConfig::default());
    assert_eq!((solution.poses[0], solution.poses[6]), (start[0], start[6]));
    assert!(gap(solution.poses[12], start[12]) < 1e-12);
}

#[test]
fn the_same_graph_gives_the_same_bits() {
    let (start, constraints) = ring();
    assert_eq!(solved(start.clone(), constraints.clone()), solved(start, constraints));
}

#[test]
fn graphs_and_settings_that_are_not_valid_are_refused() {
    let refused = |poses: Vec<Pose3>, constraints| {
        let fixed = first_fixed(poses.len());
        PoseGraph::new(poses, &fixed, constraints).unwrap_err().to_string()
    };
    let nowhere = Pose3::new(Default::default(), trundle_core::Vector3::new(f64::NAN, 0.0, 0.0));
    let two = vec![Pose3::identity(); 2];
    assert_eq!(
        refused(vec![Pose3::identity(), nowhere], vec![]),
        "pose 1 of the graph is not finite, expected finite numbers"
    );
    let missing = vec![constraint(0, 2, Pose3::identity(), 1.0)];
    assert_eq!(
        refused(two.clone(), missing),
        "constraint 0 of the graph is from 0 to 2, expected two poses below 2"
    );
    let bad = vec![constraint(0, 1, nowhere, 1.0)];
    assert_eq!(refused(two.clone(), bad), "constraint 0 of the graph is not finite, expected finite numbers");
    assert!(refused(two, vec![constraint(0, 1, Pose3::identity(), f64::INFINITY)]).contains("not finite"));
    let text = |set: fn(&mut PoseGraphConfig)| {
        let mut config = PoseGraphConfig::default();
        set(&mut config);
        config.validated().unwrap_err().to_string()
    };
    assert_eq!(text(|c| c.steps = 0), "pose_graph.steps is 0, expected 1 or more");
    assert!(text(|c| c.converged = f64::NAN).starts_with("pose_graph.converged is NaN"));
    assert!(text(|c| c.damping = -1.0).starts_with("pose_graph.damping is -1"));
}
