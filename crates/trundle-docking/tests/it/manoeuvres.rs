//! Laws of manoeuvres and of the speed profiles of their motions.

use crate::common::mirrored;
use proptest::prelude::*;
use trundle_core::{Pose2, Twist2, Vector2, wrap_angle};
use trundle_docking::{Manoeuvre, Motion, MotionLimits};

fn any_motion() -> impl Strategy<Value = Motion> {
    prop_oneof![(-4.0..4.0_f64).prop_map(Motion::Turn), (-2.0..2.0_f64).prop_map(Motion::Drive)]
}

fn any_motions() -> impl Strategy<Value = Vec<Motion>> {
    prop::collection::vec(any_motion(), 0..8)
}

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-3.0..3.0_f64, -3.0..3.0_f64, -3.1..3.1_f64).prop_map(|(x, y, t)| Pose2::new(x, y, t))
}

fn any_limits() -> impl Strategy<Value = MotionLimits> {
    (0.05..1.0_f64, 0.1..2.0_f64, 0.1..3.0_f64, 0.5..10.0_f64, 0.0..1.0_f64).prop_map(
        |(v, a, w, b, pause)| MotionLimits {
            speed: v,
            acceleration: a,
            turn_rate: w,
            angular_acceleration: b,
            switch_time: pause,
        },
    )
}

fn close(a: &Pose2, b: &Pose2) -> bool {
    a.distance(b) < 1e-9 && wrap_angle(a.theta - b.theta).abs() < 1e-9
}

fn negated(motion: &Motion) -> Motion {
    match motion {
        Motion::Turn(angle) => Motion::Turn(-angle),
        Motion::Drive(distance) => Motion::Drive(-distance),
    }
}

/// The motions of a manoeuvre.
fn motions_of(manoeuvre: &Manoeuvre) -> Vec<Motion> {
    manoeuvre.steps().iter().map(|step| step.motion).collect()
}

