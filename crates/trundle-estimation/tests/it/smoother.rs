//! The smoother on simulated drives: consistency, darkness, faults, recognised places, the marginalised window.

#![allow(clippy::print_stdout, reason = "the tests report statistics")]

use crate::drive::Drive;
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Pose2, Pose3};
use trundle_estimation::{MeasurementUse, SmootherConfig, VisualAnchor, VisualPose, WindowConfig};

/// A window of this length with keyframes 0.1 m apart.
fn windowed(length: f64, max_keyframes: usize) -> SmootherConfig {
    let (keyframe_distance, keyframe_turn_deg) = (0.1, 10.0);
    let mut window = WindowConfig::default();
    window.length = length;
    window.max_keyframes = max_keyframes;
    window.keyframe_distance = keyframe_distance;
    window.keyframe_turn_deg = keyframe_turn_deg;
    let mut config = SmootherConfig::default();
    config.window = window;
    config
}

fn config() -> SmootherConfig {
    windowed(10.0, 100)
}

/// Half of the 99.9 % band of the mean of `runs` normalised squared errors with three degrees of freedom, by the normal limit.
fn band(runs: usize) -> f64 {
    3.29 * (6.0 / runs as f64).sqrt()
}

#[test]
fn the_squared_error_is_inside_its_band_before_in_and_after_darkness() {
    const RUNS: usize = 200;
    let (mut sums, mut innovations) = ([0.0; 3], (0.0, 0.0));
    for seed in 0..RUNS as u64 {
        let mut drive = Drive::new(seed, config());
        drive.go(15.0);
        sums[0] += drive.nees();
        drive.is_lit = false;
        drive.go(5.0 + 55.0 * seed as f64 / RUNS as f64);
        sums[1] += drive.nees();
        drive.is_lit = true;
        drive.go(5.0);
        sums[2] += drive.nees();
        assert_eq!(drive.smoother.failures(), 0);
        innovations = (innovations.0 + drive.innovations.0, innovations.1 + drive.innovations.1);
    }
    let mean = innovations.0 / innovations.1;
    println!("mean squared innovation of {} visual poses: {mean:.2}", innovations.1);
    assert!((mean - 3.0).abs() < 0.3, "{mean:.2}");
    for (sum, when) in sums.iter().zip(["in light", "after 5 to 60 s of darkness", "in light again"]) {
        let mean = sum / RUNS as f64;
        println!("mean squared error {when}: {mean:.2}");
        assert!((mean - 3.0).abs() < band(RUNS), "{when}: {mean:.2} of 3 degrees of freedom");
    }
}

#[test]
fn calibration_is_found_with_its_sigmas() {
    const RUNS: usize = 40;
    let mut sums = [0.0; 4];
    for seed in 0..RUNS as u64 {
        let mut drive = Drive::new(1000 + seed, config());
        drive.go(60.0);
        let (found, truth) = (drive.smoother.calibration().unwrap(), drive.calibration);
        let pairs = [
            (found.gyro_bias, truth.bias),
            (found.gyro_scale, truth.scale),
            (found.left_radius, truth.left),
            (found.right_radius, truth.right),
        ];
        for (sum, (found, truth)) in sums.iter_mut().zip(pairs) {
            *sum += ((found.value - truth) / found.sigma).powi(2);
        }
        assert!(found.left_radius.sigma < 0.01, "of a prior of 0.02: {}", found.left_radius.sigma);
    }
    for (sum, name) in sums.iter().zip(["bias", "scale", "left radius", "right radius"]) {
        let mean = sum / RUNS as f64;
        println!("mean squared error of the {name}: {mean:.2}");
        assert!(mean < 1.0 + 3.29 * (2.0 / RUNS as f64).sqrt(), "{name}: {mean:.2} of 1 degree of freedom");
    }
}

