//! The error of every constructor: field, value, unit and accepted values.

use trundle_core::{
    Beam, ColorImage, DepthImage, DifferentialDrive, Distortion, DriveLimits, Footprint, FreeSpan,
    GridGeometry, Image, Invalid, ObstacleKind, OccupancyGrid, Path, PinholeCamera, Pose2, RgbdImage, Scan,
    ScanParts, Stamp, Trajectory, TrajectoryPoint, Twist2, Vector2, require_finite, require_in,
    require_positive,
};

/// The text of an error; a value that is accepted fails the test.
fn text<T: std::fmt::Debug>(result: Result<T, Invalid>) -> String {
    result.unwrap_err().to_string()
}

#[test]
fn the_checks_name_field_value_unit_and_range() {
    assert_eq!(text(require_finite("x", f64::NAN, "m")), "x is NaN m, expected a finite number");
    assert_eq!(text(require_positive("n", 0.0, "")), "n is 0, expected a finite number above 0");
    assert_eq!(text(require_in("a", 4.0, "rad", -1.5, 3.0)), "a is 4 rad, expected -1.5 to 3");
    assert_eq!(require_in("a", 3.0, "rad", -1.5, 3.0), Ok(3.0));
    assert_eq!(require_in("a", -1.5, "rad", -1.5, 3.0), Ok(-1.5));
    for bad in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        assert!(require_finite("x", bad, "").is_err() && require_positive("x", bad, "").is_err());
        assert!(require_in("x", bad, "", -1.0, 1.0).is_err());
    }
}

#[test]
fn every_number_of_a_drive_is_checked() {
    let good = DifferentialDrive::KOBUKI;
    let radius = DifferentialDrive { wheel_radius: -0.035, ..good };
    assert_eq!(text(radius.validated()), "wheel_radius is -0.035 m, expected a finite number above 0");
    let base = DifferentialDrive { wheelbase: 0.0, ..good };
    assert_eq!(text(base.validated()), "wheelbase is 0 m, expected a finite number above 0");
    let ticks = DifferentialDrive { ticks_per_turn: f64::NAN, ..good };
    assert_eq!(text(ticks.validated()), "ticks_per_turn is NaN, expected a finite number above 0");
}

#[test]
fn every_number_of_the_limits_is_checked_with_its_unit() {
    let good = DriveLimits::KOBUKI;
    for (limits, field, unit) in [
        (DriveLimits { wheel_speed: 0.0, ..good }, "limits.wheel_speed", "m/s"),
        (DriveLimits { v: 0.0, ..good }, "limits.v", "m/s"),
        (DriveLimits { omega: 0.0, ..good }, "limits.omega", "rad/s"),
        (DriveLimits { acceleration: 0.0, ..good }, "limits.acceleration", "m/s^2"),
        (DriveLimits { angular_acceleration: 0.0, ..good }, "limits.angular_acceleration", "rad/s^2"),
    ] {
        let expected = format!("{field} is 0 {unit}, expected a finite number above 0");
        assert_eq!(text(limits.validated()), expected);
    }
}

#[test]
fn every_number_of_a_camera_is_checked() {
    let lens = Distortion::default();
    let camera = |f: (f64, f64), c: (f64, f64), lens| text(PinholeCamera::new((640, 480), f, c, lens));
    let (f, c) = ((500.0, 500.0), (320.0, 240.0));
    assert_eq!(camera((0.0, 500.0), c, lens), "fx is 0 px, expected a finite number above 0");
    assert_eq!(camera((500.0, f64::NAN), c, lens), "fy is NaN px, expected a finite number above 0");
    assert_eq!(camera(f, (f64::INFINITY, 240.0), lens), "cx is inf px, expected a finite number");
    assert_eq!(camera(f, (320.0, f64::NAN), lens), "cy is NaN px, expected a finite number");
    for (lens, name) in [
        (Distortion { k1: f64::NAN, ..lens }, "k1"),
        (Distortion { k2: f64::NAN, ..lens }, "k2"),
        (Distortion { p1: f64::NAN, ..lens }, "p1"),
        (Distortion { p2: f64::NAN, ..lens }, "p2"),
        (Distortion { k3: f64::NAN, ..lens }, "k3"),
    ] {
        assert_eq!(camera(f, c, lens), format!("{name} is NaN, expected a finite number"));
    }
    let size = PinholeCamera::new((640, 0), f, c, lens);
    assert_eq!(text(size), "camera size is 640 x 0 px, expected 1 x 1 to 16384 x 16384");
    let readout = PinholeCamera::kinect_v1().with_readout(0.06);
    assert_eq!(text(readout), "readout is 0.06 s, expected 0 to 0.05");
}

#[test]
fn grids_refuse_resolutions_origins_and_sizes() {
    let grid = |resolution, x, y, w, h| text(GridGeometry::new(resolution, Vector2::new(x, y), w, h));
    assert_eq!(grid(0.0, 0.0, 0.0, 1, 1), "resolution is 0 m, expected a finite number above 0");
    assert_eq!(grid(0.1, f64::NAN, 0.0, 1, 1), "origin x is NaN m, expected a finite number");
    assert_eq!(grid(0.1, 0.0, f64::INFINITY, 1, 1), "origin y is inf m, expected a finite number");
    assert_eq!(grid(0.1, 0.0, 0.0, 0, 5), "grid size is 0 x 5 cells, expected 1 to 2^31 cells");
    assert_eq!(
        grid(0.1, 0.0, 0.0, 65_536, 32_769),
        "grid size is 65536 x 32769 cells, expected 1 to 2^31 cells"
    );
    assert!(GridGeometry::new(0.1, Vector2::zeros(), usize::MAX, 2).is_err());
    assert!(GridGeometry::new(0.1, Vector2::zeros(), 65_536, 32_768).is_ok());
    let geometry = GridGeometry::new(0.1, Vector2::zeros(), 3, 2).unwrap();
    assert_eq!(text(OccupancyGrid::new(geometry, vec![])), "number of cells is 0, expected 6");
    assert_eq!(
        text(OccupancyGrid::from_ascii(0.1, "")),
        "grid size is 0 x 0 cells, expected 1 to 2^31 cells"
    );
    assert_eq!(text(OccupancyGrid::from_ascii(0.1, "..\n...")), "number of cells is 5, expected 4");
}

