//! Decisions of the monitor, one input each.

use super::*;
use crate::safety::hold::MotionHold;
use crate::safety::safety_action::{SafetyAction, SafetyReport, SlowReason, StopReason};
use crate::safety::station_motion::StationMotion;
use proptest::prelude::*;
use trundle_collision::RoundedHull;

#[test]
fn without_images_or_wheels_it_stops_with_a_reason() {
    let twist = Twist2::new(0.3, 0.1);
    let now = Stamp::default().after(10.0);
    let reason = |input: SafetyInput<'_>| match monitor().check(&input) {
        SafetyReport { twist: Twist2::ZERO, action: SafetyAction::Stop(reason) } => reason,
        report => panic!("{report:?}"),
    };
    let input = SafetyInput { now, image: Some(now), wheels: Some(now), ..fresh(twist) };
    assert_eq!(monitor().check(&input).action, SafetyAction::Pass);
    assert_eq!(reason(SafetyInput { image: None, ..input }), StopReason::NoImage);
    assert_eq!(reason(SafetyInput { wheels: None, ..input }), StopReason::NoWheels);
    let old = Some(now.after(-1.0));
    assert_eq!(reason(SafetyInput { image: old, ..input }), StopReason::StaleImage { age: 1.0 });
    let turn = SafetyInput { image: old, twist: Twist2::new(0.0, 0.1), ..input };
    assert_eq!(monitor().check(&turn).twist, turn.twist, "a turn on the spot is not a risk");
    assert_eq!(reason(SafetyInput { wheels: old, ..input }), StopReason::StaleWheels { age: 1.0 });
    assert_eq!(reason(SafetyInput { twist: Twist2::new(f64::NAN, 0.0), ..input }), StopReason::NotFinite);
    assert_eq!(reason(SafetyInput { touched: true, ..input }), StopReason::Touched);
    assert_eq!(reason(SafetyInput { over_edge: true, ..input }), StopReason::Cliff);
    let hold = Some(MotionHold::WheelDrop);
    for twist in [twist, Twist2::new(-0.1, 0.0), Twist2::new(0.0, 0.5)] {
        let stop = reason(SafetyInput { hold, touched: true, twist, ..input });
        assert_eq!(stop, StopReason::Held(MotionHold::WheelDrop), "neither turns nor backing out pass");
    }
}

#[test]
fn contact_with_a_station_is_permitted_and_with_anything_else_is_not() {
    let (creep, now) = (Twist2::new(0.05, 0.0), Stamp::default().after(10.0));
    let wall = |range: f64| scan(-0.2, 0.05, &[range; 9]);
    let base_from_station = Pose2::new(0.2, 0.0, std::f64::consts::PI);
    let docking = Some(StationMotion::Docking { base_from_station, distance_error: 0.0 });
    let near = wall(0.2);
    let input = SafetyInput { scan: seen(&near), now, wheels: Some(now), ..fresh(creep) };
    assert_eq!(monitor().check(&SafetyInput { image: Some(now), ..input }).twist.v, 0.0);
    let docked = SafetyInput { station: docking, ..input };
    assert_eq!(monitor().check(&docked).twist, creep, "the image is 10 s old, and the station is ahead");
    assert_eq!(monitor().check(&SafetyInput { image: None, ..docked }).twist, creep);
    // Another speed, another obstacle, a pressed bumper, a cliff: as anywhere else.
    let fast = SafetyInput { twist: Twist2::new(0.2, 0.0), ..docked };
    assert_eq!(monitor().check(&fast).twist.v, 0.0);
    let base_from_station = Pose2::new(0.5, 0.0, std::f64::consts::PI);
    let far = Some(StationMotion::Docking { base_from_station, distance_error: 0.0 });
    assert_eq!(monitor().check(&SafetyInput { station: far, ..input }).twist.v, 0.0, "before the station");
    for blocked in [SafetyInput { touched: true, ..docked }, SafetyInput { over_edge: true, ..docked }] {
        assert_eq!(monitor().check(&blocked).twist, Twist2::ZERO);
    }
    let nothing = SafetyInput { motion: MotionSense::Nothing, ..docked };
    assert_eq!(monitor().check(&nothing).twist, Twist2::ZERO);
}

