//! A bundle solver with buffers of a problem's size allocates no memory for the next problem of that size.
#![allow(clippy::unwrap_used, reason = "tests")]

use nalgebra::Vector6;
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use trundle_core::{PinholeCamera, Pose3, Vector3};
use trundle_optim::{
    BundleConfig, BundleObservation, BundlePose, BundleProblem, BundleSolver, PointObservation,
};

struct Counting;

static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is handed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn problem() -> BundleProblem {
    let camera = PinholeCamera::kinect_v1();
    let pose = |i: usize| Pose3::exp(Vector6::new(0.1 * i as f64, 0.0, 0.0, 0.0, 0.0, 0.0));
    let point = |i: usize| Vector3::new((i % 7) as f64 * 0.2 - 0.6, (i % 5) as f64 * 0.2 - 0.4, 2.0);
    let mut observations = Vec::new();
    for i in 0..8 {
        for j in 0..50 {
            let pixel = camera.project(pose(i).inverse().transform(point(j))).unwrap();
            let seen = PointObservation { pixel, pixel_sigma: 1.0, depth: None };
            observations.push(BundleObservation { pose: i, point: j, seen });
        }
    }
    let off = Pose3::exp(Vector6::repeat(0.01));
    let poses = (0..8)
        .map(|i| BundlePose { world_from_camera: if i < 2 { pose(i) } else { pose(i) * off }, fixed: i < 2 })
        .collect();
    BundleProblem::new(camera, poses, (0..50).map(point).collect(), observations).unwrap()
}

#[test]
fn a_grown_solver_allocates_nothing() {
    let (problem, config) = (problem(), BundleConfig::default());
    let mut solver = BundleSolver::default();
    solver.begin(&problem, &config);
    solver.finish();
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    solver.begin(&problem, &config);
    solver.finish();
    assert_eq!(ALLOCATIONS.load(Ordering::Relaxed), before);
    assert!(solver.steps() > 1 && solver.cost() < 1e-3 * solver.initial_cost());
}
