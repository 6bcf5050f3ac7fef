//! Loop candidates along trajectories with known loops.

use crate::loop_closing::candidates::candidates;
use crate::pose_graph::{Constraint, RelativeUncertainty, reach};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use std::f64::consts::TAU;
use trundle_core::Pose2;

/// Laps of a circle of `circumference` m in steps of 0.5 m, with the path length up to each pose.
fn laps(circumference: f64, length: f64) -> (Vec<Pose2>, Vec<f64>) {
    let count = (length / 0.5) as usize;
    let radius = circumference / TAU;
    let pose = |i: usize| {
        let angle = 0.5 * i as f64 / radius;
        Pose2::new(radius * angle.cos(), radius * angle.sin(), angle + TAU / 4.0)
    };
    ((0..count).map(pose).collect(), (0..count).map(|i| 0.5 * i as f64).collect())
}

/// Constraints between successive poses with the same covariance.
fn odometry(poses: &[Pose2], variance: f64) -> Vec<Constraint> {
    let covariance = Matrix3::from_diagonal(&Vector3::new(variance, variance, 0.01 * variance));
    let step = |i: usize| Constraint {
        from: i as u32 - 1,
        to: i as u32,
        from_to: poses[i - 1].inverse() * poses[i],
        covariance,
    };
    (1..poses.len()).map(step).collect()
}

fn certain(count: usize) -> Vec<Option<RelativeUncertainty>> {
    let none = RelativeUncertainty { covariance: Matrix3::identity() * 1e-4, path_length: 0.0 };
    vec![Some(none); count]
}

proptest! {
    #[test]
    fn candidates_are_far_along_the_path_apart_and_sorted(circumference in 25.0..90.0_f64, laps_driven in 1.1..3.5_f64) {
        let (poses, lengths) = laps(circumference, circumference * laps_driven);
        let found = candidates(&poses, &lengths, &certain(poses.len()));
        prop_assert!(!found.is_empty(), "the robot is where it was a lap ago");
        let last = lengths[lengths.len() - 1];
        for candidate in &found {
            prop_assert!(candidate.range.contains(&candidate.nearest));
            prop_assert!(candidate.range.clone().all(|k| last - lengths[k] >= 20.0));
        }
        prop_assert!(found.windows(2).all(|pair| pair[0].distance <= pair[1].distance));
        let mut ranges: Vec<_> = found.iter().map(|c| c.range.clone()).collect();
        ranges.sort_by_key(|range| range.start);
        prop_assert!(ranges.windows(2).all(|pair| pair[0].end < pair[1].start));
        // The likeliest one is within sight.
        let off = poses[found[0].nearest].distance(&poses[poses.len() - 1]);
        prop_assert!(off < 1.0, "{off} m");
    }

    /// More uncertainty never removes a candidate pose.
    #[test]
    fn a_less_certain_robot_has_at_least_the_same_candidates(circumference in 25.0..90.0_f64, variance in 0.0..2.0_f64) {
        let (poses, lengths) = laps(circumference, 1.4 * circumference);
        let uncertain = RelativeUncertainty { covariance: Matrix3::identity() * (1e-4 + variance), path_length: 0.0 };
        let count = |reached: &[Option<RelativeUncertainty>]| -> usize {
            candidates(&poses, &lengths, reached).iter().map(|c| c.range.len()).sum()
        };
        prop_assert!(count(&vec![Some(uncertain); poses.len()]) >= count(&certain(poses.len())));
        prop_assert_eq!(count(&vec![None; poses.len()]), 0);
    }

    /// The covariance along a straight chain: positions add up, and the heading's error acts with its lever.
    #[test]
    fn the_uncertainty_of_a_straight_chain_is_the_sum_with_levers(count in 2..40_usize, variance in 1e-5..1e-2_f64) {
        let poses: Vec<Pose2> = (0..=count).map(|i| Pose2::new(i as f64, 0.0, 0.0)).collect();
        let reached = reach(&poses, &odometry(&poses, variance), 0);
        let end = reached[count].unwrap();
        let n = count as f64;
        let levers: f64 = (0..count).map(|k| (k as f64).powi(2)).sum();
        prop_assert!((end.covariance[(0, 0)] - n * variance).abs() < 1e-9);
        prop_assert!((end.covariance[(1, 1)] - variance * (n + 0.01 * levers)).abs() < 1e-9);
        prop_assert!((end.covariance[(2, 2)] - 0.01 * n * variance).abs() < 1e-9);
        prop_assert!((end.path_length - n).abs() < 1e-9);
    }

    /// Every covariance is symmetric and positive, and grows along the chain.
    #[test]
    fn uncertainty_grows_along_a_chain(circumference in 25.0..90.0_f64, variance in 1e-5..1e-2_f64, from in 0..40_usize) {
        let (poses, _) = laps(circumference, 20.5);
        let from = from.min(poses.len() - 1);
        let reached = reach(&poses, &odometry(&poses, variance), from);
        prop_assert_eq!(reached[from].unwrap().covariance, Matrix3::zeros());
        for (k, uncertainty) in reached.iter().enumerate().filter(|(k, _)| *k != from) {
            let covariance = uncertainty.unwrap().covariance;
            prop_assert!((covariance - covariance.transpose()).norm() < 1e-12);
            prop_assert!(covariance.symmetric_eigenvalues().min() > 0.0);
            let before = if k > from { k - 1 } else { k + 1 };
            let nearer = reached[before].unwrap().covariance;
            prop_assert!(covariance[(2, 2)] > nearer[(2, 2)]);
        }
    }
}

#[test]
fn a_pose_without_a_constraint_is_not_reached() {
    let (poses, _) = laps(40.0, 10.0);
    let mut constraints = odometry(&poses, 1e-4);
    constraints.remove(9);
    let reached = reach(&poses, &constraints, 0);
    assert!(reached[..10].iter().all(Option::is_some) && reached[10..].iter().all(Option::is_none));
}