#[test]
fn a_marginalised_window_agrees_with_the_full_batch() {
    let run = |window: f64| {
        let mut drive = Drive::new(3, windowed(window, 400));
        drive.go(25.0);
        (drive.smoother.estimate(), drive.smoother.keyframes().count())
    };
    let ((short, few), (full, many)) = (run(3.0), run(60.0));
    assert!(many > 4 * few, "{few} and {many} keyframes");
    let off = (full.pose.inverse() * short.pose).log();
    for i in 0..3 {
        let sigma = full.covariance[(i, i)].sqrt();
        assert!(off[i].abs() < 0.05 * sigma, "unknown {i}: {} of {sigma}", off[i]);
        let ratio = short.covariance[(i, i)].sqrt() / sigma;
        assert!((ratio - 1.0).abs() < 0.02, "sigma {i}: {ratio}");
    }
}

/// A visual pose of a recognised place, off by `error`.
fn recognised(drive: &Drive, error: Vector3<f64>) -> VisualPose {
    VisualPose { recognised: true, ..drive.visual_at(drive.truth, error) }
}

#[test]
fn a_wrong_place_is_switched_off_and_a_right_one_kept() {
    let mut drive = Drive::new(5, config());
    drive.go(10.0);
    let before = drive.smoother.estimate();
    // A look-alike place rotated by half a turn: the truth moved by a constant motion.
    let elsewhere = Pose2::new(2.9, 0.4, 2.8);
    let wrong = VisualPose { recognised: true, ..drive.visual_at(elsewhere * drive.truth, Vector3::zeros()) };
    let MeasurementUse::Switched { weight, innovation } = drive.smoother.add_visual(&wrong) else { panic!() };
    assert!(weight < 1e-3 && innovation.log_likelihood_ratio < -10.0, "{weight} {innovation:?}");
    let after = drive.smoother.estimate();
    assert!(
        after.pose.distance(&before.pose) < 0.01,
        "the belief stays: {}",
        after.pose.distance(&before.pose)
    );
    drive.is_lit = false;
    for _ in 0..100 {
        let step = drive.moved(0.3, 0.2);
        drive.smoother.add_motion(&step);
        let visual = drive.visual_at(elsewhere * drive.truth, Vector3::zeros());
        drive.smoother.add_visual(&visual);
    }
    assert!(drive.error() < 0.1, "poses in the wrong place do not pull: {}", drive.error());
    let right = recognised(&drive, Vector3::zeros());
    let MeasurementUse::Switched { weight, .. } = drive.smoother.add_visual(&right) else { panic!() };
    assert!(weight > 0.99, "{weight}");
    assert!(drive.error() < 0.05, "{}", drive.error());
}

#[test]
fn a_right_place_after_a_dark_minute_is_taken() {
    let mut drive = Drive::new(8, config());
    drive.go(10.0);
    drive.is_lit = false;
    drive.go(60.0);
    let dark = drive.smoother.estimate().covariance;
    let right = recognised(&drive, Vector3::zeros());
    let MeasurementUse::Switched { weight, .. } = drive.smoother.add_visual(&right) else { panic!() };
    let lit = drive.smoother.estimate().covariance;
    assert!(weight > 0.95, "{weight}");
    assert!(drive.error() < 0.05 && lit[(0, 0)] < 0.2 * dark[(0, 0)], "{}", drive.error());
}

#[test]
fn stuck_encoders_and_slipping_wheels_widen_the_estimate() {
    let mut drive = Drive::new(9, config());
    drive.go(10.0);
    drive.is_lit = false;
    let sigma = |drive: &Drive| drive.smoother.estimate().covariance[(0, 0)].sqrt();
    let before = sigma(&drive);
    for _ in 0..100 {
        let mut step = drive.moved(0.3, 0.0);
        (step.left, step.right) = (0.0, 0.0);
        // 0.3 m/s commanded and not counted, as the check of the wheels reports it.
        step.unobserved = Matrix3::from_diagonal(&Vector3::new(0.3 * 0.3 * 2.0 * 0.02, 1e-4, 0.0));
        drive.smoother.add_motion(&step);
    }
    assert!(drive.error() > 0.5 && drive.nees() < 11.3, "{} m, {}", drive.error(), drive.nees());
    let stuck = sigma(&drive);
    assert!(stuck > 10.0 * before);
    for _ in 0..50 {
        let mut step = drive.moved(0.1, 0.0);
        // The left wheel spins: wheels and gyro differ by 1 rad/s.
        step.left += 0.23 * 0.02;
        step.slip = 0.115 * 0.02;
        drive.smoother.add_motion(&step);
    }
    assert!(drive.nees() < 11.3, "{}", drive.nees());
    drive.is_lit = true;
    drive.go(3.0);
    assert!(drive.error() < 0.05, "the camera corrects it: {}", drive.error());
}

