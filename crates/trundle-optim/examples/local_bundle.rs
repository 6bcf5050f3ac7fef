//! Times a local bundle adjustment of the size that papers quote: 20 keyframes, 2000 points, 17,000 observations, 4 steps.
//!
//! `cargo run --release -p trundle-optim --example local_bundle [runs]` prints median and best of the runs (default 50) on
//! one thread. The problem is made once; the solver keeps its buffers.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a bench program")]

use nalgebra::Vector6;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::time::Instant;
use trundle_core::{Distortion, PinholeCamera, Pose3, Vector2, Vector3};
use trundle_optim::{
    BundleConfig, BundleObservation, BundlePose, BundleProblem, BundleSolver, InverseDepth, PointObservation,
};

const KEYFRAMES: usize = 20;
const POINTS: usize = 2000;
const OBSERVATIONS: usize = 17_000;

fn main() {
    let runs: usize = std::env::args().nth(1).map_or(50, |n| n.parse().unwrap());
    let problem = problem();
    // Exactly four steps, independent of the gain.
    let mut config = BundleConfig::default();
    config.steps = 4;
    config.converged = 1e-300;
    let mut solver = BundleSolver::default();
    let mut times: Vec<f64> = (0..runs)
        .map(|_| {
            let start = Instant::now();
            solver.begin(&problem, &config);
            solver.finish();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!(
        "{KEYFRAMES} keyframes, {POINTS} points, {OBSERVATIONS} observations, {} steps: median {:.2} ms, best {:.2} ms; \
         cost {:.0} to {:.0}",
        solver.steps(),
        times[runs / 2],
        times[0],
        solver.initial_cost(),
        solver.cost(),
    );
}

/// Cameras along an arc around a cloud of points, with a pixel of noise and a Kinect's depth; two cameras are fixed.
fn problem() -> BundleProblem {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let camera =
        PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), Distortion::default()).unwrap();
    let truth: Vec<Pose3> = (0..KEYFRAMES)
        .map(|i| i as f64 / KEYFRAMES as f64 - 0.5)
        .map(|t| Pose3::exp(Vector6::new(1.2 * t, 0.05 * t, 0.1 * t, 0.02, -0.4 * t, 0.0)))
        .collect();
    let mut noise = |scale: f64| scale * (rng.random_range(-1.7..1.7));
    let mut points = Vec::new();
    let mut observations = Vec::new();
    while points.len() < POINTS {
        let point = Vector3::new(noise(1.2), noise(0.9), 3.0 + noise(0.7));
        let first = points.len() * 7 % (KEYFRAMES - 8);
        // 8.5 keyframes in a row see each point.
        let seers = first..first + 8 + points.len() % 2;
        for pose in seers {
            let p = truth[pose].inverse().transform(point);
            let pixel = camera.project(p).unwrap() + Vector2::new(noise(1.0), noise(1.0));
            let depth = InverseDepth { value: 1.0 / p.z + noise(0.003), sigma: 0.003 };
            let seen = PointObservation { pixel, pixel_sigma: 1.0, depth: Some(depth) };
            observations.push(BundleObservation { pose, point: points.len(), seen });
        }
        points.push(point);
    }
    assert_eq!(observations.len(), OBSERVATIONS);
    let points =
        points.into_iter().map(|p| p + Vector3::new(noise(0.02), noise(0.02), noise(0.02))).collect();
    let poses = truth
        .iter()
        .enumerate()
        .map(|(i, pose)| {
            let off = Vector6::from_fn(|_, _| noise(0.01));
            let fixed = i < 2;
            let world_from_camera = if fixed { *pose } else { *pose * Pose3::exp(off) };
            BundlePose { world_from_camera, fixed }
        })
        .collect();
    BundleProblem::new(camera, poses, points, observations).unwrap()
}
