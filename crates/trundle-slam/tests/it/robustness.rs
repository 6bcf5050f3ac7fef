//! SLAM on empty, blank and repeated images.

use crate::room::{camera, shoot, stamp};
use nalgebra::Vector6;
use trundle_core::{ColorImage, DepthImage, Pose3, RgbdImage};
use trundle_slam::{RgbdSlam, SlamConfig, Tracking};

fn slam() -> RgbdSlam {
    RgbdSlam::new(camera(), SlamConfig::default()).unwrap()
}

fn forward(metres: f64) -> Pose3 {
    Pose3::exp(Vector6::new(0.0, 0.0, metres, 0.0, 0.0, 0.0))
}

fn image(number: usize, size: (usize, usize), shade: u8, depth: f32) -> RgbdImage {
    let color = ColorImage::filled(size.0, size.1, [shade; 3]);
    RgbdImage::new(stamp(number), color, DepthImage::filled(size.0, size.1, depth)).unwrap()
}

#[test]
fn empty_images_are_reported_and_survived() {
    let mut slam = slam();
    let depthless = RgbdImage::new(
        stamp(3),
        shoot(3, Pose3::identity()).color().clone(),
        DepthImage::filled(320, 240, 0.0),
    );
    let empty = [
        image(0, (320, 240), 0, 0.0),
        image(1, (320, 240), 255, 1.0),
        image(2, (320, 240), 90, f32::NAN),
        depthless.unwrap(),
        image(4, (17, 5), 90, 1.0),
    ];
    for blank in &empty {
        let report = slam.step(blank, None);
        assert_eq!((report.tracking, report.keyframes), (Tracking::Lost, 0));
        assert_eq!(report.visual_from_camera, Pose3::identity());
    }
    assert_eq!(slam.step(&shoot(5, Pose3::identity()), None).tracking, Tracking::Ok);
    for (i, blank) in empty.iter().enumerate() {
        let report = slam.step(blank, (i % 2 == 0).then(|| forward(0.01).into()));
        let expected = if i % 2 == 0 { Tracking::DeadReckoning } else { Tracking::Lost };
        // The image without depth is located by its landmarks.
        assert_eq!(report.tracking, if i == 3 { Tracking::Ok } else { expected }, "image {i}");
    }
    let report = slam.step(&shoot(11, Pose3::identity()), Some(Pose3::exp(Vector6::repeat(f64::NAN)).into()));
    assert!(report.tracking.is_located() && report.visual_from_camera.translation.norm() < 0.005);
}

#[test]
fn a_carried_camera_is_relocalized() {
    let mut slam = slam();
    for i in 0..30 {
        let pose = Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.0, i as f64 * 0.06, 0.0));
        assert!(slam.step(&shoot(i, pose), None).tracking.is_located());
    }
    for i in 40..45 {
        let report = slam.step(&image(i, (320, 240), 0, 0.0), None);
        assert_eq!(report.tracking, Tracking::Lost);
        assert!(report.covariance.trace() > 1e-3 * (i - 39) as f64, "uncertainty grows");
    }
    let set_down = Pose3::exp(Vector6::new(0.1, 0.0, 0.05, 0.0, 0.2, 0.0));
    let located = (45..50).find_map(|i| {
        let report = slam.step(&shoot(i, set_down), None);
        report.tracking.is_located().then_some(report)
    });
    let report = located.expect("found within five frames");
    assert!(report.relocalised, "the last view does not overlap");
    let error = set_down.inverse() * report.visual_from_camera;
    assert!(error.translation.norm() < 0.02 && error.angle() < 0.01, "{error:?}");
    assert_eq!(slam.trajectory().iter().filter(|(s, _)| *s >= stamp(40) && *s < stamp(45)).count(), 0);
}

#[test]
fn dead_reckoning_bridges_a_blank_wall_and_mapping_goes_on_behind_it() {
    let mut slam = slam();
    let step = |i: usize| Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.0, 0.1 * i as f64, 0.0));
    for i in 0..3 {
        slam.step(&shoot(i, step(i)), Some(step(1).into()));
    }
    for i in 3..20 {
        let report = slam.step(&image(i, (320, 240), 128, 1.0), Some(step(1).into()));
        assert_eq!(report.tracking, Tracking::DeadReckoning);
    }
    // A texture that repeats in two images is not noise.
    for (i, begins) in [(20, false), (21, true)] {
        let report = slam.step(&shoot(i, step(i)), Some(step(1).into()));
        assert_eq!((report.new_keyframe, report.tracking), (begins, Tracking::DeadReckoning));
    }
    let report = slam.step(&shoot(22, step(22)), Some(step(1).into()));
    assert_eq!(report.tracking, Tracking::Ok);
    let error = (step(22).inverse() * report.visual_from_camera).log().norm();
    assert!(error < 0.04, "{error}");
    assert_eq!(slam.trajectory().len(), 23);
}

/// A bare wall 1 m ahead: each image shows other noise of the camera.
fn noise(number: usize) -> RgbdImage {
    let mut state = number as u64 + 1;
    let mut pixel = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        [(state >> 56) as u8; 3]
    };
    let color = ColorImage::from_fn(320, 240, |_, _| pixel());
    RgbdImage::new(stamp(number), color, DepthImage::filled(320, 240, 1.0)).unwrap()
}

#[test]
fn noise_on_a_bare_wall_makes_no_map() {
    assert_eq!(slam().step(&noise(0), None).keyframes, 0, "noise has no corners");
    let mut config = SlamConfig::default();
    config.orb.min_texture = 0.0;
    let mut slam = RgbdSlam::new(camera(), config).unwrap();
    assert_eq!(slam.step(&shoot(0, Pose3::identity()), None).tracking, Tracking::Ok);
    let reported = || Some(forward(0.0).into());
    for i in 1..60 {
        let report = slam.step(&noise(i), reported());
        assert!(report.features > 100 && !report.new_keyframe, "frame {i}: {}", report.features);
        assert_eq!(report.tracking, Tracking::DeadReckoning);
    }
    assert_eq!(slam.step(&shoot(60, Pose3::identity()), reported()).tracking, Tracking::Ok);
}

#[test]
fn a_wrong_configuration_is_refused_by_name() {
    let mut config = SlamConfig::default();
    config.depth.sigma = -1.0;
    let error = RgbdSlam::new(camera(), config).unwrap_err();
    assert_eq!(error.field, "depth.sigma");
}
