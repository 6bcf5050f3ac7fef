//! Laws of bundle adjustment.

use crate::support::{camera, gap, normal};
use nalgebra::Vector6;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{Pose3, Vector2, Vector3};
use trundle_optim::{
    BundleConfig, BundleObservation, BundlePose, BundleProblem, InverseDepth, PointObservation,
};

fn exact() -> BundleConfig {
    let mut config = BundleConfig::default();
    config.steps = 40;
    config.converged = 1e-12;
    config.damping = 1e-4;
    config.covariances = false;
    config
}

#[derive(Clone)]
struct Scene {
    poses: Vec<BundlePose>,
    points: Vec<Vector3>,
    observations: Vec<BundleObservation>,
}

/// Five cameras in a row before 60 points; the first two fixed. `noise`: of pixels and depths in standard deviations; `off`: error of the
/// start, m and rad.
fn scene(noise: f64, off: f64) -> Scene {
    let mut rng = ChaCha8Rng::seed_from_u64(31);
    let truth = |i: usize| Pose3::exp(Vector6::new(0.15 * i as f64, 0.0, 0.0, 0.0, -0.04 * i as f64, 0.0));
    let mut points = Vec::new();
    for _ in 0..60 {
        let mut coordinate = |a: f64, b: f64| rng.random_range(a..b);
        points.push(Vector3::new(coordinate(-0.8, 1.4), coordinate(-0.7, 0.7), coordinate(1.5, 4.0)));
    }
    let mut observations = Vec::new();
    for pose in 0..5 {
        for (j, point) in points.iter().enumerate() {
            let p = truth(pose).inverse().transform(*point);
            let pixel =
                camera().project(p).unwrap() + Vector2::new(normal(&mut rng), normal(&mut rng)) * noise;
            let depth =
                Some(InverseDepth { value: 1.0 / p.z + 0.003 * noise * normal(&mut rng), sigma: 0.003 });
            observations.push(BundleObservation {
                pose,
                point: j,
                seen: PointObservation { pixel, pixel_sigma: 1.0, depth },
            });
        }
    }
    let mut shake = || Vector6::from_fn(|_, _| rng.random_range(-1.0..1.0) * off);
    let pose = |i: usize, xi: Vector6<f64>| {
        let world_from_camera = if i < 2 { truth(i) } else { truth(i) * Pose3::exp(xi) };
        BundlePose { world_from_camera, fixed: i < 2 }
    };
    let poses = (0..5).map(|i| pose(i, shake())).collect();
    Scene { poses, points, observations }
}

fn problem(scene: &Scene) -> BundleProblem {
    let Scene { poses, points, observations } = scene.clone();
    BundleProblem::new(camera(), poses, points, observations).unwrap()
}

fn largest_gap(a: &[Pose3], b: &[Pose3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| gap(*a, *b)).fold(0.0, f64::max)
}

#[test]
fn a_bundle_has_the_same_solution_in_every_world_frame() {
    let world = Pose3::exp(Vector6::new(3.0, -1.0, 2.0, 0.4, 1.0, -0.7));
    let here = scene(1.0, 0.03);
    let mut there = here.clone();
    there.poses.iter_mut().for_each(|pose| pose.world_from_camera = world * pose.world_from_camera);
    there.points.iter_mut().for_each(|point| *point = world.transform(*point));
    let (one, other) = (problem(&here).solve(&exact()), problem(&there).solve(&exact()));
    let carried: Vec<Pose3> = one.poses.iter().map(|pose| world * *pose).collect();
    assert!(largest_gap(&carried, &other.poses) < 1e-6);
    assert!((one.final_cost - other.final_cost).abs() < 1e-6 * one.final_cost);
}

#[test]
fn the_order_of_the_observations_changes_the_order_of_the_residuals_only() {
    let forward = scene(1.0, 0.03);
    let mut backward = forward.clone();
    backward.observations.reverse();
    let (one, other) = (problem(&forward).solve(&exact()), problem(&backward).solve(&exact()));
    assert!(largest_gap(&one.poses, &other.poses) < 1e-6);
    assert!(one.chi2.iter().zip(other.chi2.iter().rev()).all(|(a, b)| (a - b).abs() < 1e-4 * (1.0 + a)));
}

#[test]
fn the_cost_never_rises_with_more_steps() {
    let start = scene(1.0, 0.03);
    let cost = |steps| {
        let mut config = exact();
        config.steps = steps;
        problem(&start).solve(&config).final_cost
    };
    let costs: Vec<f64> = (1..8).map(cost).collect();
    assert!(costs.windows(2).all(|pair| pair[1] <= pair[0]), "{costs:?}");
    assert!(costs[6] < 0.5 * costs[0] || costs[0] < 1000.0, "{costs:?}");
}

#[test]
fn an_exact_start_stays_where_it_is() {
    let exact = scene(0.0, 0.0);
    let solution = problem(&exact).solve(&BundleConfig::default());
    assert!(solution.initial_cost < 1e-9 && solution.final_cost <= solution.initial_cost);
    let start: Vec<Pose3> = exact.poses.iter().map(|pose| pose.world_from_camera).collect();
    assert!(largest_gap(&solution.poses, &start) < 1e-9);
}

#[test]
fn with_every_pose_fixed_only_the_points_move() {
    let mut fixed = scene(0.0, 0.0);
    fixed.poses.iter_mut().for_each(|pose| pose.fixed = true);
    let truth = fixed.points.clone();
    fixed.points.iter_mut().for_each(|point| *point += Vector3::new(0.03, -0.02, 0.05));
    let solution = problem(&fixed).solve(&exact());
    assert!(solution.poses.iter().zip(&fixed.poses).all(|(found, pose)| *found == pose.world_from_camera));
    assert!(solution.points.iter().zip(&truth).all(|(found, truth)| (found - truth).norm() < 1e-6));
}

#[test]
fn the_residuals_are_those_of_the_solution() {
    let start = scene(1.0, 0.03);
    let solution = problem(&start).solve(&exact());
    for (seen, chi2) in start.observations.iter().zip(&solution.chi2) {
        let p_camera = solution.poses[seen.pose].inverse().transform(solution.points[seen.point]);
        assert!((seen.seen.chi2(&camera(), p_camera) - chi2).abs() < 1e-6 * (1.0 + chi2));
    }
}

#[test]
fn problems_and_settings_that_are_not_valid_are_refused() {
    let good = scene(0.0, 0.0);
    let refused = |change: fn(&mut Scene)| {
        let mut bad = good.clone();
        change(&mut bad);
        BundleProblem::new(camera(), bad.poses, bad.points, bad.observations).unwrap_err().to_string()
    };
    let pose = refused(|bad| bad.observations[0].pose = 5);
    assert_eq!(pose, "observation is pose 5, point 0, expected less than 5 and 60");
    let point = refused(|bad| bad.observations[0].point = 60);
    assert_eq!(point, "observation is pose 0, point 60, expected less than 5 and 60");
    let parts = problem(&good).with_parts(vec![0; 4]).unwrap_err().to_string();
    assert_eq!(parts, "parts is 4, expected 5, one per pose");
    let text = |set: fn(&mut BundleConfig)| {
        let mut config = exact();
        set(&mut config);
        config.validated().unwrap_err().to_string()
    };
    assert_eq!(text(|c| c.steps = 0), "bundle.steps is 0, expected 1 or more");
    assert!(text(|c| c.converged = 0.0).starts_with("bundle.converged is 0"));
    assert!(text(|c| c.damping = f64::NAN).starts_with("bundle.damping is NaN"));
}
