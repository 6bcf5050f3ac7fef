//! Registration compared with a ray caster that renders each camera separately.

use crate::fixtures::best_ms;
use trundle_core::{ColorImage, DepthImage, Distortion, PinholeCamera, Pose3, Stamp, Vector2, Vector3};
use trundle_drivers::camera::registration::{DepthRegistration, Registration};
use trundle_drivers::camera::{CameraInfo, PixelFormat, StreamInfo};

/// A rectangle across the view, in the output camera's frame: depth at the optical axis, slope along x, and sides.
struct Panel {
    depth: f64,
    slope: f64,
    x: [f64; 2],
    y: [f64; 2],
}

/// A slanted wall, a slanted panel at 1.2 m, and a narrow post at 0.8 m.
fn scene() -> [Panel; 3] {
    [
        Panel { depth: 3.0, slope: 0.3, x: [-9.0, 9.0], y: [-9.0, 9.0] },
        Panel { depth: 1.2, slope: -0.2, x: [-0.3, 0.25], y: [-0.35, 0.2] },
        Panel { depth: 0.8, slope: 0.0, x: [0.27, 0.33], y: [-9.0, 9.0] },
    ]
}

/// The nearest panel on a ray from `origin` along `direction`: distance and index.
fn cast(scene: &[Panel], origin: Vector3, direction: Vector3) -> Option<(f64, usize)> {
    let hits = scene.iter().enumerate().filter_map(|(index, panel)| {
        let along =
            (panel.depth + panel.slope * origin.x - origin.z) / (direction.z - panel.slope * direction.x);
        let point = origin + direction * along;
        let is_inside = |value: f64, [low, high]: [f64; 2]| value >= low && value <= high;
        (along > 0.0 && is_inside(point.x, panel.x) && is_inside(point.y, panel.y)).then_some((along, index))
    });
    hits.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Depth of the scene in a camera at `output_from_camera`, and the panel in each pixel.
fn render(camera: &PinholeCamera, output_from_camera: Pose3) -> (DepthImage, Vec<Option<usize>>) {
    let scene = scene();
    let hit = |x: usize, y: usize| {
        let ray = camera.unproject(camera.undistort(Vector2::new(x as f64, y as f64)), 1.0);
        cast(&scene, output_from_camera.translation, output_from_camera.rotate(ray))
    };
    let depth = DepthImage::from_fn(camera.width(), camera.height(), |x, y| {
        hit(x, y).map_or(0.0, |(depth, _)| depth as f32)
    });
    let pixels = (0..camera.height()).flat_map(|y| (0..camera.width()).map(move |x| (x, y)));
    (depth, pixels.map(|(x, y)| hit(x, y).map(|(_, panel)| panel)).collect())
}

fn offset() -> Pose3 {
    let turn = nalgebra::UnitQuaternion::from_euler_angles(0.004, -0.006, 0.008);
    Pose3::new(turn, Vector3::new(0.052, -0.001, 0.003))
}

fn lens() -> Distortion {
    Distortion { k1: 0.08, k2: -0.2, p1: 0.001, p2: -0.0005, k3: 0.05 }
}

/// Shares of the output pixels that the depth camera can see.
struct Shares {
    /// Share of the pixels with depth that are within 1 % of the ray caster.
    right: f64,
    /// Share of the pixels without depth among those visible to the depth camera and away from edges.
    holes: f64,
    /// Number of pixels in the middle of a near panel with a depth behind it.
    shining_through: usize,
}

/// Whether all pixels around show the same panel.
fn is_inside(panels: &[Option<usize>], width: usize, x: usize, y: usize, margin: usize) -> bool {
    let height = panels.len() / width;
    if x < margin || y < margin || x + margin >= width || y + margin >= height {
        return false;
    }
    let own = panels[y * width + x];
    (y - margin..=y + margin).all(|v| (x - margin..=x + margin).all(|u| panels[v * width + u] == own))
}

/// Whether the depth camera sees the surface point of an output pixel.
fn is_seen(depth: &PinholeCamera, output: &PinholeCamera, (x, y): (usize, usize), z: f32) -> bool {
    let point = output.unproject(output.undistort(Vector2::new(x as f64, y as f64)), z as f64);
    let origin = offset().translation;
    let along = cast(&scene(), origin, point - origin).map_or(0.0, |(along, _)| along);
    let pixel = depth.project(offset().inverse().transform(point)).map(|pixel| depth.distort(pixel));
    let is_in_image = pixel.is_some_and(|p| {
        p.x > 2.0 && p.y > 2.0 && p.x < depth.width() as f64 - 3.0 && p.y < depth.height() as f64 - 3.0
    });
    along > 0.999 && is_in_image
}

fn compare(depth: &PinholeCamera, output: &PinholeCamera) -> (Shares, f64) {
    let (source, _) = render(depth, offset());
    let (truth, panels) = render(output, Pose3::identity());
    let mut registration = DepthRegistration::new(*depth, Some(offset()), *output);
    let mut moved = DepthImage::filled(output.width(), output.height(), 0.0);
    registration.register(&source, &mut moved).unwrap();
    let ms = best_ms(|| registration.register(&source, &mut moved).unwrap());

    let (mut found, mut right, mut seen, mut holes, mut shining_through) = (0, 0, 0, 0, 0);
    for (x, y) in (0..output.height()).flat_map(|y| (0..output.width()).map(move |x| (x, y))) {
        let (z, expected) = (moved[(x, y)], truth[(x, y)]);
        found += (z > 0.0) as usize;
        right += (z > 0.0 && (z - expected).abs() < 0.01 * expected) as usize;
        if is_inside(&panels, output.width(), x, y, 2) && is_seen(depth, output, (x, y), expected) {
            seen += 1;
            holes += (z == 0.0) as usize;
            shining_through += (z > expected * 1.05) as usize;
        }
    }
    assert!(seen * 10 > output.width() * output.height() * 7, "the scene fills the view: {seen}");
    let shares =
        Shares { right: right as f64 / found as f64, holes: holes as f64 / seen as f64, shining_through };
    (shares, ms)
}

fn camera(size: (usize, usize), focal: f64, lens: Distortion) -> PinholeCamera {
    let middle = (size.0 as f64 / 2.0 + 3.2, size.1 as f64 / 2.0 - 2.1);
    PinholeCamera::new(size, (focal, focal * 1.002), middle, lens).unwrap()
}

fn check(name: &str, depth: PinholeCamera, output: PinholeCamera) {
    let (shares, ms) = compare(&depth, &output);
    println!(
        "{name}: {:.2} % right, {:.4} % holes, {} through, {ms:.2} ms",
        100.0 * shares.right,
        100.0 * shares.holes,
        shares.shining_through
    );
    assert!(shares.right > 0.997, "{name}: {}", shares.right);
    assert!(shares.holes < 0.001, "{name}: {}", shares.holes);
    assert_eq!(shares.shining_through, 0, "{name}");
}

#[test]
fn depth_of_equal_size_lands_on_the_surfaces() {
    check(
        "640x480 to 640x480",
        camera((640, 480), 580.0, Distortion::default()),
        camera((640, 480), 525.0, Distortion::default()),
    );
}

#[test]
fn depth_of_a_kinect_v2_fills_a_colour_image_of_more_pixels() {
    check(
        "512x424 to 960x540",
        camera((512, 424), 365.0, lens()),
        camera((960, 540), 540.0, Distortion::default()),
    );
}

#[test]
fn both_lenses_may_distort() {
    let strong = Distortion { k1: 0.12, k2: -0.03, ..Distortion::default() };
    check(
        "distorted 512x424 to 960x540",
        camera((512, 424), 365.0, lens()),
        camera((960, 540), 540.0, strong),
    );
}

#[test]
fn fewer_pixels_are_filled_too() {
    check(
        "640x480 to 320x240",
        camera((640, 480), 580.0, lens()),
        camera((320, 240), 262.0, Distortion::default()),
    );
}

/// Neighbouring depth pixels on a steep wall are up to 3 px apart in the output, while each covers only 1.5 px.
#[test]
fn a_steep_wall_seen_from_the_side_has_no_holes() {
    let (depth, output) =
        (camera((256, 212), 182.0, lens()), camera((480, 270), 270.0, Distortion::default()));
    let offset = Pose3::new(Default::default(), Vector3::new(-0.6, 0.0, 0.0));
    let wall = [Panel { depth: 1.6, slope: 1.2, x: [-0.5, 2.0], y: [-9.0, 9.0] }];
    let cast_in = |camera: &PinholeCamera, from: Pose3, x: usize, y: usize| {
        let ray = camera.unproject(camera.undistort(Vector2::new(x as f64, y as f64)), 1.0);
        cast(&wall, from.translation, from.rotate(ray)).map_or(0.0, |(depth, _)| depth as f32)
    };
    let source = DepthImage::from_fn(256, 212, |x, y| cast_in(&depth, offset, x, y));
    let mut moved = DepthImage::filled(480, 270, 0.0);
    DepthRegistration::new(depth, Some(offset), output).register(&source, &mut moved).unwrap();
    let (mut wrong, mut seen) = (0, 0);
    for (x, y) in (20..250).flat_map(|y| (120..340).map(move |x| (x, y))) {
        let expected = cast_in(&output, Pose3::identity(), x, y);
        if expected > 0.0 && cast_in(&output, Pose3::identity(), x - 3, y) > 0.0 {
            seen += 1;
            wrong += ((moved[(x, y)] - expected).abs() > 0.01 * expected) as usize;
        }
    }
    assert!(seen > 30_000 && wrong == 0, "{wrong} of {seen}");
}

#[test]
fn the_same_frame_gives_the_same_bytes() {
    let (depth, output) =
        (camera((320, 240), 290.0, lens()), camera((480, 270), 270.0, Distortion::default()));
    let (source, _) = render(&depth, offset());
    let mut registration = DepthRegistration::new(depth, Some(offset()), output);
    let mut register = |image: &DepthImage| {
        let mut moved = DepthImage::filled(480, 270, 0.0);
        registration.register(image, &mut moved).unwrap();
        moved
    };
    let first = register(&source);
    let empty = register(&DepthImage::filled(320, 240, 0.0));
    assert!(empty.data().iter().all(|z| *z == 0.0), "nothing stays of the frame before");
    assert_eq!(register(&source), first);
}

fn info(color: PinholeCamera, depth: PinholeCamera, color_from_depth: Option<Pose3>) -> CameraInfo {
    let stream = |format, camera| StreamInfo { format, camera, rate_hz: 30.0 };
    CameraInfo {
        name: "test".into(),
        serial: String::new(),
        firmware: String::new(),
        usb: None,
        color: stream(PixelFormat::Rgb8, color),
        depth: stream(PixelFormat::DepthF32, depth),
        depth_unit_m: 0.001,
        color_from_depth,
        delay_s: 0.0,
        is_live: true,
    }
}

#[test]
fn registered_frames_pass_unchanged() {
    let lens = camera((32, 24), 30.0, lens());
    let color = ColorImage::from_fn(32, 24, |x, y| [x as u8, y as u8, 9]);
    let depth = DepthImage::from_fn(32, 24, |x, _| x as f32 * 0.1);
    let mut registration = Registration::new(&info(lens, lens.with_readout(0.02).unwrap(), None), None);
    let image = registration.register(Stamp::from_nanos(5), &color, &depth).unwrap();
    assert_eq!((image.color(), image.depth(), image.stamp().nanos), (&color, &depth, 5));
    let error =
        registration.register(Stamp::from_nanos(5), &color, &DepthImage::filled(31, 24, 1.0)).unwrap_err();
    assert_eq!(error.to_string(), "size of the depth image is 31 x 24 px, expected 32 x 24 as its camera");
}

#[test]
fn colour_is_rectified_and_reduced_along_the_rays() {
    let large = camera((960, 540), 810.0, lens());
    let output = camera((320, 180), 270.0, Distortion::default());
    let shade = |direction: f64| (128.0 + 100.0 * direction) as u8;
    let color = ColorImage::from_fn(960, 540, |x, y| {
        let ray = large.unproject(large.undistort(Vector2::new(x as f64, y as f64)), 1.0);
        [shade(ray.x), shade(ray.y), 50]
    });
    let mut registration = Registration::new(&info(large, large, None), Some(output));
    let image =
        registration.register(Stamp::from_nanos(0), &color, &DepthImage::filled(960, 540, 2.0)).unwrap();
    let mut checked = 0;
    for (x, y) in (5..175).flat_map(|y| (5..315).map(move |x| (x, y))) {
        let ray = output.unproject(Vector2::new(x as f64, y as f64), 1.0);
        let pixel = image.color()[(x, y)];
        if pixel != [0; 3] {
            checked += 1;
            assert!(
                pixel[0].abs_diff(shade(ray.x)) <= 2 && pixel[1].abs_diff(shade(ray.y)) <= 2,
                "{x} {y} {pixel:?}"
            );
            assert_eq!(image.depth()[(x, y)], 2.0);
        }
    }
    assert!(checked > 40_000, "{checked}");
}
