//! Laws and faults of the wheel odometry.

use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};
use trundle_core::{
    DifferentialDrive, GyroRate, Odometry, Pose2, Pose3, Stamp, Twist2, Vector3, WheelTicks, wrap_angle,
};
use trundle_estimation::{OdometryConfig, WheelOdometry, WheelReport};

const DT: f64 = 0.02;

/// A Kobuki with rounded encoder counters.
struct Drive {
    odometry: WheelOdometry,
    nanos: i64,
    left: f64,
    right: f64,
}

impl Drive {
    fn new() -> Self {
        Self::from_ticks(0.0, 0.0)
    }

    fn with(config: OdometryConfig) -> Self {
        Self::starting((0.0, 0.0), config)
    }

    fn from_ticks(left: f64, right: f64) -> Self {
        Self::starting((left, right), OdometryConfig::default())
    }

    fn starting((left, right): (f64, f64), config: OdometryConfig) -> Self {
        let odometry = WheelOdometry::new(DifferentialDrive::KOBUKI, config).unwrap();
        let mut drive = Self { odometry, nanos: 1_000_000_000, left, right };
        drive.read();
        drive
    }

    fn stamp(&self) -> Stamp {
        Stamp::from_nanos(self.nanos)
    }

    fn ticks(&self) -> WheelTicks {
        let counter = |ticks: f64| (ticks.round() as i64).rem_euclid(65_536) as u16;
        WheelTicks { stamp: self.stamp(), left: counter(self.left), right: counter(self.right) }
    }

    fn read(&mut self) -> Odometry {
        let ticks = self.ticks();
        self.odometry.step_wheels(&ticks)
    }

    fn roll(&mut self, twist: Twist2) {
        let (left, right) = DifferentialDrive::KOBUKI.wheel_speeds(twist);
        self.nanos += 20_000_000;
        self.left += left * DT / DifferentialDrive::KOBUKI.metres_per_tick();
        self.right += right * DT / DifferentialDrive::KOBUKI.metres_per_tick();
    }

    fn drive(&mut self, twist: Twist2, steps: usize) {
        for _ in 0..steps {
            self.roll(twist);
            self.read();
        }
    }

    fn drive_with_gyro(&mut self, twist: Twist2, gyro: f64, steps: usize) {
        for _ in 0..steps {
            self.roll(twist);
            self.odometry.step_gyro(&GyroRate { stamp: self.stamp(), omega: gyro });
            self.read();
        }
    }
}

#[test]
fn wheel_radii_are_estimated_while_driving() {
    let (mut drive, nominal) = (Drive::new(), DifferentialDrive::KOBUKI.wheel_radius);
    let (left, right) = (1.012, 0.994);
    let mut truth = Pose2::IDENTITY;
    drive.drive_with_gyro(Twist2::ZERO, 0.0, 50);
    for i in 0..2000 {
        // Straight on, with a bend in every fourth part.
        let twist = Twist2::new(0.4, if i % 400 < 100 { 0.5 } else { 0.0 });
        let (l, r) = DifferentialDrive::KOBUKI.wheel_speeds(twist);
        drive.nanos += 20_000_000;
        drive.left += l * DT / (left * DifferentialDrive::KOBUKI.metres_per_tick());
        drive.right += r * DT / (right * DifferentialDrive::KOBUKI.metres_per_tick());
        truth = truth * Pose2::exp(nalgebra::Vector3::new(twist.v * DT, 0.0, twist.omega * DT));
        let noise = if i % 2 == 0 { 0.01 } else { -0.01 };
        drive.odometry.step_gyro(&GyroRate { stamp: drive.stamp(), omega: twist.omega + noise });
        let odometry = drive.read();
        let wobble = Pose2::new(noise * 0.3, -noise * 0.3, 0.0);
        drive.odometry.add_visual_pose(drive.stamp(), odometry.pose, Pose3::from_pose2(truth * wobble));
    }
    let [l, r] = drive.odometry.wheel_radii().map(|radius| radius / nominal);
    assert!((l - left).abs() < 0.002 && (r - right).abs() < 0.002, "{l} {r}");
}

