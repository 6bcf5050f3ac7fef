//! Odometry in addition to images: right odometry improves the pose, and wrong odometry does not degrade it.

use crate::points::{Dice, Room, camera, stamp};
use nalgebra::{Matrix6, Vector6};
use trundle_core::{CameraMotion, Pose3};
use trundle_slam::{RgbdSlam, SlamConfig};

/// A walk of 1.5 s with changing view directions.
fn walk(frame: usize) -> Pose3 {
    let t = frame as f64 / 90.0 * std::f64::consts::TAU;
    Pose3::exp(Vector6::new(0.5 * t.sin(), 0.0, 0.4 - 0.4 * t.cos(), 0.0, 0.6 * t.sin(), 0.0))
}

/// The mean error of the last pose over some runs, m, with this wheel reading for each true step.
fn error(reported: impl Fn(usize, Pose3) -> Option<CameraMotion>) -> f64 {
    const RUNS: u64 = 6;
    let room = Room::new();
    let of_run = |seed| {
        let mut slam = RgbdSlam::new(camera(), SlamConfig::default()).unwrap().starting_at(walk(0));
        let mut dice = Dice(seed + 1000);
        let mut step = |i: usize| {
            let motion = walk(i.saturating_sub(1)).inverse() * walk(i);
            let (features, depth) = room.seen_from(walk(i), &mut dice);
            slam.step_with_features(stamp(i), features, &depth, reported(i, motion)).visual_from_camera
        };
        let last = (0..=45).map(&mut step).last().unwrap();
        (walk(45).inverse() * last).translation.norm()
    };
    let mean = (0..RUNS).map(of_run).sum::<f64>() / RUNS as f64;
    println!("{:.2} mm", mean * 1e3);
    mean
}

fn exactly(motion: Pose3) -> CameraMotion {
    CameraMotion { motion, covariance: Some(Matrix6::zeros()) }
}

#[test]
fn right_odometry_improves_the_pose() {
    assert!(error(|_, motion| Some(exactly(motion))) < 0.8 * error(|_, _| None));
}

/// Dead encoders, or a pushed robot: the wheels report zero motion with high certainty.
#[test]
fn odometry_that_stands_still_does_not_hold_a_moving_camera() {
    assert!(error(|_, _| Some(exactly(Pose3::identity()))) < 1.5 * error(|_, _| None) + 1e-3);
}

/// Odometry that restarts at its origin: repeated steps that no wheeled robot can make.
#[test]
fn an_impossible_odometry_step_is_dropped() {
    let far = Pose3::exp(Vector6::new(3.0, 0.0, -2.0, 0.0, 1.0, 0.0));
    let jumping = error(|i, motion| Some(exactly(if i % 20 == 10 { far } else { motion })));
    assert!(jumping < 1.5 * error(|_, _| None) + 1e-3);
}
