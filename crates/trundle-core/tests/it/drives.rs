//! Laws of the differential drive and its limits.

use proptest::prelude::*;
use std::f64::consts::TAU;
use trundle_core::{DifferentialDrive, DriveLimits, Pose2, Twist2};

fn any_twist() -> impl Strategy<Value = Twist2> {
    (-5.0..5.0_f64, -20.0..20.0_f64).prop_map(|(v, omega)| Twist2::new(v, omega))
}

proptest! {
    #[test]
    fn wheel_speeds_invert_the_twist(left in -2.0..2.0_f64, right in -2.0..2.0_f64) {
        let drive = DifferentialDrive::KOBUKI;
        let (again_left, again_right) = drive.wheel_speeds(drive.twist(left, right));
        prop_assert!((again_left - left).abs() < 1e-12 && (again_right - right).abs() < 1e-12);
    }

    #[test]
    fn a_saturated_twist_keeps_every_speed_limit(twist in any_twist(), wheelbase in 0.05..0.6_f64) {
        let limits = DriveLimits::KOBUKI;
        let kept = limits.saturate(twist, wheelbase);
        prop_assert!(kept.v.abs() <= limits.v + 1e-9 && kept.omega.abs() <= limits.omega + 1e-9);
        prop_assert!(kept.v.abs() + wheelbase / 2.0 * kept.omega.abs() <= limits.wheel_speed + 1e-9);
    }

    #[test]
    fn saturation_keeps_curvature_and_signs(twist in any_twist(), wheelbase in 0.05..0.6_f64) {
        let kept = DriveLimits::KOBUKI.saturate(twist, wheelbase);
        prop_assert!((kept.v * twist.omega - kept.omega * twist.v).abs() < 1e-9);
        prop_assert!(kept.v * twist.v >= 0.0 && kept.omega * twist.omega >= 0.0);
        prop_assert!(kept.v.abs() <= twist.v.abs() && kept.omega.abs() <= twist.omega.abs());
    }

    #[test]
    fn saturating_twice_is_saturating_once(twist in any_twist()) {
        let limits = DriveLimits::KOBUKI;
        let once = limits.saturate(twist, 0.23);
        let twice = limits.saturate(once, 0.23);
        prop_assert!((twice.v - once.v).abs() < 1e-12 && (twice.omega - once.omega).abs() < 1e-12);
    }

    #[test]
    fn a_twist_within_the_limits_is_left_as_it_is(v in -0.3..0.3_f64, omega in -3.0..3.0_f64) {
        prop_assert_eq!(DriveLimits::KOBUKI.saturate(Twist2::new(v, omega), 0.23), Twist2::new(v, omega));
    }
}

#[test]
fn one_turn_of_a_wheel_moves_it_by_its_circumference() {
    let drive = DifferentialDrive::KOBUKI;
    assert!((drive.metres_per_tick() * drive.ticks_per_turn - TAU * drive.wheel_radius).abs() < 1e-15);
}

#[test]
fn wheels_that_turn_against_each_other_turn_the_base_on_the_spot_to_the_left() {
    let drive = DifferentialDrive::KOBUKI;
    let twist = drive.twist(-0.1, 0.1);
    assert_eq!(twist.v, 0.0);
    let turned = Pose2::IDENTITY.advance(twist, 1.0);
    assert!(turned.distance(&Pose2::IDENTITY) < 1e-15 && (turned.theta - 0.2 / 0.23).abs() < 1e-12);
}

#[test]
fn the_wheel_on_the_outside_of_a_curve_is_the_faster_one() {
    let (left, right) = DifferentialDrive::KOBUKI.wheel_speeds(Twist2::new(0.3, 1.0));
    assert!(right > left && ((left + right) / 2.0 - 0.3).abs() < 1e-15);
}

#[test]
fn the_presets_are_valid() {
    assert_eq!(DifferentialDrive::default().validated(), Ok(DifferentialDrive::KOBUKI));
    assert_eq!(DriveLimits::default().validated(), Ok(DriveLimits::KOBUKI));
}