/// Estimated scale and bias after turns to both sides that the camera measures. The gyro multiplies the rate by `gyro` and adds
/// `bias` rad/s from the first turn on; the wheels overestimate turns by 3 %.
fn calibrated((gyro, bias): (f64, f64), has_gyro: bool, config: OdometryConfig) -> (f64, f64) {
    let mut drive =
        Drive { odometry: WheelOdometry::new(DifferentialDrive::KOBUKI, config).unwrap(), ..Drive::new() };
    let mut truth = Pose2::IDENTITY;
    drive.drive_with_gyro(Twist2::ZERO, 0.0, 50);
    for i in 0..3000 {
        let omega = if i % 300 < 20 { 0.0 } else { 0.7 };
        let twist = Twist2::new(0.2, if i % 600 < 300 { omega } else { -omega });
        truth = truth * Pose2::exp(Vector3::new(twist.v * DT, 0.0, twist.omega * DT));
        let noise = if i % 2 == 0 { 0.01 } else { -0.01 };
        drive.roll(Twist2::new(twist.v, 1.03 * twist.omega));
        if has_gyro {
            let omega = twist.omega * gyro + bias + noise;
            drive.odometry.step_gyro(&GyroRate { stamp: drive.stamp(), omega });
        }
        let odometry = drive.read();
        let wobble = Pose2::new(0.0, 0.0, 0.2 * noise);
        drive.odometry.add_visual_pose(drive.stamp(), odometry.pose, Pose3::from_pose2(truth * wobble));
    }
    (drive.odometry.gyro_scale(), drive.odometry.gyro_bias().unwrap_or_default())
}

#[test]
fn gyro_scale_and_bias_are_estimated_from_visual_turns() {
    let config = OdometryConfig::default();
    for (gyro, bias) in [(0.99, 0.0), (1.0, 0.004), (1.006, -0.002)] {
        let (scale, found) = calibrated((gyro, bias), true, config.clone());
        assert!((scale * gyro - 1.0).abs() < 1e-3, "{scale} for {gyro}");
        assert!((found - bias).abs() < 5e-4, "{found} for {bias}");
    }
    let mut odometry = config.clone();
    odometry.gyro_scale_sigma = 0.0;
    let (scale, _) = calibrated((0.99, 0.0), true, odometry);
    assert_eq!(scale, 1.0);
    assert_eq!(
        calibrated((0.99, 0.0), false, config),
        (1.0, 0.0),
        "turns of the wheels do not calibrate the gyro"
    );
}

#[test]
fn one_slip_does_not_change_the_wheels() {
    let mut drive = Drive::new();
    drive.drive_with_gyro(Twist2::ZERO, 0.0, 50);
    drive.drive_with_gyro(Twist2::new(0.4, 0.0), 0.0, 200);
    // The left wheel spins: the gyro measures no such turn, the camera no such distance.
    drive.drive_with_gyro(Twist2::new(0.4, -0.6), 0.0, 100);
    drive.odometry.add_visual_pose(drive.stamp(), Pose2::IDENTITY, Pose3::identity());
    let visual = Pose3::from_pose2(Pose2::new(0.4, 0.0, 0.0));
    drive.odometry.add_visual_pose(drive.stamp(), Pose2::new(1.2, 0.0, 0.0), visual);
    let nominal = DifferentialDrive::KOBUKI.wheel_radius;
    for radius in drive.odometry.wheel_radii() {
        assert!((radius / nominal - 1.0).abs() < 1e-3, "{radius}");
    }
}

#[test]
fn a_circle_closes() {
    let mut drive = Drive::new();
    drive.drive(Twist2::new(0.5, 0.5 * TAU / 10.0), 1000);
    let pose = drive.odometry.odometry().pose;
    assert!(pose.position().norm() < 1e-3 && wrap_angle(pose.theta).abs() < 1e-3, "{pose:?}");
    assert_eq!(drive.odometry.counts().used, 1000);
}

#[test]
fn the_corners_of_a_square_are_exact() {
    let mut drive = Drive::new();
    for corner in [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)] {
        drive.drive(Twist2::new(0.5, 0.0), 100);
        let pose = drive.odometry.odometry().pose;
        assert!((pose.x - corner.0).abs() < 2e-3 && (pose.y - corner.1).abs() < 2e-3, "{pose:?} {corner:?}");
        drive.drive(Twist2::new(0.0, FRAC_PI_2), 50);
    }
}

proptest! {
    #[test]
    fn odometry_does_not_depend_on_the_start_of_the_counters(left: u16, right: u16, v in -0.7..0.7_f64, omega in -2.0..2.0_f64) {
        let mut here = Drive::new();
        let mut there = Drive::from_ticks(f64::from(left), f64::from(right));
        here.drive(Twist2::new(v, omega), 300);
        there.drive(Twist2::new(v, omega), 300);
        prop_assert_eq!(here.odometry.odometry(), there.odometry.odometry());
    }

    #[test]
    fn covariance_is_positive_and_grows(v in -0.7..0.7_f64, omega in -2.0..2.0_f64) {
        let mut drive = Drive::new();
        let mut before = 0.0;
        for _ in 0..20 {
            drive.drive(Twist2::new(v, omega), 10);
            let covariance = drive.odometry.odometry().covariance;
            let eigenvalues = covariance.symmetric_eigenvalues();
            prop_assert!(eigenvalues.min() >= -1e-15, "{}", covariance);
            prop_assert!(covariance.determinant() >= before);
            before = covariance.determinant();
        }
    }
}