proptest! {
    #[test]
    fn the_end_is_that_of_the_motions_one_after_the_other(start in any_pose(), motions in any_motions()) {
        let end = motions.iter().fold(start, |pose, motion| motion.after(pose, motion.amount()));
        let manoeuvre = Manoeuvre::new(start, &motions, MotionLimits::default());
        prop_assert!(close(&manoeuvre.end(), &end));
        prop_assert_eq!(manoeuvre.start(), start);
    }

    #[test]
    fn steps_follow_each_other_with_a_pause_and_the_duration_is_their_sum(
        start in any_pose(), motions in any_motions(), limits in any_limits(),
    ) {
        let manoeuvre = Manoeuvre::new(start, &motions, limits);
        for pair in manoeuvre.steps().windows(2) {
            prop_assert_eq!(pair[0].to, pair[1].from);
            prop_assert!((pair[0].starts + pair[0].lasts + limits.switch_time - pair[1].starts).abs() < 1e-12);
        }
        let moving: f64 = manoeuvre.steps().iter().map(|step| step.motion.time(&limits)).sum();
        let pauses = manoeuvre.steps().len().saturating_sub(1) as f64 * limits.switch_time;
        prop_assert!((manoeuvre.duration() - moving - pauses).abs() < 1e-9);
    }

    #[test]
    fn no_step_is_empty_and_turns_and_straight_moves_alternate(start in any_pose(), motions in any_motions()) {
        let manoeuvre = Manoeuvre::new(start, &motions, MotionLimits::default());
        let is_turn = |motion: Motion| matches!(motion, Motion::Turn(_));
        for step in manoeuvre.steps() {
            prop_assert!(step.motion.amount().abs() > 1e-7);
        }
        for pair in manoeuvre.steps().windows(2) {
            prop_assert_ne!(is_turn(pair[0].motion), is_turn(pair[1].motion));
        }
    }

    #[test]
    fn the_motions_in_reverse_lead_back_in_the_same_time(
        start in any_pose(), motions in any_motions(), limits in any_limits(),
    ) {
        let forth = Manoeuvre::new(start, &motions, limits);
        let reversed: Vec<Motion> = motions_of(&forth).iter().rev().map(negated).collect();
        let back = Manoeuvre::new(forth.end(), &reversed, limits);
        prop_assert!(close(&back.end(), &start));
        prop_assert!((back.duration() - forth.duration()).abs() < 1e-9);
        for i in 0..=10 {
            let time = forth.duration() * f64::from(i) / 10.0;
            prop_assert!(close(&forth.at(time).0, &back.at(forth.duration() - time).0));
        }
    }

    #[test]
    fn mirrored_turns_lead_through_mirrored_poses(start in any_pose(), motions in any_motions(), part in 0.0..1.0_f64) {
        let limits = MotionLimits::default();
        let mirror = |motion: &Motion| if let Motion::Turn(angle) = motion { Motion::Turn(-angle) } else { *motion };
        let flipped: Vec<Motion> = motions.iter().map(mirror).collect();
        let (one, other) = (Manoeuvre::new(start, &motions, limits), Manoeuvre::new(mirrored(start), &flipped, limits));
        let ((pose, twist), (image, image_twist)) = (one.at(part * one.duration()), other.at(part * one.duration()));
        prop_assert!(close(&mirrored(pose), &image));
        prop_assert!((twist.v - image_twist.v).abs() < 1e-9 && (twist.omega + image_twist.omega).abs() < 1e-9);
    }

    #[test]
    fn a_change_of_frame_moves_every_pose_alike(
        frame in any_pose(), start in any_pose(), motions in any_motions(), part in 0.0..1.0_f64,
    ) {
        let limits = MotionLimits::default();
        let (here, there) = (Manoeuvre::new(start, &motions, limits), Manoeuvre::new(frame * start, &motions, limits));
        let time = part * here.duration();
        prop_assert!(close(&(frame * here.at(time).0), &there.at(time).0));
    }

    #[test]
    fn the_twist_is_the_derivative_of_the_pose(
        start in any_pose(), motions in any_motions(), limits in any_limits(), part in 0.0..1.0_f64,
    ) {
        let manoeuvre = Manoeuvre::new(start, &motions, limits);
        let (time, dt) = (part * manoeuvre.duration(), 1e-6);
        let ((pose, twist), (soon, _)) = (manoeuvre.at(time), manoeuvre.at(time + dt));
        let moved: Vector2 = (soon.position() - pose.position()) / dt;
        prop_assert!((moved - pose.direction() * twist.v).norm() < 1e-4);
        prop_assert!((wrap_angle(soon.theta - pose.theta) / dt - twist.omega).abs() < 1e-4);
    }

    #[test]
    fn speeds_and_accelerations_keep_their_limits_and_turns_never_mix_with_straight_moves(
        start in any_pose(), motions in any_motions(), limits in any_limits(), part in 0.0..1.0_f64,
    ) {
        let manoeuvre = Manoeuvre::new(start, &motions, limits);
        let (time, dt) = (part * manoeuvre.duration(), 1e-4);
        let (now, soon) = (manoeuvre.at(time).1, manoeuvre.at(time + dt).1);
        prop_assert!(now.v.abs() <= limits.speed + 1e-9 && now.omega.abs() <= limits.turn_rate + 1e-9);
        prop_assert!(now.v == 0.0 || now.omega == 0.0);
        if limits.switch_time > dt {
            prop_assert!((soon.v - now.v).abs() <= limits.acceleration * dt + 1e-9);
            prop_assert!((soon.omega - now.omega).abs() <= limits.angular_acceleration * dt + 1e-9);
        }
    }

    #[test]
    fn the_robot_rests_before_after_and_in_every_pause(start in any_pose(), motions in any_motions(), far in 0.0..9.0_f64) {
        let manoeuvre = Manoeuvre::new(start, &motions, MotionLimits::default());
        prop_assert_eq!(manoeuvre.at(-1e-9 - far), (start, Twist2::ZERO));
        prop_assert_eq!(manoeuvre.at(manoeuvre.duration() + 1e-9 + far), (manoeuvre.end(), Twist2::ZERO));
        for pair in manoeuvre.steps().windows(2) {
            let middle = (pair[0].starts + pair[0].lasts + pair[1].starts) / 2.0;
            prop_assert_eq!(manoeuvre.at(middle), (pair[0].to, Twist2::ZERO));
        }
    }

    #[test]
    fn a_profile_is_symmetric_about_its_middle(distance in -3.0..3.0_f64, limits in any_limits(), part in 0.0..1.0_f64) {
        let total = limits.drive_time(distance);
        let ((done, speed), (rest, slow)) = (limits.drive_at(distance, part * total), limits.drive_at(distance, (1.0 - part) * total));
        prop_assert!((done + rest - distance).abs() < 1e-9 && (speed - slow).abs() < 1e-9);
    }

    #[test]
    fn both_directions_take_the_same_time_and_farther_takes_longer(
        distance in 0.0..3.0_f64, more in 1e-3..1.0_f64, limits in any_limits(),
    ) {
        prop_assert_eq!(limits.drive_time(distance), limits.drive_time(-distance));
        prop_assert_eq!(limits.turn_time(distance), limits.turn_time(-distance));
        prop_assert!(limits.drive_time(distance + more) > limits.drive_time(distance));
        prop_assert!(limits.turn_time(distance + more) > limits.turn_time(distance));
    }

    #[test]
    fn no_profile_is_faster_than_top_speed_or_full_acceleration_allow(distance in 0.0..3.0_f64, limits in any_limits()) {
        let time = limits.drive_time(distance);
        prop_assert!(time + 1e-12 >= distance / limits.speed);
        prop_assert!(time + 1e-12 >= 2.0 * (distance / limits.acceleration).sqrt());
    }

    #[test]
    fn a_scaled_robot_at_scaled_speeds_takes_the_same_time(distance in 0.0..3.0_f64, limits in any_limits(), scale in 0.1..10.0_f64) {
        let scaled = MotionLimits { speed: scale * limits.speed, acceleration: scale * limits.acceleration, ..limits };
        prop_assert!((scaled.drive_time(scale * distance) - limits.drive_time(distance)).abs() < 1e-9);
    }
}

