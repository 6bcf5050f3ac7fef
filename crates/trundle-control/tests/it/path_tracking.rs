//! Laws of the path-tracking controller.

use crate::plant::{DT, Plant};
use proptest::prelude::*;
use trundle_control::{PathTracker, PathTrackingConfig, TrackingError};
use trundle_core::{DifferentialDrive, DriveLimits, Pose2, TrajectoryPoint, Twist2};

/// Runs after a reference that moves with `twist_at(time)` from the origin; the error at each step.
fn track(mut plant: Plant, seconds: f64, twist_at: impl Fn(f64) -> Twist2) -> Vec<TrackingError> {
    let mut tracker =
        PathTracker::new(PathTrackingConfig::default(), DifferentialDrive::KOBUKI, DriveLimits::KOBUKI)
            .unwrap();
    tracker.sent(plant.twist());
    let mut reference = Pose2::IDENTITY;
    let steps = (seconds / DT) as usize;
    (0..steps)
        .map(|i| {
            let time = i as f64 * DT;
            let twist = twist_at(time);
            let estimate = plant.estimate();
            let report = tracker.step(&estimate, &TrajectoryPoint { time, pose: reference, twist }, DT);
            plant.drive(report.twist);
            reference = reference.advance(twist, DT);
            report.error
        })
        .collect()
}

fn straight(_: f64) -> Twist2 {
    Twist2::new(0.4, 0.0)
}

fn arc(_: f64) -> Twist2 {
    Twist2::new(0.35, 0.6)
}

fn s_curve(time: f64) -> Twist2 {
    Twist2::new(0.35, 0.7 * (0.8 * time).sin())
}

fn backward(_: f64) -> Twist2 {
    Twist2::new(-0.2, 0.1)
}

fn on_the_spot(_: f64) -> Twist2 {
    Twist2::new(0.0, 0.8)
}

fn last(errors: &[TrackingError]) -> TrackingError {
    *errors.last().unwrap()
}

/// The largest of the last second: distance m, heading rad.
fn tail(errors: &[TrackingError]) -> (f64, f64) {
    let tail = &errors[errors.len() - (1.0 / DT) as usize..];
    let max = |f: &dyn Fn(&TrackingError) -> f64| tail.iter().map(f).fold(0.0, f64::max);
    (max(&|e| e.distance()), max(&|e| e.heading.abs()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn moving_references_are_reached(
        (x, y, theta) in (-0.2..0.2, -0.2..0.2, -0.7..0.7),
        delay in 0.02..0.04,
    ) {
        for (name, twist_at) in [("straight", straight as fn(f64) -> Twist2), ("arc", arc), ("S", s_curve), ("backward", backward)] {
            let mut plant = Plant::at(Pose2::new(x, y, theta)).moving(Twist2::ZERO);
            plant.delay = delay;
            let (distance, heading) = tail(&track(plant, 15.0, twist_at));
            prop_assert!(distance < 0.02 && heading < 0.06, "{}: {} m, {} rad", name, distance, heading);
        }
    }
}

#[test]
fn a_lateral_error_decays_within_a_metre_of_path() {
    let start = Pose2::new(0.0, 0.10, 0.0);
    let errors = track(Plant::at(start).moving(straight(0.0)), 3.0, straight);
    let gone = errors.iter().position(|e| e.cross.abs() < 0.02).unwrap();
    let distance = gone as f64 * DT * 0.4;
    let overshoot = errors.iter().map(|e| e.cross).fold(0.0, f64::max);
    eprintln!("10 cm beside became 2 cm after {distance:.2} m, overshoot {:.1} mm", overshoot * 1e3);
    assert!(distance < 0.9 && overshoot < 0.005, "{distance} m, {overshoot} m");
}

#[test]
fn constant_twists_leave_no_error() {
    for twist_at in [straight as fn(f64) -> Twist2, arc, on_the_spot] {
        let error = last(&track(Plant::at(Pose2::IDENTITY), 12.0, twist_at));
        assert!(error.distance() < 0.003 && error.heading.abs() < 0.01, "{error:?}");
    }
}

#[test]
fn a_turn_on_the_spot_stays_on_the_spot() {
    let errors = track(Plant::at(Pose2::new(0.01, -0.01, 0.0)), 5.0, on_the_spot);
    assert!(errors.iter().all(|e| e.distance() < 0.02));
    assert!(last(&errors).heading.abs() < 0.01);
}