#[test]
fn a_robot_leaves_its_station_backward_though_its_camera_sees_nothing() {
    let back =
        SafetyInput { image: None, station: Some(StationMotion::Undocking), ..fresh(Twist2::new(-0.1, 0.0)) };
    assert_eq!(monitor().check(&back).twist.v, -0.1);
    assert_eq!(monitor().check(&SafetyInput { touched: true, ..back }).twist.v, -0.05);
    assert_eq!(monitor().check(&SafetyInput { station: None, ..back }).twist, Twist2::ZERO);
    assert_eq!(monitor().check(&SafetyInput { twist: Twist2::new(0.1, 0.0), ..back }).twist, Twist2::ZERO);
}

#[test]
fn a_robot_whose_wheels_count_nothing_drives_slowly_with_that_reason() {
    let twist = Twist2::new(0.5, 0.4);
    let report = monitor().check(&SafetyInput { motion: MotionSense::Sight, ..fresh(twist) });
    assert_eq!(report.action, SafetyAction::Slow(SlowReason::WheelsCountNothing));
    assert!((report.twist.v - 0.15).abs() < 1e-12 && (report.twist.omega - 0.12).abs() < 1e-12, "{report:?}");
    let creeping = SafetyInput { motion: MotionSense::Sight, ..fresh(Twist2::new(0.1, 0.4)) };
    assert_eq!(monitor().check(&creeping).action, SafetyAction::Pass);
    let nothing = SafetyInput { motion: MotionSense::Nothing, ..fresh(twist) };
    let stopped = SafetyAction::Stop(StopReason::NothingTellsMotion);
    assert_eq!(monitor().check(&nothing), SafetyReport { twist: Twist2::ZERO, action: stopped });
    let turn = SafetyInput { twist: Twist2::new(0.0, 0.4), ..nothing };
    assert_eq!(monitor().check(&turn).twist, turn.twist, "so it may come to see more");
}

#[test]
fn from_a_touch_it_backs_out_slowly() {
    let report = monitor().check(&SafetyInput { touched: true, ..fresh(Twist2::new(-0.3, 0.3)) });
    assert_eq!(report.action, SafetyAction::Slow(SlowReason::BackingOut));
    assert!((report.twist.v + 0.05).abs() < 1e-12 && (report.twist.omega - 0.05).abs() < 1e-12);
}

#[test]
fn lost_perception_it_leaves_what_it_touches_backward_and_turns_but_goes_no_further_on() {
    let now = Stamp::default().after(10.0);
    let old = SafetyInput { now, wheels: Some(now), touched: true, ..fresh(Twist2::new(-0.05, 0.0)) };
    assert_eq!(monitor().check(&old).twist, Twist2::new(-0.05, 0.0));
    let turn = Twist2::new(0.0, 0.5);
    assert_eq!(monitor().check(&SafetyInput { twist: turn, ..old }).twist, turn);
    assert_eq!(monitor().check(&SafetyInput { twist: turn, over_edge: true, ..old }).twist, Twist2::ZERO);
    assert_eq!(cart().check(&SafetyInput { twist: turn, ..old }).twist, Twist2::ZERO, "its corners sweep");
    let on = SafetyInput { twist: Twist2::new(0.1, 0.0), ..old };
    assert_eq!(monitor().check(&on).twist, Twist2::ZERO);
    assert_eq!(monitor().check(&SafetyInput { image: None, ..old }).twist, Twist2::ZERO);
}

