//! The fits on drives with known wheels, gyro, mount and delay.

use super::error::CalibrationError;
use super::estimate::Estimate;
use super::floor_plane::{FloorMount, FloorSearch};
use super::gyro_angle::GyroAngle;
use super::gyro_fit::fit_gyro;
use super::image_delay::estimate_image_delay;
use super::planar_track::{level_from_camera, tilt_of};
use super::turn_axis::turn_axis;
use super::wheel_angles::WheelAngles;
use super::wheel_camera_fit::{WheelCameraFit, fit_wheels_and_camera};
use nalgebra::{Rotation3, Vector6};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use trundle_core::{
    DepthImage, DifferentialDrive, GyroRate, Hypotenuse, PinholeCamera, Pose2, Pose3, Stamp, Twist2, Vector2,
    Vector3, WheelTicks,
};

/// The truth of a synthetic robot.
struct Truth {
    /// m
    left_radius: f64,
    /// m
    right_radius: f64,
    /// m
    wheelbase: f64,
    base_from_camera: Pose3,
    /// s
    delay: f64,
    gyro_scale: f64,
    /// rad/s
    gyro_bias: f64,
    /// Standard deviation of the camera's position, m, and rotation, rad.
    camera_noise: (f64, f64),
}

impl Default for Truth {
    fn default() -> Self {
        let turn = Rotation3::from_euler_angles(0.03, 0.2, -0.07).into_inner();
        let optical = nalgebra::Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
        Self {
            left_radius: 0.0362,
            right_radius: 0.0359,
            wheelbase: 0.237,
            base_from_camera: Pose3::from_matrix(turn * optical, Vector3::new(0.12, -0.03, 0.5)),
            delay: 0.034,
            gyro_scale: 1.01,
            gyro_bias: 0.004,
            camera_noise: (0.001, 0.0005),
        }
    }
}

/// Readings of the robot's sensors.
#[derive(Default)]
struct Drive {
    poses: Vec<(Stamp, Pose3)>,
    ticks: Vec<WheelTicks>,
    gyro: Vec<GyroRate>,
}

/// Turns on the spot in both directions, and straight moves: (s, m/s, rad/s).
const SQUARE: [(f64, f64, f64); 12] = [
    (1.0, 0.0, 0.0),
    (3.0, 0.3, 0.0),
    (2.0, 0.0, 0.8),
    (3.0, 0.3, 0.0),
    (2.0, 0.0, 0.8),
    (3.0, 0.3, 0.0),
    (4.0, 0.0, -0.8),
    (3.0, 0.3, 0.0),
    (4.0, 0.0, 0.8),
    (4.0, 0.2, 0.5),
    (4.0, 0.2, -0.5),
    (4.0, 0.0, -0.8),
];
/// Forward without a turn.
const STRAIGHT: [(f64, f64, f64); 2] = [(1.0, 0.0, 0.0), (20.0, 0.3, 0.0)];