#[test]
fn a_manoeuvre_without_motions_takes_no_time_and_stays() {
    let start = Pose2::new(1.0, 2.0, 0.5);
    let still = Manoeuvre::new(start, &[Motion::Turn(0.0), Motion::Drive(1e-9)], MotionLimits::default());
    assert_eq!((still.duration(), still.end(), still.at(1.0)), (0.0, start, (start, Twist2::ZERO)));
    assert!(still.steps().is_empty());
}

#[test]
fn neighbours_of_one_kind_are_one_motion_also_where_the_motion_between_them_cancels() {
    let limits = MotionLimits::default();
    let motions = |list: &[Motion]| motions_of(&Manoeuvre::new(Pose2::IDENTITY, list, limits));
    let (turn, drive) = (Motion::Turn, Motion::Drive);
    assert_eq!(motions(&[turn(0.5), turn(0.25), drive(1.0)]), [turn(0.75), drive(1.0)]);
    assert_eq!(motions(&[turn(0.5), drive(1.0), drive(-1.0), turn(0.25)]), [turn(0.75)]);
    assert_eq!(motions(&[drive(0.5), turn(1.0), turn(-1.0), drive(-0.5)]), []);
    assert_eq!(motions(&[turn(2.0), turn(2.0)]), [turn(4.0)]);
}

#[test]
fn a_turn_of_more_than_half_a_turn_goes_the_longer_way_round() {
    let manoeuvre = Manoeuvre::new(Pose2::IDENTITY, &[Motion::Turn(4.0)], MotionLimits::default());
    assert!((manoeuvre.end().theta - wrap_angle(4.0)).abs() < 1e-12);
    assert!((manoeuvre.at(manoeuvre.duration() / 2.0).0.theta - 2.0).abs() < 1e-9);
    assert!((manoeuvre.duration() - MotionLimits::default().turn_time(4.0)).abs() < 1e-12);
}

#[test]
fn each_direction_has_its_word() {
    let words =
        [Motion::Turn(-1.0), Motion::Turn(1.0), Motion::Drive(-1.0), Motion::Drive(1.0)].map(|m| m.word());
    assert_eq!(words, ["clockwise", "counter-clockwise", "back", "forward"]);
}
