//! Wrong settings are reported within the first 100 frames, and right ones are not.

use crate::freiburg;
use crate::room::{Clean, camera};
use nalgebra::Vector6;
use trundle_core::{ColorImage, DepthImage, Distortion, PinholeCamera, Pose3, RgbdImage, Vector2, Vector3};
use trundle_slam::{CalibrationIssue, RgbdSlam, SlamConfig};

/// Suspected settings after the first 100 frames of freiburg1_rpy, changed by `change`, with `camera` as the given calibration;
/// `None` if the data set is missing.
fn suspected(
    camera: PinholeCamera,
    change: impl Fn(RgbdImage) -> RgbdImage,
) -> Option<Vec<CalibrationIssue>> {
    let frames = freiburg::frames(100)?;
    let mut slam = RgbdSlam::new(camera, SlamConfig::default()).unwrap();
    for image in frames {
        slam.step(&change(image), None);
    }
    println!("{:?}", slam.calibration_issues());
    Some(slam.calibration_issues())
}

fn with_depth(image: &RgbdImage, depth: DepthImage) -> RgbdImage {
    RgbdImage::new(image.stamp(), image.color().clone(), depth).unwrap()
}

fn scaled(image: &RgbdImage, by: f32) -> RgbdImage {
    let depth = image.depth();
    with_depth(image, DepthImage::from_fn(depth.width(), depth.height(), |x, y| by * depth[(x, y)]))
}

/// The depth image in the view of the depth camera of a Kinect v1: 2.5 cm beside the colour camera, with a longer focal length.
fn unregistered(image: &RgbdImage) -> RgbdImage {
    let (camera, depth) = (freiburg::camera(), image.depth());
    let mut out = DepthImage::filled(640, 480, 0.0);
    for (y, x) in (0..480).flat_map(|y| (0..640).map(move |x| (y, x))).filter(|(y, x)| depth[(*x, *y)] > 0.0)
    {
        let p = camera.unproject(Vector2::new(x as f64, y as f64), f64::from(depth[(x, y)]))
            + Vector3::new(0.025, 0.0, 0.0);
        let (u, v) = ((580.0 * p.x / p.z + 320.0).round(), (580.0 * p.y / p.z + 240.0).round());
        if (0.0..640.0).contains(&u) && (0.0..480.0).contains(&v) {
            let seen = &mut out[(u as usize, v as usize)];
            if *seen == 0.0 || p.z < f64::from(*seen) {
                *seen = p.z as f32;
            }
        }
    }
    with_depth(image, out)
}

/// Every fifth column left out: pixels that are wider than high.
fn squeezed(image: &RgbdImage) -> RgbdImage {
    let column = |x: usize| x * 5 / 4;
    let color = ColorImage::from_fn(512, 480, |x, y| image.color()[(column(x), y)]);
    let depth = DepthImage::from_fn(512, 480, |x, y| image.depth()[(column(x), y)]);
    RgbdImage::new(image.stamp(), color, depth).unwrap()
}

#[test]
fn right_settings_raise_no_issue() {
    let Some(found) = suspected(freiburg::camera(), |image| image) else { return };
    assert_eq!(found, vec![]);
}

#[test]
fn a_depth_scale_off_by_five_is_noticed() {
    for by in [5.0, 0.2] {
        let Some(found) = suspected(freiburg::camera(), |image| scaled(&image, by)) else { return };
        assert!(found.iter().any(|s| s.to_string().contains("depth scale")), "{by}: {found:?}");
    }
}

#[test]
fn swapped_focal_lengths_are_noticed() {
    let lens = freiburg::camera().distortion();
    let reported = |fx: f64, fy: f64| PinholeCamera::new((512, 480), (fx, fy), (254.9, 255.3), lens).unwrap();
    let Some(found) = suspected(reported(516.5, 413.8), |image| squeezed(&image)) else { return };
    assert!(found.iter().any(|s| s.to_string().contains("fx and fy swapped")), "{found:?}");
    let right = suspected(reported(413.8, 516.5), |image| squeezed(&image)).unwrap();
    assert_eq!(right, vec![]);
}

#[test]
fn another_cameras_distortion_is_noticed() {
    let camera =
        |lens: Distortion| PinholeCamera::new((640, 480), (517.3, 516.5), (318.6, 255.3), lens).unwrap();
    let wide = Distortion { k1: -0.29, k2: 0.09, ..Distortion::default() };
    let Some(found) = suspected(camera(wide), |image| image) else { return };
    assert!(found.iter().any(|s| s.to_string().contains("distortion coefficients")), "{found:?}");
}

#[test]
fn colour_and_depth_that_are_not_registered_are_noticed() {
    let Some(found) = suspected(freiburg::camera(), |image| unregistered(&image)) else { return };
    assert!(found.iter().any(|s| s.to_string().contains("not registered")), "{found:?}");
}

/// Suspected settings of `reported` after 100 frames of a robot that drives and turns in the rendered room; its wheels report
/// `wheels` times the distance.
fn suspected_in_the_room(reported: PinholeCamera, wheels: f64) -> Vec<CalibrationIssue> {
    let pose = |i: usize| {
        let turn = 0.5 * (i as f64 * 0.06).sin();
        Pose3::exp(Vector6::new(0.0, 0.0, i as f64 * 0.012 - 0.6, 0.0, 0.0, 0.0))
            * Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.14, 0.0, 0.0))
            * Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.0, turn, 0.0))
    };
    let mut slam = RgbdSlam::new(reported, SlamConfig::default()).unwrap();
    for i in 0..100 {
        let step = pose(i.max(1) - 1).inverse() * pose(i);
        let prior = Pose3::new(step.rotation, step.translation * wheels);
        slam.step(&Clean::at(pose(i)).shot(i), Some(prior.into()));
    }
    println!("{:?}", slam.calibration_issues());
    slam.calibration_issues()
}

#[test]
fn the_settings_of_a_driving_robot_are_checked_too() {
    assert_eq!(suspected_in_the_room(camera(), 1.0), vec![]);
    let short = suspected_in_the_room(camera(), 0.2);
    assert!(short.iter().any(|s| matches!(s, CalibrationIssue::TravelledDistance { .. })), "{short:?}");
    let other =
        PinholeCamera::new((320, 240), (300.0, 300.0), (159.5, 119.5), Distortion::default()).unwrap();
    let focal = suspected_in_the_room(other, 1.0);
    assert!(focal.iter().any(|s| matches!(s, CalibrationIssue::FocalLengths { .. })), "{focal:?}");
}