/// Drives the robot; wheels and gyro at 50 Hz, images at 15 Hz.
fn drive(truth: &Truth, plan: &[(f64, f64, f64)]) -> Drive {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut noise = |sigma: f64| sigma * ((0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0);
    let mut drive = Drive::default();
    let (mut pose, mut turned, mut last_turned) = (Pose2::new(1.0, 2.0, 0.5), 0.0, 0.0);
    let (mut left, mut right, mut twist) = (0.0, 0.0, Twist2::ZERO);
    let ticks_per_turn = DifferentialDrive::KOBUKI.ticks_per_turn;
    let ticks = |angle: f64| (angle / std::f64::consts::TAU * ticks_per_turn).floor() as i64 as u16;
    let commands =
        plan.iter().flat_map(|&(seconds, v, omega)| (0..(seconds * 1e3) as u32).map(move |_| (v, omega)));
    for (ms, (v, omega)) in commands.enumerate() {
        twist.v += (v - twist.v) * 0.01;
        twist.omega += (omega - twist.omega) * 0.01;
        let stamp = Stamp::from_nanos(ms as i64 * 1_000_000);
        if ms % 20 == 0 {
            let rate = (turned - last_turned) / 0.02;
            last_turned = turned;
            let omega = rate / truth.gyro_scale + truth.gyro_bias + noise(0.0037);
            drive.gyro.push(GyroRate { stamp, omega });
            drive.ticks.push(WheelTicks { stamp, left: ticks(left), right: ticks(right) });
        }
        if ms % 66 == 0 {
            let (m, rad) = truth.camera_noise;
            let error = Vector6::from_fn(|i, _| noise(if i < 3 { m } else { rad }));
            let camera = Pose3::from_pose2(pose) * truth.base_from_camera * Pose3::exp(error);
            drive.poses.push((stamp.after(truth.delay), camera));
        }
        pose = pose.advance(twist, 1e-3);
        turned += twist.omega * 1e-3;
        left += (twist.v - twist.omega * truth.wheelbase / 2.0) * 1e-3 / truth.left_radius;
        right += (twist.v + twist.omega * truth.wheelbase / 2.0) * 1e-3 / truth.right_radius;
    }
    drive
}

/// The upward axis in the frame of a camera.
fn up_of(base_from_camera: Pose3) -> Vector3 {
    base_from_camera.inverse().rotate(Vector3::z())
}

fn fit(truth: &Truth, plan: &[(f64, f64, f64)]) -> Result<WheelCameraFit, CalibrationError> {
    let Drive { poses, ticks, .. } = drive(truth, plan);
    let wheels = WheelAngles::new(&ticks, DifferentialDrive::KOBUKI.ticks_per_turn);
    fit_wheels_and_camera(&poses, up_of(truth.base_from_camera), &wheels, &DifferentialDrive::KOBUKI)
}

/// Asserts that the error of the estimate is below `limit` and below four of its standard deviations, which are at most `limit`.
#[track_caller]
fn assert_found(found: Estimate, truth: f64, limit: f64) {
    let error = (found.value - truth).abs();
    assert!(error <= limit && found.sigma <= limit, "{found:?}, truth {truth}");
    assert!(error <= 4.0 * found.sigma, "{found:?}, truth {truth}: overconfident");
}

#[test]
fn the_delay_of_images_is_found_within_a_millisecond_early_and_late() {
    for delay in [-0.021, 0.0, 0.034, 0.18] {
        let truth = Truth { delay, ..Truth::default() };
        let Drive { poses, gyro, .. } = drive(&truth, &SQUARE);
        let axis = turn_axis(&poses, Vector3::new(0.0, -1.0, 0.0)).unwrap();
        assert!(axis.angle(&up_of(truth.base_from_camera)) < 0.003);
        let found = estimate_image_delay(&poses, axis, &GyroAngle::new(&gyro)).unwrap();
        assert_found(found.delay, delay, 0.002);
        assert_found(found.gyro_scale, 1.01, 0.005);
        assert!((found.gyro_bias.value - 0.004).abs() < 0.001, "{found:?}");
    }
}

#[test]
fn a_drive_without_turns_shows_no_delay_and_says_so() {
    let Drive { poses, .. } = drive(&Truth::default(), &STRAIGHT);
    let error = turn_axis(&poses, Vector3::new(0.0, -1.0, 0.0)).unwrap_err();
    assert!(matches!(error, CalibrationError::NotObservable { .. }), "{error}");
    assert!(error.to_string().contains("turn the robot on the spot"), "{error}");
}

#[test]
fn a_constant_turn_rate_shows_no_delay() {
    let Drive { poses, gyro, .. } = drive(&Truth::default(), &[(20.0, 0.0, 0.6)]);
    // Poses and gyro without the start of the turn.
    let (poses, gyro) = (&poses[40..], GyroAngle::new(&gyro[100..]));
    let axis = turn_axis(poses, Vector3::new(0.0, -1.0, 0.0)).unwrap();
    assert!(estimate_image_delay(poses, axis, &gyro).is_err());
}

#[test]
fn a_silent_or_foreign_gyro_is_refused() {
    let Drive { poses, gyro, .. } = drive(&Truth::default(), &SQUARE);
    let axis = up_of(Truth::default().base_from_camera);
    let error = estimate_image_delay(&poses, axis, &GyroAngle::new(&[])).unwrap_err();
    assert!(error.to_string().starts_with("the gyro: 0 readings"), "{error}");
    let stuck: Vec<GyroRate> = gyro.iter().map(|rate| GyroRate { omega: 0.01, ..*rate }).collect();
    let error = estimate_image_delay(&poses, axis, &GyroAngle::new(&stuck)).unwrap_err();
    assert!(matches!(error, CalibrationError::Contradiction { .. }), "{error}");
}

#[test]
fn wheels_and_mount_are_found_from_a_square() {
    let truth = Truth { delay: 0.0, ..Truth::default() };
    let found = fit(&truth, &SQUARE).unwrap();
    assert_found(found.left_radius, truth.left_radius, 0.0002);
    assert_found(found.right_radius, truth.right_radius, 0.0002);
    assert_found(found.wheelbase, truth.wheelbase, 0.0015);
    assert_found(found.offset_x, 0.12, 0.002);
    assert_found(found.offset_y, -0.03, 0.002);
    assert_found(found.yaw, -0.07, 0.003);
}

#[test]
fn a_straight_drive_leaves_offset_and_wheelbase_open() {
    let found = fit(&Truth { delay: 0.0, ..Truth::default() }, &STRAIGHT).unwrap();
    assert!(found.offset_x.sigma > 0.02 && found.offset_y.sigma > 0.02, "{found:?}");
    assert_found(found.yaw, -0.07, 0.003);
}

#[test]
fn a_turn_on_the_spot_shows_the_distance_of_the_camera_but_not_its_bearing() {
    let truth = Truth { delay: 0.0, left_radius: 0.035, right_radius: 0.035, ..Truth::default() };
    let found = fit(&truth, &[(1.0, 0.0, 0.0), (16.0, 0.0, 0.8), (16.0, 0.0, -0.8)]).unwrap();
    assert!(found.yaw.sigma > 0.05 && found.offset_y.sigma > 0.01, "{found:?}");
    let distance = found.offset_x.value.hypotenuse(found.offset_y.value);
    assert!((distance - 0.12_f64.hypotenuse(0.03)).abs() < 0.002, "{found:?}");
}

#[test]
fn a_robot_at_rest_is_refused() {
    let error = fit(&Truth::default(), &[(10.0, 0.0, 0.0)]).unwrap_err();
    assert!(error.to_string().contains("drive 3 m or more"), "{error}");
}

#[test]
fn the_scale_of_the_gyro_is_found() {
    let truth = Truth { delay: 0.0, ..Truth::default() };
    let Drive { poses, gyro, .. } = drive(&truth, &SQUARE);
    let found = fit_gyro(&poses, up_of(truth.base_from_camera), &GyroAngle::new(&gyro)).unwrap();
    assert_found(found.scale, 1.01, 0.003);
    assert_found(found.bias, 0.004, 0.002);
}

#[test]
fn tilt_and_level_frame_invert_each_other() {
    for (pitch, roll) in [(0.14, 0.0), (-0.3, 0.2), (0.6, -0.4)] {
        let optical = nalgebra::Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
        let mount = Rotation3::from_euler_angles(roll, pitch, 0.9).into_inner() * optical;
        let up = mount.transpose() * Vector3::z();
        let found = tilt_of(up);
        assert!((found.0 - pitch).abs() < 1e-12 && (found.1 - roll).abs() < 1e-12, "{found:?}");
        assert!((level_from_camera(up) * up - Vector3::z()).norm() < 1e-12);
    }
}

/// Depth of a floor below a camera of this tilt and height, with a wall at 2.5 m and noise of 1 %.
fn room(camera: &PinholeCamera, up: Vector3, height: f64) -> DepthImage {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    DepthImage::from_fn(camera.width(), camera.height(), |x, y| {
        let ray = camera.unproject(Vector2::new(x as f64, y as f64), 1.0);
        let down = -up.dot(&ray);
        let floor = if down > 1e-6 { height / down } else { f64::INFINITY };
        (floor.min(2.5) * (1.0 + 0.02 * (rng.random::<f64>() - 0.5))) as f32
    })
}

#[test]
fn the_floor_gives_height_and_tilt_with_a_wall_in_view_and_a_wrong_mount() {
    let camera = PinholeCamera::kinect_v2();
    let truth = Truth::default();
    let up = up_of(truth.base_from_camera);
    let wrong_up = (up + Vector3::new(0.1, 0.0, 0.15)).normalize();
    let mut search = FloorSearch::new(wrong_up);
    search.add(&room(&camera, up, 0.5), &camera);
    let view = search.views()[0];
    assert!((view.height - 0.5).abs() < 0.002 && view.up.angle(&up) < 0.002, "{view:?}");
    let mount = FloorMount::of(&[view], None).unwrap();
    assert!((mount.pitch.value - 0.2).abs() < 0.002 && (mount.roll.value - 0.03).abs() < 0.002, "{mount:?}");
}

#[test]
fn no_floor_is_found_without_depth_and_before_a_wall() {
    let camera = PinholeCamera::kinect_v2();
    let up = up_of(Truth::default().base_from_camera);
    for (depth, with_depth) in [(0.0, 0), (1.0, 1)] {
        let mut search = FloorSearch::new(up);
        search.add(&DepthImage::filled(camera.width(), camera.height(), depth), &camera);
        assert_eq!((search.views(), search.image_counts()), (vec![], (1, with_depth)));
    }
    assert_eq!(FloorMount::of(&[], None), None);
}
