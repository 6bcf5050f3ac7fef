//! Laws of segments, oriented boxes and heading intervals.

use crate::support::{any_point, any_pose, any_segment, hull};
use proptest::prelude::*;
use std::f64::consts::TAU;
use trundle_collision::{HeadingArc, OrientedBox, Segment, wrap_positive};
use trundle_core::Vector2;

proptest! {
    #[test]
    fn the_nearest_point_of_a_segment_lies_on_it_and_no_other_is_nearer(segment in any_segment(), p in any_point(), t in 0.0..1.0_f64) {
        let nearest = segment.nearest(p);
        let detour = (nearest - segment.a).norm() + (nearest - segment.b).norm();
        prop_assert!((detour - (segment.b - segment.a).norm()).abs() < 1e-9);
        let other = segment.a + (segment.b - segment.a) * t;
        prop_assert!((other - p).norm() >= segment.distance(p) - 1e-12);
    }

    #[test]
    fn the_distance_of_two_segments_is_symmetric_and_below_that_of_any_two_points(
        s in any_segment(), t in any_segment(), u in 0.0..1.0_f64, v in 0.0..1.0_f64,
    ) {
        prop_assert!((s.distance_to(&t) - t.distance_to(&s)).abs() < 1e-12);
        let (p, q) = (s.a + (s.b - s.a) * u, t.a + (t.b - t.a) * v);
        prop_assert!((p - q).norm() >= s.distance_to(&t) - 1e-12);
    }

    #[test]
    fn a_change_of_frame_keeps_the_distances_of_segments(s in any_segment(), t in any_segment(), pose in any_pose()) {
        let (sin, cos) = pose.theta.sin_cos();
        let seen = |segment: &Segment| segment.in_frame(pose.position(), cos, sin);
        prop_assert!((seen(&s).distance_to(&seen(&t)) - s.distance_to(&t)).abs() < 1e-9);
    }

    #[test]
    fn the_signed_distance_of_a_hull_changes_by_at_most_the_step(p in any_point(), q in any_point(), margin in 0.0..0.1_f64) {
        let hull = hull(margin);
        let change = (hull.signed_distance(p) - hull.signed_distance(q)).abs();
        prop_assert!(change <= (p - q).norm() + 1e-9);
        prop_assert_eq!(hull.signed_distance(p) < -1e-9, hull.overlaps(&Segment::point(p)) && hull.signed_distance(p).abs() > 1e-9);
    }

    #[test]
    fn a_box_of_one_point_is_that_point(p in any_point()) {
        let bounds = OrientedBox::point(p);
        prop_assert!((bounds.distance_from_origin() - p.norm()).abs() < 1e-12);
        prop_assert_eq!((bounds.half_angle(), bounds.extent()), (0.0, Vector2::zeros()));
    }

    #[test]
    fn the_free_turns_from_a_heading_end_at_the_two_ends_of_an_interval(start in 0.0..TAU, length in 0.0..6.2_f64, heading in -3.1..3.1_f64) {
        let arc = HeadingArc { start, length };
        let (left, right) = arc.free_turn_from(heading);
        if (left, right) == (0.0, 0.0) {
            prop_assert!((heading - start).rem_euclid(TAU) <= length + 1e-9);
        } else {
            let apart = |a: f64, b: f64| { let d = (a - b).rem_euclid(TAU); d.min(TAU - d) };
            prop_assert!(apart(heading + left, start) < 1e-9 && apart(heading - right, start + length) < 1e-9);
            prop_assert!((left + right + length - TAU).abs() < 1e-9);
        }
    }

    #[test]
    fn a_wrapped_angle_is_positive_and_below_a_turn(angle in -6.2..12.5_f64) {
        let wrapped = wrap_positive(angle);
        prop_assert!((0.0..=TAU).contains(&wrapped));
        prop_assert!((wrapped.sin() - angle.sin()).abs() < 1e-9 && (wrapped.cos() - angle.cos()).abs() < 1e-9);
    }
}

#[test]
fn all_headings_leave_no_free_turn() {
    assert_eq!(HeadingArc::FULL.free_turn_from(1.0), (0.0, 0.0));
}
