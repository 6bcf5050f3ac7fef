//! Laws of the pinhole camera.

use proptest::prelude::*;
use std::f64::consts::PI;
use trundle_core::{Distortion, PinholeCamera, Vector2, Vector3};

/// A camera of 640 x 480 px with a lens of two radial and two tangential terms.
fn camera(k1: f64, k2: f64, p1: f64, p2: f64) -> PinholeCamera {
    let lens = Distortion { k1, k2, p1, p2, k3: 0.0 };
    PinholeCamera::new((640, 480), (520.0, 525.0), (318.0, 242.0), lens).unwrap()
}

proptest! {
    #[test]
    fn unproject_inverts_project(x in -4.0..4.0_f64, y in -4.0..4.0_f64, z in 0.1..10.0_f64) {
        let (camera, point) = (PinholeCamera::kinect_v1(), Vector3::new(x, y, z));
        prop_assert!((camera.unproject(camera.project(point).unwrap(), z) - point).norm() < 1e-9);
    }

    #[test]
    fn all_points_of_a_ray_appear_at_one_pixel(x in -1.0..1.0_f64, y in -1.0..1.0_f64, far in 1.0..20.0_f64) {
        let (camera, point) = (PinholeCamera::kinect_v2(), Vector3::new(x, y, 1.0));
        prop_assert!((camera.project(point * far).unwrap() - camera.project(point).unwrap()).norm() < 1e-9);
    }

    #[test]
    fn a_point_that_is_not_ahead_of_the_camera_has_no_pixel(x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -9.0..0.0_f64) {
        prop_assert_eq!(PinholeCamera::kinect_v1().project(Vector3::new(x, y, z)), None);
    }

    #[test]
    fn distort_inverts_undistort_for_a_mild_lens(
        x in 0.0..640.0_f64, y in 0.0..480.0_f64, k1 in -0.2..0.2_f64, k2 in -0.05..0.05_f64, p in -0.003..0.003_f64,
    ) {
        let (camera, raw) = (camera(k1, k2, p, -p), Vector2::new(x, y));
        prop_assert!((camera.distort(camera.undistort(raw)) - raw).norm() < 1e-4);
    }

    #[test]
    fn undistort_inverts_distort_for_a_mild_lens(
        x in 50.0..590.0_f64, y in 50.0..430.0_f64, k1 in -0.1..0.1_f64, p in -0.003..0.003_f64,
    ) {
        let (camera, pixel) = (camera(k1, 0.0, p, p), Vector2::new(x, y));
        prop_assert!((camera.undistort(camera.distort(pixel)) - pixel).norm() < 1e-6);
    }

    #[test]
    fn without_a_lens_nothing_is_distorted(x in 0.0..640.0_f64, y in 0.0..480.0_f64) {
        let (camera, pixel) = (PinholeCamera::kinect_v1(), Vector2::new(x, y));
        prop_assert!((camera.distort(pixel) - pixel).norm() < 1e-9);
        prop_assert_eq!(camera.undistort(pixel), pixel);
    }

    #[test]
    fn a_radial_lens_moves_pixels_along_their_radius(x in 0.0..640.0_f64, y in 0.0..480.0_f64, k1 in 0.01..0.2_f64) {
        let centre = Vector2::new(318.0, 242.0);
        let normal = |pixel: Vector2| (pixel - centre).component_div(&Vector2::new(520.0, 525.0));
        let before = normal(Vector2::new(x, y));
        let after = normal(camera(k1, 0.0, 0.0, 0.0).distort(Vector2::new(x, y)));
        prop_assert!(before.perp(&after).abs() < 1e-9);
        prop_assert!(after.norm() >= before.norm());
        let inward = normal(camera(-k1, 0.0, 0.0, 0.0).distort(Vector2::new(x, y)));
        prop_assert!(inward.norm() <= before.norm());
    }

    #[test]
    fn the_field_of_view_is_what_was_asked_for(across in 0.1..2.8_f64, down in 0.1..2.8_f64) {
        let camera = PinholeCamera::from_field_of_view((320, 200), (across, down)).unwrap();
        let (left, right) = (Vector2::new(-0.5, 99.5), Vector2::new(319.5, 99.5));
        let angle = |pixel: Vector2| camera.unproject(pixel, 1.0).x.atan();
        prop_assert!((angle(right) - angle(left) - across).abs() < 1e-9);
        let (top, bottom) = (Vector2::new(159.5, -0.5), Vector2::new(159.5, 199.5));
        let angle = |pixel: Vector2| camera.unproject(pixel, 1.0).y.atan();
        prop_assert!((angle(bottom) - angle(top) - down).abs() < 1e-9);
    }
}

#[test]
fn the_principal_point_is_the_pixel_of_the_optical_axis_and_no_lens_moves_it() {
    let camera = camera(0.2, -0.1, 0.003, -0.002);
    let centre = Vector2::new(camera.cx(), camera.cy());
    assert_eq!(camera.project(Vector3::z()), Some(centre));
    assert!((camera.distort(centre) - centre).norm() < 1e-12);
}

#[test]
fn x_is_to_the_right_and_y_is_down() {
    let camera = PinholeCamera::kinect_v1();
    let pixel = camera.project(Vector3::new(0.1, 0.2, 1.0)).unwrap();
    assert!(pixel.x > camera.cx() && pixel.y > camera.cy());
}

#[test]
fn the_image_reaches_half_a_pixel_beyond_the_outer_pixel_centres() {
    let camera = PinholeCamera::kinect_v1();
    for (x, y, inside) in [
        (-0.5, -0.5, true),
        (-0.51, 0.0, false),
        (0.0, -0.51, false),
        (639.49, 479.49, true),
        (639.5, 0.0, false),
        (0.0, 479.5, false),
        (f64::NAN, 0.0, false),
    ] {
        assert_eq!(camera.contains(Vector2::new(x, y)), inside, "({x}, {y})");
    }
}

#[test]
fn fields_of_view_of_nothing_or_half_a_turn_are_refused() {
    for bad in [0.0, -1.0, PI, f64::NAN] {
        let across = PinholeCamera::from_field_of_view((64, 48), (bad, 1.0)).unwrap_err();
        let down = PinholeCamera::from_field_of_view((64, 48), (1.0, bad)).unwrap_err();
        assert_eq!(
            (across.field.as_str(), down.field.as_str()),
            ("horizontal field of view", "vertical field of view")
        );
        assert_eq!((across.unit, across.expected.as_str()), ("rad", "0 to pi, exclusive"));
    }
}

/// Worked out by hand from the formulas of OpenCV for the normalised point (0.2, -0.1), r^2 = 0.05.
#[test]
fn the_five_lens_terms_are_those_of_opencv_in_its_order() {
    let lens = Distortion { k1: 0.1, k2: 0.01, p1: 0.002, p2: -0.003, k3: 0.5 };
    let camera = PinholeCamera::new((100, 100), (100.0, 100.0), (50.0, 50.0), lens).unwrap();
    let raw = camera.distort(Vector2::new(70.0, 40.0));
    assert!((raw - Vector2::new(70.05475, 39.975125)).norm() < 1e-9, "{raw}");
}