#[test]
fn a_disc_turns_before_an_obstacle() {
    let wall = scan(-0.1, 0.01, &[0.2; 21]);
    let report = monitor().check(&SafetyInput { scan: seen(&wall), ..fresh(Twist2::new(0.3, 0.7)) });
    assert_eq!(report.twist, Twist2::new(0.0, 0.7));
    assert!(report.action.to_string().starts_with("stop: an obstacle in the way"), "{}", report.action);
    let away = monitor().check(&SafetyInput { scan: seen(&wall), ..fresh(Twist2::new(-0.1, 0.0)) });
    assert_eq!(away.action, SafetyAction::Pass);
}

#[test]
fn it_leaves_a_wall_within_the_margin() {
    // A wall along x, 5 mm from the disc.
    let distance: f64 = 0.1755 + 0.005;
    let bearing = |i: i32| (10.0 + 2.0 * f64::from(i)).to_radians();
    let ranges: Vec<f64> = (0..80).map(|i| distance / bearing(i).sin()).collect();
    let wall = scan(bearing(0), 2.0_f64.to_radians(), &ranges);
    let check =
        |v, omega| monitor().check(&SafetyInput { scan: seen(&wall), ..fresh(Twist2::new(v, omega)) });
    assert!(check(0.1, 0.0).twist.v > 0.0, "along it: {}", check(0.1, 0.0).action);
    assert!(check(0.1, -0.1).twist.v > 0.0, "away from it: {}", check(0.1, -0.1).action);
    assert!(check(0.1, 0.3).twist.v < 0.03, "into it: {}", check(0.1, 0.3).action);
}

#[test]
fn a_polygon_passes_a_gap_that_stops_its_disc_and_does_not_turn_there() {
    let half = 0.26_f64;
    let bearing = |i: i32| (-170.0 + 2.0 * f64::from(i)).to_radians();
    let ranges: Vec<f64> = (0..171).map(|i| half / bearing(i).sin().abs().max(1e-3)).collect();
    let walls = scan(bearing(0), 2.0_f64.to_radians(), &ranges);
    let check = |v, omega| cart().check(&SafetyInput { scan: seen(&walls), ..fresh(Twist2::new(v, omega)) });
    assert_eq!(check(0.1, 0.0).action, SafetyAction::Pass);
    let turn = check(0.0, 1.5);
    assert!(turn.twist.omega < 0.5 && turn.action != SafetyAction::Pass, "{turn:?}");
    let disc = Footprint::disc(0.4473).unwrap();
    let mut disc = SafetyMonitor::new(SafetyConfig::default(), &disc).unwrap();
    let straight = disc.check(&SafetyInput { scan: seen(&walls), ..fresh(Twist2::new(0.1, 0.0)) });
    assert_eq!(straight.twist.v, 0.0);
}

#[test]
fn a_turn_stops_before_the_corner_meets_the_wall() {
    // A post that the front left corner comes to after some 30 deg.
    let (mut theta, mut rate) = (0.0_f64, 0.0_f64);
    let post = Vector2::new(0.0, 0.44);
    let mut min = f64::INFINITY;
    for _ in 0..400 {
        let at = Pose2::new(0.0, 0.0, theta).inverse().transform(post);
        let scan = scan(at.y.atan2(at.x), 0.01, &[at.norm()]);
        let twist = cart().check(&SafetyInput { scan: seen(&scan), ..fresh(Twist2::new(0.0, 2.0)) }).twist;
        // The base follows the command within the monitor's assumption.
        rate = twist.omega.clamp(rate - 3.0 * 0.02, rate + 3.0 * 0.02);
        theta += rate * 0.02;
        let at = Pose2::new(0.0, 0.0, theta).inverse().transform(post);
        min = min.min(RoundedHull::exact(&cart_outline()).signed_distance(at));
    }
    assert!(min > 0.005 && theta > 0.5, "{min} m left after {theta} rad");
}