#[test]
fn a_late_image_has_nearly_the_effect_of_a_timely_one() {
    let run = |late: i64| {
        let mut drive = Drive::new(12, config());
        drive.go(8.0);
        drive.is_lit = false;
        drive.go(4.0);
        let scan = drive.scan();
        let mut waiting = Some(scan);
        for i in 0..100 {
            let step = drive.moved(0.3, 0.4);
            drive.smoother.add_motion(&step);
            if i == late {
                let used = drive.smoother.add_scan(&waiting.take().unwrap());
                assert!(matches!(used, MeasurementUse::Applied(_)), "{used:?}");
            }
        }
        drive.smoother.estimate()
    };
    let (timely, late) = (run(0), run(95));
    let off = (timely.pose.inverse() * late.pose).log();
    for i in 0..3 {
        let sigma = timely.covariance[(i, i)].sqrt();
        assert!(off[i].abs() < 0.05 * sigma, "unknown {i}: {} of {sigma}", off[i]);
        assert!((late.covariance[(i, i)].sqrt() / sigma - 1.0).abs() < 0.05);
    }
}

#[test]
fn bad_input_changes_nothing() {
    let mut drive = Drive::new(2, config());
    assert_eq!(
        drive.smoother.add_visual(&drive.visual_at(Pose2::IDENTITY, Vector3::zeros())),
        MeasurementUse::NoMotion
    );
    drive.go(5.0);
    let before = drive.smoother.estimate();
    let mut step = drive.moved(0.0, 0.0);
    step.left = f64::NAN;
    assert!(!drive.smoother.add_motion(&step));
    let mut visual = drive.visual_at(drive.truth, Vector3::zeros());
    visual.covariance[(0, 0)] = f64::INFINITY;
    assert_eq!(drive.smoother.add_visual(&visual), MeasurementUse::Invalid);
    let mut scan = drive.scan();
    scan.covariance[(1, 1)] = -1.0;
    assert_eq!(drive.smoother.add_scan(&scan), MeasurementUse::Invalid);
    scan.covariance = Matrix3::zeros();
    scan.stamp = drive.now().after(-100.0);
    assert!(matches!(drive.smoother.add_scan(&scan), MeasurementUse::TooOld { .. }));
    scan.stamp = drive.now().after(1.0);
    assert!(matches!(drive.smoother.add_scan(&scan), MeasurementUse::TooNew { .. }));
    assert_eq!(drive.smoother.estimate(), before);
}

#[test]
fn the_same_drive_gives_the_same_bits() {
    let run = || {
        let mut drive = Drive::new(4, config());
        drive.go(12.0);
        drive.smoother.estimate()
    };
    assert_eq!(run(), run());
}

#[test]
fn a_resumed_smoother_takes_a_place_far_from_where_it_starts() {
    let mut drive = Drive::new(7, config());
    let here = Pose2::new(6.0, -3.0, 2.5);
    let anchor = VisualAnchor { map_from_visual: Pose3::identity(), covariance: [[0.0; 3]; 3] };
    drive.smoother = drive.smoother.clone().resumed(&[(0, anchor)].into());
    drive.truth = here;
    drive.is_lit = false;
    drive.go(3.0);
    let place = VisualPose { recognised: true, ..drive.visual_at(drive.truth, Vector3::zeros()) };
    let MeasurementUse::Switched { weight, .. } = drive.smoother.add_visual(&place) else { panic!() };
    assert!(weight > 0.9 && drive.error() < 0.03, "{weight} {}", drive.error());
    drive.is_lit = true;
    drive.go(3.0);
    assert!(drive.error() < 0.06 && drive.smoother.failures() == 0, "{}", drive.error());
}