#[test]
fn a_metre_adds_the_documented_sigmas() {
    let mut drive = Drive::new();
    drive.drive(Twist2::new(0.5, 0.0), 100);
    let covariance = drive.odometry.odometry().covariance;
    assert!((covariance[(0, 0)].sqrt() - 0.02).abs() < 1e-4, "{covariance}");
    assert!((covariance[(2, 2)].sqrt() - 0.02).abs() < 1e-4, "{covariance}");
    // Across: the heading's random walk transported along the path, plus the sideways noise.
    let mut config = OdometryConfig::default();
    config.sideways_noise = 0.0;
    let mut rails = Drive::with(config);
    rails.drive(Twist2::new(0.5, 0.0), 100);
    let transported = rails.odometry.odometry().covariance[(1, 1)];
    assert!((transported - 0.02_f64.powi(2) / 3.0).abs() < 4e-6, "{transported}");
    assert!((covariance[(1, 1)] - transported - 0.001_f64.powi(2)).abs() < 1e-9, "{covariance}");
}

#[test]
fn the_gyro_sets_the_heading_with_its_bias_removed() {
    let mut drive = Drive::new();
    drive.drive_with_gyro(Twist2::ZERO, 0.03, 200);
    assert!((drive.odometry.gyro_bias().unwrap() - 0.03).abs() < 1e-3);
    assert_eq!(drive.odometry.odometry().pose.theta, 0.0, "noise does not turn a robot at rest");
    // The wheels overestimate the turn by 5 %.
    drive.drive_with_gyro(Twist2::new(0.2, 1.05), 1.03, 100);
    let theta = drive.odometry.odometry().pose.theta;
    assert!((theta - 2.0).abs() < 0.03, "{theta}");
    assert_eq!(drive.odometry.report(), WheelReport::Used);
    assert!((drive.odometry.odometry().twist.omega - 1.0).abs() < 0.01);
}

#[test]
fn slow_turns_are_integrated_between_ticks() {
    // A tick of one wheel is 0.04 deg: at these rates two to nine readings of ten show none.
    for rate in [0.005, 0.01, -0.02, 0.03] {
        let mut drive = Drive::new();
        drive.drive_with_gyro(Twist2::ZERO, 0.0, 100);
        let steps = (0.2_f64 / rate).abs() / DT;
        for i in 0..steps.round() as usize {
            let noise = if i % 2 == 0 { 0.004 } else { -0.004 };
            drive.drive_with_gyro(Twist2::new(0.0, rate), rate + noise, 1);
        }
        let theta = drive.odometry.odometry().pose.theta;
        assert!((theta - 0.2 * rate.signum()).abs() < 0.012, "{rate}: {theta}");
        let twist = drive.odometry.odometry().twist.omega;
        assert!(twist == 0.0 || (twist - rate).abs() < 0.005, "{rate}: {twist}");
    }
}

#[test]
fn the_first_step_after_a_stop_has_only_its_own_turn() {
    let mut drive = Drive::new();
    drive.drive_with_gyro(Twist2::ZERO, 0.0, 200);
    drive.drive_with_gyro(Twist2::new(0.3, 0.0), 0.0, 50);
    drive.drive_with_gyro(Twist2::ZERO, 0.03, 14);
    drive.drive_with_gyro(Twist2::new(0.2, 1.0), 1.0, 1);
    assert_eq!(drive.odometry.report(), WheelReport::Used);
    let omega = drive.odometry.odometry().twist.omega;
    assert!((omega - 1.0).abs() < 0.01, "{omega}");
}

#[test]
fn wheels_set_the_heading_while_the_gyro_is_silent() {
    let mut drive = Drive::new();
    drive.drive_with_gyro(Twist2::ZERO, 0.0, 50);
    drive.drive(Twist2::new(0.0, 1.0), 50);
    drive.drive_with_gyro(Twist2::new(0.0, 1.0), 1.0, 50);
    let theta = drive.odometry.odometry().pose.theta;
    // The last rate of a silent gyro is held for 0.05 s.
    assert!((theta - 2.0).abs() < 0.055, "{theta}");
}