#[test]
fn images_refuse_wrong_sizes() {
    assert_eq!(text(Image::<u8>::new(4, 0, vec![])), "image size is 4 x 0 px, expected at least 1 x 1");
    assert_eq!(text(Image::new(2, 2, vec![0_u8; 5])), "number of pixels is 5 px, expected 2 x 2");
    assert!(Image::new(usize::MAX, 2, vec![0_u8; 2]).is_err());
    let image =
        RgbdImage::new(Stamp::default(), ColorImage::filled(4, 2, [0; 3]), DepthImage::filled(2, 4, 0.0));
    assert_eq!(text(image), "depth image size is 2 x 4 px, expected 4 x 2 as the colour image");
}

#[test]
fn paths_and_trajectories_name_the_point() {
    assert_eq!(text(Path::new(vec![])), "path points is 0, expected 1 or more");
    let points = vec![Vector2::zeros(), Vector2::new(1.0, f64::NAN)];
    assert_eq!(text(Path::new(points)), "path point 1 is (1, NaN) m, expected finite numbers");
    let point =
        |time: f64, x: f64| TrajectoryPoint { time, pose: Pose2::new(x, 0.0, 0.0), twist: Twist2::ZERO };
    assert_eq!(text(Trajectory::new(vec![])), "trajectory points is 0, expected 1 or more");
    let late = Trajectory::new(vec![point(0.5, 0.0)]);
    assert_eq!(text(late), "time of trajectory point 0 is 0.5 s, expected 0");
    let back = Trajectory::new(vec![point(0.0, 0.0), point(2.0, 0.0), point(1.0, 0.0)]);
    assert_eq!(text(back), "time of trajectory point 2 is 1 s, expected more than 2 s");
    let nowhere = Trajectory::new(vec![point(0.0, 0.0), point(1.0, f64::INFINITY)]);
    assert_eq!(text(nowhere), "trajectory point 1 is not finite, expected finite numbers");
}

#[test]
fn footprints_say_what_is_wrong_with_them() {
    let polygon = |corners: &[(f64, f64)]| {
        text(Footprint::polygon(corners.iter().map(|&(x, y)| Vector2::new(x, y)).collect()))
    };
    assert_eq!(text(Footprint::disc(-0.2)), "footprint radius is -0.2 m, expected a finite number above 0");
    assert_eq!(polygon(&[(0.0, 0.0), (1.0, 0.0)]), "footprint corners is 2, expected 3 or more");
    let infinite = polygon(&[(0.0, 0.0), (1.0, 0.0), (0.0, f64::INFINITY)]);
    assert_eq!(infinite, "footprint corner is (0, inf) m, expected finite numbers");
    assert_eq!(
        polygon(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]),
        "footprint area is 0 m^2, expected more than 0"
    );
    let dent = polygon(&[(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)]);
    assert_eq!(dent, "footprint is turned inward at corner 1, expected convex");
}

fn scan(origin: Vector2, angles: (f64, f64), parts: ScanParts) -> String {
    text(Scan::from_parts(Stamp::default(), origin, angles, parts))
}

#[test]
fn scans_refuse_origins_and_angles() {
    let none = ScanParts::default;
    let far = scan(Vector2::new(20.5, 0.0), (0.0, 0.1), none());
    assert_eq!(far, "scan origin x is 20.5 m, expected -20 to 20");
    let nowhere = scan(Vector2::new(0.0, f64::NAN), (0.0, 0.1), none());
    assert_eq!(nowhere, "scan origin y is NaN m, expected -20 to 20");
    let first = scan(Vector2::zeros(), (f64::INFINITY, 0.1), none());
    assert_eq!(first, "angle_min is inf rad, expected a finite number");
    let step = scan(Vector2::zeros(), (0.0, 0.0), none());
    assert_eq!(step, "angle_increment is 0 rad, expected a finite number above 0");
}

#[test]
fn scans_refuse_parts_and_name_the_beam() {
    let beams = || vec![Beam::Unseen, Beam::Free { range: 1.0 }];
    let refused = |parts| scan(Vector2::zeros(), (0.0, 0.1), parts);
    let behind = ScanParts { beams: vec![Beam::Unseen, Beam::Free { range: -1.0 }], ..ScanParts::default() };
    assert_eq!(refused(behind), "range of beam 1 is -1 m, expected a finite number, 0 or more");
    let sigmas = ScanParts { beams: beams(), sigmas: vec![-0.5, 0.0], ..ScanParts::default() };
    assert_eq!(refused(sigmas), "sigma of beam 0 is -0.5 m, expected a finite number, 0 or more");
    let kinds = ScanParts { beams: beams(), obstacles: vec![ObstacleKind::Drop; 3], ..ScanParts::default() };
    assert_eq!(refused(kinds), "number of obstacles is 3, expected 0 or 2");
    let span = FreeSpan { beam: 1, from: 2.0, to: 1.0 };
    let spans = ScanParts { beams: beams(), free: Some(vec![span]), ..ScanParts::default() };
    assert_eq!(
        refused(spans),
        "free span of beam 1 is 2 to 1 m, expected finite numbers that rise, by rising beam"
    );
}
