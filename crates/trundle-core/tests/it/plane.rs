//! Laws of SE(2): group, action on points, exponential map, arcs and interpolation.

use proptest::prelude::*;
use std::f64::consts::PI;
use trundle_core::{Pose2, Twist2, Vector2, Vector3, wrap_angle};

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-50.0..50.0, -50.0..50.0, -PI..PI).prop_map(|(x, y, t)| Pose2::new(x, y, t))
}

fn any_point() -> impl Strategy<Value = Vector2> {
    (-50.0..50.0, -50.0..50.0).prop_map(|(x, y)| Vector2::new(x, y))
}

fn any_twist() -> impl Strategy<Value = Twist2> {
    (-1.0..1.0, -2.0..2.0).prop_map(|(v, omega)| Twist2::new(v, omega))
}

fn close(a: Pose2, b: Pose2) -> bool {
    a.distance(&b) < 1e-9 && wrap_angle(a.theta - b.theta).abs() < 1e-11
}

/// The end of a constant twist by the midpoint rule in many small steps.
fn integrated(start: Pose2, twist: Twist2, time: f64) -> Pose2 {
    let steps = 20_000;
    let dt = time / f64::from(steps);
    (0..steps).fold(start, |pose, _| {
        let middle = pose.theta + twist.omega * dt / 2.0;
        let moved = pose.position() + Vector2::new(middle.cos(), middle.sin()) * twist.v * dt;
        Pose2::new(moved.x, moved.y, pose.theta + twist.omega * dt)
    })
}

proptest! {
    #[test]
    fn the_identity_is_neutral_on_both_sides_and_the_inverse_works_on_both(a in any_pose()) {
        prop_assert!(close(a * Pose2::IDENTITY, a) && close(Pose2::IDENTITY * a, a));
        prop_assert!(close(a.inverse() * a, Pose2::IDENTITY) && close(a * a.inverse(), Pose2::IDENTITY));
        prop_assert!(close(a.inverse().inverse(), a));
    }

    #[test]
    fn the_inverse_of_a_product_is_the_product_of_the_inverses_in_reverse(a in any_pose(), b in any_pose()) {
        prop_assert!(close((a * b).inverse(), b.inverse() * a.inverse()));
    }

    #[test]
    fn a_product_maps_points_as_its_factors_do_one_after_the_other(a in any_pose(), b in any_pose(), p in any_point()) {
        prop_assert!(((a * b).transform(p) - a.transform(b.transform(p))).norm() < 1e-9);
        prop_assert!((a.inverse().transform(a.transform(p)) - p).norm() < 1e-9);
    }

    #[test]
    fn poses_keep_distances_and_orientation(a in any_pose(), p in any_point(), q in any_point()) {
        let (moved_p, moved_q) = (a.rotate(p), a.rotate(q));
        prop_assert!((a.transform(p) - a.transform(q) - (moved_p - moved_q)).norm() < 1e-9);
        prop_assert!((moved_p.norm() - p.norm()).abs() < 1e-9);
        prop_assert!((moved_p.perp(&moved_q) - p.perp(&q)).abs() < 1e-8);
    }

    #[test]
    fn a_common_change_of_frame_keeps_the_distance_of_two_poses(g in any_pose(), a in any_pose(), b in any_pose()) {
        prop_assert!(((g * a).distance(&(g * b)) - a.distance(&b)).abs() < 1e-9);
    }

    #[test]
    fn log_undoes_exp_below_half_a_turn(x in -9.0..9.0_f64, y in -9.0..9.0_f64, w in -3.1..3.1_f64) {
        let tangent = Vector3::new(x, y, w);
        prop_assert!((Pose2::exp(tangent).log() - tangent).norm() < 1e-9);
    }

    #[test]
    fn the_inverse_has_the_negative_logarithm(a in any_pose()) {
        prop_assume!(a.theta.abs() < 3.1);
        prop_assert!((a.inverse().log() + a.log()).norm() < 1e-8);
    }

    #[test]
    fn one_direction_of_the_tangent_space_is_a_commutative_group(
        x in -3.0..3.0_f64, y in -3.0..3.0_f64, w in -1.5..1.5_f64, s in -1.0..1.0_f64, t in -1.0..1.0_f64,
    ) {
        let tangent = Vector3::new(x, y, w);
        let (a, b) = (Pose2::exp(tangent * s), Pose2::exp(tangent * t));
        prop_assert!(close(a * b, Pose2::exp(tangent * (s + t))));
        prop_assert!(close(a * b, b * a));
    }

    #[test]
    fn two_advances_are_one_of_the_summed_time(a in any_pose(), twist in any_twist(), s in 0.0..3.0_f64, t in 0.0..3.0_f64) {
        prop_assert!(close(a.advance(twist, s).advance(twist, t), a.advance(twist, s + t)));
    }

    #[test]
    fn a_twist_backward_in_time_leads_back(a in any_pose(), twist in any_twist(), t in 0.0..5.0_f64) {
        let back = Twist2::new(-twist.v, -twist.omega);
        prop_assert!(close(a.advance(twist, t).advance(back, t), a));
        prop_assert!(close(a.advance(twist, -t), a.advance(back, t)));
    }

    #[test]
    fn an_advance_is_seen_alike_from_every_frame(g in any_pose(), a in any_pose(), twist in any_twist()) {
        prop_assert!(close((g * a).advance(twist, 0.7), g * a.advance(twist, 0.7)));
    }

    #[test]
    fn the_chord_of_an_arc_follows_from_its_length_and_its_turn(a in any_pose(), twist in any_twist(), t in 0.0..2.0_f64) {
        let (turn, length) = (twist.omega * t, (twist.v * t).abs());
        let chord = if turn.abs() < 1e-6 { length } else { length * (2.0 * (turn / 2.0).sin() / turn).abs() };
        prop_assert!((a.distance(&a.advance(twist, t)) - chord).abs() < 1e-9);
    }

    #[test]
    fn interpolation_starts_at_one_pose_and_ends_at_the_other(a in any_pose(), b in any_pose(), f in 0.0..1.0_f64) {
        prop_assert!(close(a.interpolate(&b, 0.0), a) && close(a.interpolate(&b, 1.0), b));
        let between = a.interpolate(&b, f);
        prop_assert!((a.distance(&between) - f * a.distance(&b)).abs() < 1e-9);
        let turned = wrap_angle(between.theta - a.theta).abs() + wrap_angle(b.theta - between.theta).abs();
        prop_assert!((turned - wrap_angle(b.theta - a.theta).abs()).abs() < 1e-9);
    }
}