proptest! {
    #[test]
    fn a_command_is_only_slowed_on_its_own_curve(
        (v, omega) in (-0.7..0.7, -3.0..3.0),
        ranges in prop::collection::vec(0.1..4.0, 40),
    ) {
        let scan = scan(-0.6, 0.03, &ranges);
        let twist = Twist2::new(v, omega);
        let report = monitor().check(&SafetyInput { scan: seen(&scan), ..fresh(twist) });
        let bent = report.twist.omega * twist.v - twist.omega * report.twist.v;
        prop_assert!(report.twist.v.abs() <= v.abs() && report.twist.v * v >= 0.0);
        prop_assert!(report.twist.v == 0.0 || bent.abs() < 1e-9);
        prop_assert!(report.twist.omega.abs() <= omega.abs());
    }
}

#[test]
fn a_stamp_ahead_of_the_clock_is_as_useless_as_an_old_one() {
    let now = Stamp::default().after(10.0);
    let (soon, ahead) = (Some(now.after(0.1)), Some(now.after(1.0)));
    let input = SafetyInput { now, image: soon, wheels: soon, ..fresh(Twist2::new(0.3, 0.0)) };
    assert_eq!(monitor().check(&input).action, SafetyAction::Pass, "clocks differ by 0.1 s");
    let wheels = monitor().check(&SafetyInput { wheels: ahead, ..input });
    assert_eq!(wheels.twist, Twist2::ZERO);
    assert!(wheels.action.to_string().contains("1.00 s ahead of the clock"), "{}", wheels.action);
    let image = monitor().check(&SafetyInput { image: ahead, ..input });
    assert_eq!(image, SafetyReport::stop(StopReason::StaleImage { age: -1.0 }));
}

#[test]
fn out_of_a_contact_it_backs_up_to_an_obstacle_behind_and_not_into_it() {
    let behind = |range: f64| scan(std::f64::consts::PI, 0.1, &[range]);
    let back = |range: f64| {
        let wall = behind(range);
        let touched = SafetyInput { touched: true, scan: seen(&wall), ..fresh(Twist2::new(-0.05, 0.0)) };
        monitor().check(&touched)
    };
    assert_eq!(back(0.3).twist.v, -0.05);
    assert_eq!(back(0.3).action, SafetyAction::Pass);
    let near = back(0.1755 + 0.015);
    assert!(near.twist.v < 0.0 && near.twist.v > -0.05, "{near:?}");
    let at = back(0.1755 + 0.002);
    assert_eq!(at.twist, Twist2::ZERO);
    assert!(matches!(at.action, SafetyAction::Stop(StopReason::ObstacleAhead { .. })), "{}", at.action);
}

#[test]
fn without_a_view_a_polygon_turns_only_where_its_corners_are_free() {
    let now = Stamp::default().after(10.0);
    let turn = |y: f64| {
        let post = scan(y.atan2(0.0), 0.1, &[y]);
        let blind = SafetyInput { now, wheels: Some(now), scan: seen(&post), ..fresh(Twist2::new(0.0, 1.0)) };
        cart().check(&blind)
    };
    assert_eq!(turn(0.5).twist.omega, 1.0, "beyond the corners");
    assert_eq!(turn(0.21).twist.omega, 0.0);
    assert_eq!(turn(0.5).action, SafetyAction::Stop(StopReason::StaleImage { age: 10.0 }));
}

#[test]
fn over_an_edge_no_turn_takes_the_place_of_a_blocked_way_back() {
    let behind = scan(std::f64::consts::PI, 0.1, &[0.1755 + 0.002]);
    for omega in [0.5, -0.5] {
        for (touched, over_edge) in [(false, true), (true, false)] {
            let back =
                SafetyInput { touched, over_edge, scan: seen(&behind), ..fresh(Twist2::new(-0.05, omega)) };
            assert_eq!(monitor().check(&back).twist, Twist2::ZERO, "{omega} {touched}");
        }
    }
}
