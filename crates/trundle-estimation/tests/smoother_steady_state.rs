//! A smoother with a full window allocates no memory, and its step is fast.
#![allow(clippy::unwrap_used, reason = "tests")]
#![allow(clippy::print_stdout, reason = "the test reports a time")]

use nalgebra::{Matrix3, Matrix6};
use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};
use trundle_core::{DifferentialDrive, Pose2, Pose3, Stamp, Vector3};
use trundle_estimation::{
    MeasurementUse, MotionIncrement, OdometryConfig, PlanarMeasurement, Smoother, SmootherConfig, VisualPose,
    VisualQuality,
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

/// Measurements that solved the window, and the time of the fastest one.
#[derive(Default)]
struct Times {
    fastest: Option<Duration>,
    solved: u32,
}

fn drive(smoother: &mut Smoother, truth: &mut Pose2, steps: std::ops::Range<i64>) -> Times {
    let mut times = Times::default();
    for i in steps {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        let turn = 0.02 * (i as f64 * 0.02).sin();
        *truth = *truth * Pose2::exp(Vector3::new(0.008, 0.0, turn));
        smoother.add_motion(&MotionIncrement {
            stamp,
            dt: 0.02,
            left: 0.008 - 0.115 * turn,
            right: 0.008 + 0.115 * turn,
            turn_by_gyro: Some(turn + 1e-4),
            slip: 0.0,
            is_at_rest: false,
            unobserved: Matrix3::zeros(),
        });
        if i % 3 == 0 {
            let started = Instant::now();
            let used = smoother.add_visual(&VisualPose {
                stamp,
                visual_from_camera: Pose3::from_pose2(*truth),
                covariance: Matrix6::zeros(),
                quality: VisualQuality::Ok,
                map: 0,
                recognised: false,
            });
            times.add(used, started.elapsed());
        }
        if i % 10 == 0 {
            let started = Instant::now();
            let (pose, covariance) = (*truth, Matrix3::zeros());
            let used = smoother.add_scan(&PlanarMeasurement { stamp, pose, covariance });
            times.add(used, started.elapsed());
        }
    }
    times
}

impl Times {
    fn add(&mut self, used: MeasurementUse, time: Duration) {
        if matches!(used, MeasurementUse::Applied(_)) {
            self.fastest = Some(self.fastest.map_or(time, |fastest| fastest.min(time)));
            self.solved += 1;
        }
    }
}

/// Largest time of the fastest step in a test, without optimisation; others may wait for the processor. A release takes below 1 ms.
const MAX_FASTEST_STEP: Duration = Duration::from_millis(20);
/// Largest number of solutions of the window after a measurement, mean.
const MAX_SOLUTIONS: f64 = 2.0;

#[test]
fn a_full_window_allocates_nothing_and_is_solved_within_its_time() {
    let (config, odometry) = (SmootherConfig::default(), OdometryConfig::default());
    let mut smoother =
        Smoother::new(config.clone(), odometry, DifferentialDrive::KOBUKI, Pose3::identity()).unwrap();
    let mut truth = Pose2::IDENTITY;
    drive(&mut smoother, &mut truth, 1..1500);
    assert_eq!(smoother.keyframes().count(), config.window.max_keyframes, "the window is full");
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    let solutions = smoother.solutions();
    let times = drive(&mut smoother, &mut truth, 1500..2500);
    assert_eq!(ALLOCATIONS.load(Ordering::Relaxed), before);
    let solutions = (smoother.solutions() - solutions) as f64 / f64::from(times.solved);
    let (count, fastest) = (config.window.max_keyframes, times.fastest.unwrap());
    println!(
        "{} measurements at {count} keyframes: {solutions:.2} solutions each, fastest {fastest:?}",
        times.solved
    );
    assert!(times.solved > 100 && solutions < MAX_SOLUTIONS && fastest < MAX_FASTEST_STEP);
    assert!(smoother.estimate().pose.distance(&truth) < 0.02);
}
