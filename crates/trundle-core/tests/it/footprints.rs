//! Laws of footprints.

use proptest::prelude::*;
use std::f64::consts::TAU;
use trundle_core::{Footprint, Pose2, Vector2};

/// A polygon with its corners on a circle around `centre`, hence convex.
fn inscribed(bearings: &[f64], radius: f64, centre: Vector2) -> Vec<Vector2> {
    let mut sorted = bearings.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.iter().map(|t| centre + Vector2::new(t.cos(), t.sin()) * radius).collect()
}

fn any_convex() -> impl Strategy<Value = Vec<Vector2>> {
    (3_usize..9, 0.1..1.0_f64, -0.5..0.5_f64, -0.5..0.5_f64, 0.0..TAU).prop_map(|(n, radius, x, y, first)| {
        let bearings: Vec<f64> = (0..n).map(|i| i as f64 * TAU / n as f64 + 0.2 * (i as f64).sin()).collect();
        let turned: Vec<f64> = bearings.iter().map(|t| t + first).collect();
        inscribed(&turned, radius, Vector2::new(x, y))
    })
}

fn corners(footprint: Footprint) -> Vec<Vector2> {
    match footprint {
        Footprint::Polygon { corners } => corners,
        Footprint::Disc { .. } => panic!("a disc has no corners"),
    }
}

fn area(corners: &[Vector2]) -> f64 {
    (0..corners.len()).map(|i| corners[i].perp(&corners[(i + 1) % corners.len()])).sum::<f64>() / 2.0
}

proptest! {
    #[test]
    fn corners_are_stored_counter_clockwise_in_whichever_order_they_come(convex in any_convex()) {
        let forward = corners(Footprint::polygon(convex.clone()).unwrap());
        let backward = corners(Footprint::polygon(convex.iter().rev().copied().collect()).unwrap());
        prop_assert!(area(&forward) > 0.0 && area(&backward) > 0.0);
        prop_assert!((area(&forward) - area(&backward)).abs() < 1e-12);
        prop_assert!(forward.iter().all(|corner| backward.contains(corner)));
    }

    #[test]
    fn any_corner_may_be_the_first(convex in any_convex(), by in 0_usize..9) {
        let mut turned = convex.clone();
        turned.rotate_left(by % convex.len());
        prop_assert!(Footprint::polygon(turned).is_ok());
    }

    #[test]
    fn the_circumscribed_circle_holds_every_corner_and_touches_one(convex in any_convex()) {
        let footprint = Footprint::polygon(convex.clone()).unwrap();
        let radius = footprint.circumscribed_radius();
        prop_assert!(convex.iter().all(|corner| corner.norm() <= radius + 1e-12));
        prop_assert!(convex.iter().any(|corner| corner.norm() >= radius - 1e-12));
    }

    #[test]
    fn a_turn_about_the_axle_keeps_the_circumscribed_radius(convex in any_convex(), turn in -3.0..3.0_f64) {
        let frame = Pose2::new(0.0, 0.0, turn);
        let turned = convex.iter().map(|corner| frame.transform(*corner)).collect();
        let (before, after) = (Footprint::polygon(convex).unwrap(), Footprint::polygon(turned).unwrap());
        prop_assert!((before.circumscribed_radius() - after.circumscribed_radius()).abs() < 1e-12);
    }

    #[test]
    fn a_corner_pushed_inward_is_refused(convex in any_convex(), which in 0_usize..9) {
        prop_assume!(convex.len() > 3);
        let n = convex.len();
        let (i, before, after) = (which % n, convex[(which + n - 1) % n], convex[(which + 1) % n]);
        let chord = (before + after) / 2.0;
        let mut dented = convex.clone();
        dented[i] = chord + (chord - convex[i]) * 0.3;
        prop_assert!(Footprint::polygon(dented).is_err());
    }
}

#[test]
fn a_star_whose_edges_cross_is_refused() {
    let star: Vec<Vector2> = (0..5)
        .map(|i| f64::from(i) * 2.0 * TAU / 5.0)
        .map(|bearing| Vector2::new(bearing.cos(), bearing.sin()))
        .collect();
    let error = Footprint::polygon(star).unwrap_err();
    assert_eq!(error.to_string(), "footprint is a star of 2 turns, expected convex");
}

#[test]
fn a_corner_on_a_straight_side_is_allowed() {
    let square =
        [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)].map(|(x, y)| Vector2::new(x, y));
    assert_eq!(corners(Footprint::polygon(square.to_vec()).unwrap()).len(), 5);
}

#[test]
fn a_disc_is_its_own_circumscribed_circle() {
    assert_eq!(Footprint::disc(0.3).unwrap().circumscribed_radius(), 0.3);
    assert_eq!(Footprint::KOBUKI.circumscribed_radius(), 0.1755);
}