#[test]
fn slip_is_reported_and_widens_the_covariance() {
    let (mut gripping, mut slipping) = (Drive::new(), Drive::new());
    gripping.drive_with_gyro(Twist2::new(0.3, 0.0), 0.0, 100);
    slipping.drive_with_gyro(Twist2::new(0.3, 0.0), 0.0, 50);
    // The right wheel spins: the wheels measure a turn, the gyro none. Noise shows that the gyro works.
    for _ in 0..25 {
        slipping.drive_with_gyro(Twist2::new(0.3, 0.8), 1e-4, 1);
        slipping.drive_with_gyro(Twist2::new(0.3, 0.8), -1e-4, 1);
    }
    assert!(
        matches!(slipping.odometry.report(), WheelReport::Slipping { rate } if (rate - 0.8).abs() < 0.03)
    );
    assert_eq!(slipping.odometry.counts().slipping, 50);
    assert_eq!(gripping.odometry.counts().slipping, 0);
    assert!(slipping.odometry.odometry().pose.theta.abs() < 1e-3);
    let sigma = |drive: &Drive| drive.odometry.odometry().covariance[(0, 0)].sqrt();
    assert!(sigma(&slipping) > 4.0 * sigma(&gripping), "{} {}", sigma(&slipping), sigma(&gripping));
}

#[test]
fn a_reading_from_the_past_is_reported_and_changes_nothing() {
    let mut drive = Drive::new();
    drive.drive(Twist2::new(0.5, 0.1), 50);
    let before = *drive.odometry.odometry();
    let old = WheelTicks { stamp: before.stamp.after(-0.5), left: 1, right: 2 };
    assert_eq!(drive.odometry.step_wheels(&old), before);
    assert!(matches!(drive.odometry.report(), WheelReport::TimeWentBack { by } if (by - 0.5).abs() < 1e-9));
    assert_eq!(drive.odometry.step_wheels(&drive.ticks()), before, "the same reading twice");
    assert_eq!(drive.odometry.counts().time_went_back, 2);
}

#[test]
fn a_gap_is_reported_and_widens_the_covariance_without_a_jump() {
    let mut drive = Drive::new();
    drive.drive(Twist2::new(0.5, 0.0), 50);
    let before = *drive.odometry.odometry();
    for _ in 0..100 {
        drive.roll(Twist2::new(0.5, 0.0));
    }
    let after = drive.read();
    assert!(matches!(drive.odometry.report(), WheelReport::Gap { length } if (length - 2.0).abs() < 1e-9));
    assert_eq!((after.pose, after.twist), (before.pose, Twist2::ZERO));
    assert!(after.covariance[(0, 0)].sqrt() > 0.5);
    drive.drive(Twist2::new(0.5, 0.0), 50);
    assert!((drive.odometry.odometry().pose.x - 1.0).abs() < 1e-3);
}

#[test]
fn a_broken_reading_is_rejected_and_a_counter_reset_is_detected() {
    let mut drive = Drive::new();
    drive.drive(Twist2::new(0.5, 0.0), 50);
    let before = *drive.odometry.odometry();

    drive.roll(Twist2::new(0.5, 0.0));
    let broken = WheelTicks { left: 30_000, ..drive.ticks() };
    assert_eq!(drive.odometry.step_wheels(&broken), before);
    assert!(matches!(drive.odometry.report(), WheelReport::TooFast { speed } if speed > 2.0));
    drive.drive(Twist2::new(0.5, 0.0), 49);
    assert!((drive.odometry.odometry().pose.x - 1.0).abs() < 1e-3, "one broken reading loses no distance");
    assert_eq!(drive.odometry.counts().too_fast, 1);

    (drive.left, drive.right) = (20_000.0, 20_000.0);
    drive.drive(Twist2::new(0.5, 0.0), 2);
    assert_eq!(drive.odometry.report(), WheelReport::Restarted);
    drive.drive(Twist2::new(0.5, 0.0), 50);
    assert!((drive.odometry.odometry().pose.x - 1.5).abs() < 1e-3);
    assert_eq!((drive.odometry.counts().too_fast, drive.odometry.counts().restarts), (2, 1));
}

#[test]
fn an_invalid_configuration_is_rejected_with_its_field() {
    let mut config = OdometryConfig::default();
    config.max_gap = f64::NAN;
    assert_eq!(WheelOdometry::new(DifferentialDrive::KOBUKI, config).unwrap_err().field, "max_gap");
}

#[test]
fn a_frozen_gyro_does_not_set_the_heading() {
    let mut drive = Drive::new();
    drive.drive_with_gyro(Twist2::ZERO, 0.0, 50);
    drive.drive_with_gyro(Twist2::new(0.0, 1.0), 0.0, 100);
    let theta = drive.odometry.odometry().pose.theta;
    assert!((theta - 2.0).abs() < 0.05, "{theta}");
}
