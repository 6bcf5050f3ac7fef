//! Laws of the refinement of one pose.

use crate::support::{any_pose, camera, gap, seen_from};
use nalgebra::Matrix6;
use proptest::prelude::*;
use trundle_core::{Pose3, Vector3};
use trundle_optim::{InverseDepth, PointObservation, PoseConfig, PoseProblem, PoseSolution};

type Seen = Vec<(Vector3, PointObservation)>;

fn solved(observations: &Seen, start: Pose3, bounded: bool) -> PoseSolution {
    PoseProblem { camera: &camera(), observations, prior: None, bounded }.solve(start, &PoseConfig::default())
}

fn covariance(solution: &PoseSolution) -> Matrix6<f64> {
    solution.covariance.expect("the points determine the pose")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn the_pose_comes_back_in_every_world_frame(truth in any_pose(0.5), world in any_pose(1.5), off in any_pose(0.05)) {
        let observations = seen_from(truth, 80, 1.0, 3);
        let moved: Seen = observations.iter().map(|(point, seen)| (world.transform(*point), *seen)).collect();
        let (here, there) = (solved(&observations, truth * off, false), solved(&moved, world * truth * off, false));
        prop_assert!(gap(world * here.world_from_camera, there.world_from_camera) < 1e-6);
        prop_assert_eq!(&here.inliers, &there.inliers);
        prop_assert!((covariance(&here) - covariance(&there)).norm() < 1e-6 * covariance(&here).norm());
    }

    #[test]
    fn the_order_of_the_observations_does_not_matter(truth in any_pose(0.5), off in any_pose(0.05), bounded: bool) {
        let observations = seen_from(truth, 60, 1.0, 4);
        let reversed: Seen = observations.iter().rev().copied().collect();
        let (one, other) = (solved(&observations, truth * off, bounded), solved(&reversed, truth * off, bounded));
        prop_assert!(gap(one.world_from_camera, other.world_from_camera) < 1e-7);
        prop_assert!(one.inliers.iter().eq(other.inliers.iter().rev()));
    }

    #[test]
    fn the_start_does_not_matter_near_the_truth(truth in any_pose(0.5), a in any_pose(0.05), b in any_pose(0.05)) {
        let observations = seen_from(truth, 80, 0.5, 5);
        let (one, other) = (solved(&observations, truth * a, false), solved(&observations, truth * b, false));
        prop_assert!(gap(one.world_from_camera, other.world_from_camera) < 1e-5);
    }

    #[test]
    fn a_covariance_is_symmetric_and_positive_definite(truth in any_pose(0.5), bounded: bool) {
        let solution = solved(&seen_from(truth, 30, 1.0, 6), truth, bounded);
        let covariance = covariance(&solution);
        prop_assert!((covariance - covariance.transpose()).norm() < 1e-9 * covariance.norm());
        prop_assert!(covariance.symmetric_eigenvalues().min() > 0.0);
    }
}

#[test]
fn twice_the_standard_deviations_give_four_times_the_covariance() {
    let truth = Pose3::identity();
    let sharp = seen_from(truth, 60, 0.0, 7);
    let doubled = |seen: &PointObservation| {
        let depth = seen.depth.map(|depth| InverseDepth { sigma: 2.0 * depth.sigma, ..depth });
        PointObservation { pixel_sigma: 2.0 * seen.pixel_sigma, depth, ..*seen }
    };
    let blurred: Seen = sharp.iter().map(|(point, seen)| (*point, doubled(seen))).collect();
    let [one, four] = [sharp, blurred].map(|seen| covariance(&solved(&seen, truth, false)));
    assert!((one * 4.0 - four).norm() < 1e-6 * four.norm());
}

#[test]
fn more_points_make_the_pose_more_certain_in_every_direction() {
    let truth = Pose3::identity();
    let all = seen_from(truth, 80, 0.0, 8);
    let few = covariance(&solved(&all[..40].to_vec(), truth, false));
    let many = covariance(&solved(&all, truth, false));
    assert!((few - many).symmetric_eigenvalues().min() > 0.0);
}

#[test]
fn residuals_larger_than_promised_scale_the_covariance_up() {
    let truth = Pose3::identity();
    let variance = |noise: f64| covariance(&solved(&seen_from(truth, 200, noise, 9), truth, false)).trace();
    assert!(variance(1.5) > 1.2 * variance(0.0));
}

#[test]
fn without_observations_the_pose_comes_back_as_it_was_and_has_no_covariance() {
    let start = Pose3::exp(nalgebra::Vector6::new(0.1, 0.2, 0.3, 0.1, 0.2, 0.3));
    let solution = solved(&Vec::new(), start, true);
    assert!(gap(solution.world_from_camera, start) < 1e-15);
    assert_eq!((solution.covariance, solution.inlier_count, solution.inliers.len()), (None, 0, 0));
}

#[test]
fn two_points_without_depth_do_not_determine_a_pose() {
    let mut observations = seen_from(Pose3::identity(), 2, 0.0, 10);
    observations.iter_mut().for_each(|(_, seen)| seen.depth = None);
    let solution = solved(&observations, Pose3::identity(), false);
    assert!(solution.covariance.is_none_or(|covariance| covariance.trace() > 1.0));
}

#[test]
fn inliers_are_counted() {
    let mut observations = seen_from(Pose3::identity(), 50, 0.0, 11);
    observations[7].1.pixel.x += 40.0;
    observations[9].0.z += 1.0;
    let solution = solved(&observations, Pose3::identity(), false);
    assert_eq!((solution.inlier_count, solution.inliers[7], solution.inliers[9]), (48, false, false));
}

#[test]
fn settings_without_a_round_or_a_step_or_an_end_are_refused() {
    let text = |set: fn(&mut PoseConfig)| {
        let mut config = PoseConfig::default();
        set(&mut config);
        config.validated().unwrap_err().to_string()
    };
    assert_eq!(text(|c| c.rounds = 0), "pose.rounds is 0, expected 1 or more");
    assert_eq!(text(|c| c.steps = 0), "pose.steps is 0, expected 1 or more");
    assert_eq!(text(|c| c.converged = 0.0), "pose.converged is 0, expected a finite number above 0");
}
