//! Laws of contact along an arc: sampled poses, the mirror, the margin, and the limit of a straight move.

use crate::support::{any_point, corners, polygon};
use proptest::prelude::*;
use trundle_collision::{RoundedHull, arc_contact};
use trundle_core::{Footprint, Pose2, Twist2, Vector2};

fn any_twist() -> impl Strategy<Value = Twist2> {
    (prop_oneof![Just(-0.4), Just(0.4)], -2.0..2.0_f64).prop_map(|(v, omega)| Twist2::new(v, omega))
}

/// The distance of a fixed point from the footprint after `distance` m along the arc of a twist, m.
fn gap_after(twist: Twist2, distance: f64, point: Vector2) -> f64 {
    let pose = Pose2::IDENTITY.advance(twist, distance / twist.v.abs());
    RoundedHull::exact(&polygon()).signed_distance(pose.inverse().transform(point))
}

proptest! {
    #[test]
    fn no_pose_before_the_contact_touches_and_the_pose_at_it_does(twist in any_twist(), point in any_point(), margin in 0.0..0.1_f64) {
        prop_assume!(gap_after(twist, 0.0, point) > margin + 1e-6);
        let contact = arc_contact(&RoundedHull::exact(&polygon()), twist, point, margin);
        // At most one full turn.
        let free = contact.unwrap_or(6.2 * (twist.v / twist.omega).abs().min(1.0));
        for i in 0..200 {
            let gap = gap_after(twist, free * f64::from(i) / 200.0, point);
            prop_assert!(gap >= margin - 1e-6, "{gap} m after {i} parts of {free} m");
        }
        if let Some(distance) = contact {
            prop_assert!((gap_after(twist, distance, point) - margin).abs() < 1e-6);
        }
    }

    #[test]
    fn a_mirrored_robot_meets_the_mirrored_point_after_the_same_distance(twist in any_twist(), point in any_point()) {
        let flip = |p: Vector2| Vector2::new(p.x, -p.y);
        let other = Footprint::polygon(corners().into_iter().map(flip).collect()).unwrap();
        let here = arc_contact(&RoundedHull::exact(&polygon()), twist, point, 0.02);
        let there = arc_contact(&RoundedHull::exact(&other), Twist2::new(twist.v, -twist.omega), flip(point), 0.02);
        prop_assert_eq!(here.is_some(), there.is_some());
        prop_assert!(here.zip(there).is_none_or(|(a, b)| (a - b).abs() < 1e-9), "{:?} {:?}", here, there);
    }

    #[test]
    fn the_speed_along_an_arc_does_not_change_the_distance(twist in any_twist(), point in any_point(), scale in 0.1..10.0_f64) {
        let hull = RoundedHull::exact(&polygon());
        let faster = Twist2::new(twist.v * scale, twist.omega * scale);
        let (slow, fast) = (arc_contact(&hull, twist, point, 0.02), arc_contact(&hull, faster, point, 0.02));
        prop_assert_eq!(slow.is_some(), fast.is_some());
        prop_assert!(slow.zip(fast).is_none_or(|(a, b)| (a - b).abs() < 1e-6));
    }

    #[test]
    fn a_larger_margin_never_lengthens_the_free_distance(twist in any_twist(), point in any_point(), margin in 0.0..0.1_f64) {
        let hull = RoundedHull::exact(&polygon());
        prop_assume!(gap_after(twist, 0.0, point) > margin + 0.01);
        if let Some(wide) = arc_contact(&hull, twist, point, margin) {
            let less = arc_contact(&hull, twist, point, margin + 0.005).expect("a contact with more margin too");
            prop_assert!(less <= wide + 1e-9);
        }
    }
}

#[test]
fn a_robot_at_rest_and_a_disc_that_turns_in_place_meet_nothing() {
    let (hull, disc) = (RoundedHull::exact(&polygon()), RoundedHull::exact(&Footprint::disc(0.2).unwrap()));
    let point = Vector2::new(0.3, 0.3);
    assert_eq!(arc_contact(&hull, Twist2::ZERO, point, 0.01), None);
    assert_eq!(arc_contact(&disc, Twist2::new(0.0, 1.0), point, 0.01), None);
}

#[test]
fn a_robot_that_touches_is_free_to_move_away_and_not_to_press_on() {
    let (hull, front) = (RoundedHull::exact(&polygon()), Vector2::new(0.4, 0.0));
    assert_eq!(arc_contact(&hull, Twist2::new(0.3, 0.0), front, 0.0), Some(0.0));
    assert_eq!(arc_contact(&hull, Twist2::new(-0.3, 0.0), front, 0.0), None);
}
