//! Agreement of the closed forms with each other.

use crate::support::{any_point, any_pose, corners, hull, polygon};
use proptest::prelude::*;
use trundle_collision::convex_polygon::{depth_within, inscribed_disc, inset};
use trundle_collision::square::{point_to_square, polygon_to_square, segment_to_square};
use trundle_collision::{
    RoundedHull, Segment, StraightContact, arc_contact, blocked_headings, straight_contact,
};
use trundle_core::{Twist2, Vector2};

fn square_sides(centre: Vector2, half: f64) -> [Segment; 4] {
    let at = |x: f64, y: f64| centre + Vector2::new(x, y) * half;
    let corners = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
    std::array::from_fn(|i| Segment { a: corners[i], b: corners[(i + 1) % 4] })
}

proptest! {
    #[test]
    fn gaps_from_a_point_agree(point in any_point()) {
        let (swept, hull) = (RoundedHull::exact(&polygon()).signed_distance(point), RoundedHull::exact(&polygon()));
        let by_hull = hull.core_distance(&Segment::point(point));
        prop_assert!((swept.max(0.0) - by_hull).abs() < 1e-12, "{swept} {by_hull}");
    }

    #[test]
    fn straight_moves_to_a_point_agree(point in any_point(), forward in any::<bool>(), margin in 0.001..0.2_f64) {
        let (hull, piece) = (hull(margin), Segment::point(point));
        prop_assume!(!hull.overlaps(&piece) && hull.distance(&piece) > 1e-6);
        let twist = Twist2::new(if forward { 0.3 } else { -0.3 }, 0.0);
        let swept = arc_contact(&RoundedHull::exact(&polygon()), twist, point, margin);
        let by_hull = match straight_contact(&hull, &piece) {
            Some(StraightContact::Ahead(free)) if forward => Some(free),
            Some(StraightContact::Behind(free)) if !forward => Some(free),
            _ => None,
        };
        match (swept, by_hull) {
            (Some(a), Some(b)) => prop_assert!((a - b).abs() < 1e-9, "{a} {b}"),
            // A graze along a side may count as contact for only one of both methods.
            (a, b) => prop_assert!(a.is_none() && b.is_none() || grazes(&hull, point), "{a:?} {b:?}"),
        }
    }

    #[test]
    fn turns_to_a_point_agree(point in any_point(), left in any::<bool>(), margin in 0.001..0.2_f64) {
        let (hull, piece) = (hull(margin), Segment::point(point));
        prop_assume!(hull.distance(&piece) > 1e-6);
        let (mut angles, mut blocked) = (Vec::new(), Vec::new());
        blocked_headings(&hull, &piece, &mut angles, &mut blocked);
        let by_hull = blocked.iter().map(|arc| arc.free_turn_from(0.0)).map(|(l, r)| if left { l } else { r });
        let by_hull = by_hull.min_by(f64::total_cmp);
        let twist = Twist2::new(0.0, if left { 1.0 } else { -1.0 });
        let swept = arc_contact(&RoundedHull::exact(&polygon()), twist, point, margin);
        match (swept, by_hull) {
            (Some(a), Some(b)) => prop_assert!((a - b).abs() < 1e-6, "{a} {b}"),
            (a, b) => prop_assert!(a.is_none() && b.is_none(), "{a:?} {b:?}"),
        }
    }

    #[test]
    fn gaps_from_a_cell_agree(pose in any_pose(), centre in any_point(), half in 0.01..0.1_f64) {
        let placed: Vec<Vector2> = corners().iter().map(|c| pose.transform(*c)).collect();
        let to_square = polygon_to_square(&placed, centre, half, f64::INFINITY);
        let hull = RoundedHull::exact(&polygon());
        let inverse = pose.inverse();
        let side = |s: &Segment| Segment { a: inverse.transform(s.a), b: inverse.transform(s.b) };
        let by_hull = square_sides(centre, half).iter().map(|s| hull.core_distance(&side(s))).fold(f64::INFINITY, f64::min);
        prop_assert!((to_square - by_hull).abs() < 1e-9, "{to_square} {by_hull}");
    }

    #[test]
    fn the_nearest_pair_of_segment_and_cell_lies_on_both(a in any_point(), b in any_point(), half in 0.01..0.1_f64) {
        let centre = Vector2::new(1.6, 0.3);
        let (on_segment, on_square) = segment_to_square(a, b, centre, half);
        let segment = Segment { a, b };
        prop_assert!(segment.distance(on_segment) < 1e-9);
        prop_assert!(point_to_square(on_square, centre, half).norm() < 1e-9);
        let sides = square_sides(centre, half).map(|side| side.distance_to(&Segment { a, b }));
        let nearest = sides.into_iter().fold(f64::INFINITY, f64::min);
        prop_assert!(((on_segment - on_square).norm() - nearest).abs() < 1e-9);
    }

    #[test]
    fn an_inset_polygon_is_deeper_by_the_inset(point in any_point(), by in 0.001..0.15_f64) {
        let Some(small) = inset(&corners(), by) else { return Ok(()) };
        let (whole, small) = (depth_within(&corners(), point), depth_within(&small, point));
        prop_assert!((whole - by - small).abs() < 1e-9, "{whole} {small}");
    }
}

/// Whether a point is within rounding of the lines along which the hull's sides move.
fn grazes(hull: &RoundedHull, point: Vector2) -> bool {
    let ends =
        |offset: f64| straight_contact(hull, &Segment::point(point + Vector2::new(0.0, offset))).is_some();
    ends(1e-6) != ends(-1e-6)
}

#[test]
fn the_inscribed_disc_is_inside_and_touches_two_sides() {
    let (centre, radius) = inscribed_disc(&corners());
    let polygon = corners();
    let depths = (0..polygon.len()).map(|i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        (b - a).perp(&(centre - a)) / (b - a).norm()
    });
    let touching = depths.filter(|depth| (depth - radius).abs() < 2e-3).count();
    assert!(touching >= 2 && radius > 0.15, "{radius} touches {touching} sides");
}