#[test]
fn an_advance_is_the_integral_of_its_twist() {
    let start = Pose2::new(1.0, -2.0, 2.5);
    for twist in
        [Twist2::new(0.7, 0.0), Twist2::new(0.5, 1.3), Twist2::new(-0.4, -2.0), Twist2::new(0.3, 1e-7)]
    {
        let (exact, stepped) = (start.advance(twist, 2.0), integrated(start, twist, 2.0));
        assert!(exact.distance(&stepped) < 1e-8, "{twist:?}: {exact:?} {stepped:?}");
        assert!(wrap_angle(exact.theta - stepped.theta).abs() < 1e-9, "{twist:?}");
    }
}

#[test]
fn the_series_of_the_exponential_map_meets_its_closed_form() {
    for sign in [-1.0, 1.0] {
        let below = Pose2::exp(Vector3::new(3.0, -2.0, sign * 0.999_999e-5));
        let above = Pose2::exp(Vector3::new(3.0, -2.0, sign * 1.000_001e-5));
        assert!(below.distance(&above) < 1e-10, "{sign}");
    }
}

#[test]
fn headings_are_wrapped_by_construction_and_composition() {
    assert!((Pose2::new(0.0, 0.0, 7.0).theta - (7.0 - 2.0 * PI)).abs() < 1e-12);
    let half = Pose2::new(0.0, 0.0, 2.0);
    assert!(((half * half).theta - (4.0 - 2.0 * PI)).abs() < 1e-12);
}

#[test]
fn interpolation_turns_the_shorter_way_across_half_a_turn() {
    let (a, b) = (Pose2::new(0.0, 0.0, 3.0), Pose2::new(0.0, 0.0, -3.0));
    assert!(wrap_angle(a.interpolate(&b, 0.5).theta - PI).abs() < 1e-12);
}

#[test]
fn the_direction_is_the_image_of_the_x_axis() {
    let pose = Pose2::new(4.0, 5.0, 2.2);
    assert!((pose.direction() - pose.rotate(Vector2::new(1.0, 0.0))).norm() < 1e-15);
}

#[test]
fn one_number_that_is_not_finite_makes_pose_and_twist_not_finite() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for i in 0..3 {
            let mut numbers = [0.0; 3];
            numbers[i] = bad;
            let pose = Pose2 { x: numbers[0], y: numbers[1], theta: numbers[2] };
            assert!(!pose.is_finite(), "{pose:?}");
        }
        assert!(!Twist2::new(bad, 0.0).is_finite() && !Twist2::new(0.0, bad).is_finite());
    }
    assert!(Pose2::IDENTITY.is_finite() && Twist2::ZERO.is_finite());
}
