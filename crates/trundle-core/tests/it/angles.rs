//! Laws of angles.

use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use trundle_core::{difference_of_angles, wrap_angle};

proptest! {
    #[test]
    fn a_wrapped_angle_lies_in_the_half_open_circle_and_points_the_same_way(angle in -1e3..1e3_f64) {
        let wrapped = wrap_angle(angle);
        prop_assert!(wrapped > -PI && wrapped <= PI);
        prop_assert!((wrapped.sin() - angle.sin()).abs() < 1e-11 && (wrapped.cos() - angle.cos()).abs() < 1e-11);
    }

    #[test]
    fn wrapping_twice_is_wrapping_once(angle in -1e6..1e6_f64) {
        prop_assert_eq!(wrap_angle(wrap_angle(angle)), wrap_angle(angle));
    }

    #[test]
    fn whole_turns_change_nothing(angle in -3.1..3.1_f64, turns in -100_i32..100) {
        prop_assert!((wrap_angle(angle + TAU * f64::from(turns)) - angle).abs() < 1e-12);
    }

    #[test]
    fn the_difference_leads_from_one_angle_to_the_other_by_at_most_half_a_turn(a in -20.0..20.0_f64, b in -20.0..20.0_f64) {
        let turn = difference_of_angles(b, a);
        prop_assert!(turn.abs() <= PI);
        prop_assert!(wrap_angle(a + turn - b).abs() < 1e-12);
    }

    #[test]
    fn the_difference_changes_its_sign_with_the_order(a in -3.0..3.0_f64, b in -3.0..3.0_f64) {
        prop_assume!((difference_of_angles(a, b).abs() - PI).abs() > 1e-9);
        prop_assert!((difference_of_angles(a, b) + difference_of_angles(b, a)).abs() < 1e-12);
    }
}

#[test]
fn half_a_turn_is_positive_whichever_way_it_is_written() {
    for angle in [PI, -PI, 3.0 * PI, -3.0 * PI] {
        assert!((wrap_angle(angle) - PI).abs() < 1e-12, "{angle}");
    }
}

#[test]
fn not_a_number_stays_not_a_number() {
    assert!(wrap_angle(f64::NAN).is_nan());
    assert!(wrap_angle(f64::INFINITY).is_nan());
}
