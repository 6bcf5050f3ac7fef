//! Contact of a footprint that moves along an arc with a point, in closed form.
//!
//! Problem: the distance that a moving footprint travels until it touches a point. Idea: in the base frame the point moves instead, on a
//! line, or on a circle around the centre of rotation. The footprint grown by a margin is bounded by its sides moved outward and by arcs
//! around its corners. The first contact is the first crossing of the point's line or circle with one of those: closed forms, no sampling.
//! Cost: O(corners).

use crate::rounded_hull::{Edge, RoundedHull};
use std::f64::consts::TAU;
use trundle_core::{Twist2, Vector2};

/// Distance that counts as contact, m. Source: rounding of f64.
const CONTACT_TOLERANCE_M: f64 = 1e-9;
/// Curvature below which a motion counts as straight, 1/m. Source: ours.
const MAX_STRAIGHT_CURVATURE_PER_M: f64 = 1e-4;

/// The distance of the base's origin along the arc of `twist` until the hull grown by `margin` m touches the point `p` (base frame, m); m,
/// or for a turn in place rad. `None` without a contact; 0 if the hull touches the point and the motion presses on.
///
/// A hull that touches already may move away from the point, or along it.
pub fn arc_contact(hull: &RoundedHull, twist: Twist2, p: Vector2, margin: f64) -> Option<f64> {
    let radius = hull.radius + margin;
    if twist.v == 0.0 && (twist.omega == 0.0 || hull.is_disc()) {
        return None;
    }
    let (distance, away) = hull.core_offset(p);
    if distance <= radius + CONTACT_TOLERANCE_M {
        let motion = Vector2::new(twist.omega * p.y - twist.v, -twist.omega * p.x);
        return (away == Vector2::zeros() || motion.dot(&away) < 0.0).then_some(0.0);
    }
    if twist.omega.abs() <= MAX_STRAIGHT_CURVATURE_PER_M * twist.v.abs() {
        return distance_along(hull, Vector2::new(twist.v.signum(), 0.0), p, radius);
    }
    let pole = Vector2::new(0.0, twist.v / twist.omega);
    let angle = angle_about(hull, pole, -twist.omega.signum(), p, radius)?;
    Some(if twist.v == 0.0 { angle } else { angle * pole.y.abs() })
}

/// Distance along `ahead`, m.
fn distance_along(hull: &RoundedHull, ahead: Vector2, p: Vector2, radius: f64) -> Option<f64> {
    let of_side = |edge: &Edge| {
        let closing = ahead.dot(&edge.normal);
        let distance = ((p - edge.side.a).dot(&edge.normal) - radius) / closing;
        let along = (p - ahead * distance - edge.side.a).dot(&edge.along());
        (closing > 0.0 && distance >= 0.0 && (0.0..=edge.length).contains(&along)).then_some(distance)
    };
    let of_corner = |corner: Vector2| {
        let to = p - corner;
        let (travelled, beside) = (to.dot(&ahead), ahead.perp(&to));
        let travelled = travelled - (radius * radius - beside * beside).max(0.0).sqrt();
        (beside.abs() < radius && travelled >= 0.0).then_some(travelled)
    };
    let of_corners = hull.core.iter().filter_map(|corner| of_corner(corner.at));
    hull.edges.iter().filter_map(of_side).chain(of_corners).min_by(f64::total_cmp)
}

/// Angle of the point's rotation around `pole` in the direction `sense`, rad.
fn angle_about(hull: &RoundedHull, pole: Vector2, sense: f64, p: Vector2, radius: f64) -> Option<f64> {
    let arm = p - pole;
    let turn = arm.norm();
    let mut corners = hull.core.iter().map(|corner| corner.at);
    if turn < CONTACT_TOLERANCE_M
        || corners.clone().all(|corner| (corner - pole).norm() + radius < turn)
        || hull.core_offset(pole).0 - radius > turn
    {
        return None;
    }
    let of_sides = hull.edges.iter().flat_map(|edge| crossings_of_side(edge, pole, turn, radius));
    let of_corners = corners.by_ref().flat_map(|corner| crossings(pole, turn, corner, radius));
    let angle = |to: Vector2| (sense * arm.perp(&to).atan2(arm.dot(&to))).rem_euclid(TAU);
    of_sides.chain(of_corners).map(angle).min_by(f64::total_cmp)
}

/// Crossings of the circle of radius `turn` around `pole` with a side moved outward by `radius`, relative to the pole.
fn crossings_of_side(edge: &Edge, pole: Vector2, turn: f64, radius: f64) -> impl Iterator<Item = Vector2> {
    let to_side = edge.side.a + edge.normal * radius - pole;
    let height = to_side.dot(&edge.normal);
    let half = (turn * turn - height * height).sqrt();
    let (along, outward, length) = (edge.along(), edge.normal, edge.length);
    let start = to_side.dot(&along);
    // Without a crossing the root is NaN, and no range contains it.
    let is_on = move |at: &f64| (0.0..=length).contains(&(at - start));
    [-half, half].into_iter().filter(is_on).map(move |at| outward * height + along * at)
}

/// Intersections of the circle of radius `turn` around `pole` with the circle of radius `radius` around `corner`, relative to the pole.
fn crossings(pole: Vector2, turn: f64, corner: Vector2, radius: f64) -> impl Iterator<Item = Vector2> {
    let to = corner - pole;
    let distance = to.norm();
    let ahead = (turn * turn - radius * radius + distance * distance) / (2.0 * distance);
    let half = (turn * turn - ahead * ahead).sqrt();
    let along = to / distance;
    let across = Vector2::new(-along.y, along.x);
    let is_there = half.is_finite() && distance > CONTACT_TOLERANCE_M;
    [-half, half].into_iter().filter(move |_| is_there).map(move |at| along * ahead + across * at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::{Footprint, Pose2};

    /// 0.6 x 0.4 m, the axle behind the centre.
    fn cart() -> RoundedHull {
        let corners = [(0.4, 0.2), (-0.2, 0.2), (-0.2, -0.2), (0.4, -0.2)];
        let corners = corners.iter().map(|&(x, y)| Vector2::new(x, y)).collect();
        RoundedHull::exact(&Footprint::polygon(corners).unwrap())
    }

    fn disc(radius: f64) -> RoundedHull {
        RoundedHull::exact(&Footprint::Disc { radius })
    }

    /// The distance of a point from the cart at `pose` by the formula of a box, independent of the code above.
    fn box_distance(pose: Pose2, p: Vector2) -> f64 {
        let q = pose.inverse().transform(p) - Vector2::new(0.1, 0.0);
        let beyond = Vector2::new(q.x.abs() - 0.3, q.y.abs() - 0.2);
        beyond.sup(&Vector2::zeros()).norm() + beyond.x.max(beyond.y).min(0.0)
    }

    /// The contact found by driving (or, without speed, turning) in small steps.
    fn by_driving(twist: Twist2, reach: f64, distance: impl Fn(Pose2) -> f64) -> Option<f64> {
        let (step, rate) = (5e-4, if twist.v == 0.0 { twist.omega.abs() } else { twist.v.abs() });
        let mut travelleds = (0..(reach / step) as usize).map(|i| i as f64 * step);
        travelleds.find(|travelled| distance(Pose2::IDENTITY.advance(twist, travelled / rate)) <= 0.0)
    }

    fn agree(found: Option<f64>, driven: Option<f64>, reach: f64) -> Result<(), TestCaseError> {
        match (found, driven) {
            (Some(found), Some(driven)) => prop_assert!((found - driven).abs() < 0.01, "{found} {driven}"),
            (Some(found), None) => prop_assert!(found >= reach - 0.01, "{found} beyond {reach}"),
            (None, driven) => prop_assert!(driven.is_none(), "{driven:?}"),
        }
        Ok(())
    }

    proptest! {
        #[test]
        fn closed_forms_agree_with_a_sampled_box(
            (x, y) in (-1.5..1.5, -1.5..1.5),
            (v, curvature) in (-1_i32..=1, -5.0..5.0),
            margin in 0.0..0.2,
        ) {
            let (p, v, curvature): (_, _, f64) = (Vector2::new(x, y), 0.4 * f64::from(v), curvature);
            let twist = Twist2::new(v, if v == 0.0 { curvature } else { curvature * v });
            let reach = if v == 0.0 { TAU } else { 1.2_f64.min(TAU / curvature.abs().max(1e-9)) };
            prop_assume!(box_distance(Pose2::IDENTITY, p) > margin + 0.01 && twist != Twist2::ZERO);
            let driven = |grown: f64| by_driving(twist, reach, |pose| box_distance(pose, p) - margin - grown);
            prop_assume!(driven(0.004).is_some() == driven(-0.004).is_some());
            let slides = driven(0.002).zip(driven(-0.002)).is_some_and(|(a, b)| (a - b).abs() > 0.008);
            prop_assume!(!slides);
            agree(arc_contact(&cart(), twist, p, margin), driven(0.0), reach)?;
        }

        #[test]
        fn closed_forms_agree_with_a_sampled_disc(
            (x, y) in (-1.5..1.5, -1.5..1.5),
            (v, curvature) in (prop::bool::ANY, -5.0..5.0),
            radius in 0.05..0.4,
        ) {
            let p = Vector2::new(x, y);
            prop_assume!(p.norm() > radius + 0.01);
            let (v, curvature): (f64, f64) = (if v { 0.4 } else { -0.4 }, curvature);
            let twist = Twist2::new(v, curvature * v);
            let reach = 1.2_f64.min(TAU / curvature.abs().max(1e-9));
            let driven = |grown: f64| by_driving(twist, reach, |pose| (pose.position() - p).norm() - radius - grown);
            prop_assume!(driven(0.004).is_some() == driven(-0.004).is_some());
            agree(arc_contact(&disc(radius), twist, p, 0.0), driven(0.0), reach)?;
        }

        #[test]
        fn gaps_are_those_of_the_box((x, y) in (-1.0..1.0, -1.0..1.0)) {
            let p = Vector2::new(x, y);
            prop_assert!((cart().signed_distance(p) - box_distance(Pose2::IDENTITY, p)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_disc_turns_without_contact_and_a_box_swings_its_corners() {
        let turn = Twist2::new(0.0, 2.0);
        assert_eq!(arc_contact(&disc(0.2), turn, Vector2::new(0.1, 0.0), 0.0), None);
        let angle = arc_contact(&cart(), turn, Vector2::new(0.0, 0.3), 0.0).unwrap();
        // The left side of the front reaches the point, 0.3 m from the axle.
        assert!((angle - (std::f64::consts::FRAC_PI_2 - (0.2_f64 / 0.3).asin())).abs() < 1e-9, "{angle}");
        assert_eq!(arc_contact(&cart(), turn, Vector2::new(0.0, 0.46), 0.0), None);
    }

    #[test]
    fn from_contact_it_may_move_away_but_not_press_on() {
        let p = Vector2::new(0.15, 0.05);
        assert_eq!(arc_contact(&disc(0.2), Twist2::new(0.1, 0.0), p, 0.0), Some(0.0));
        assert_eq!(arc_contact(&disc(0.2), Twist2::new(-0.1, 0.0), p, 0.0), None);
        let behind = Vector2::new(-0.01, 0.19);
        assert_eq!(arc_contact(&disc(0.2), Twist2::new(0.1, 0.0), behind, 0.0), None);
        let left = Vector2::new(0.1, 0.2);
        assert_eq!(arc_contact(&cart(), Twist2::new(0.0, 0.5), left, 0.0), Some(0.0));
        assert_eq!(arc_contact(&cart(), Twist2::new(0.0, -0.5), left, 0.0), None);
        assert_eq!(arc_contact(&cart(), Twist2::new(0.5, 0.0), left, 0.0), None, "along it");
    }

    #[test]
    fn a_wall_beside_is_never_touched_and_a_wall_ahead_is() {
        let ahead = Twist2::new(0.5, 0.0);
        let mut beside = (-20..=20).map(|i| Vector2::new(f64::from(i) * 0.1, 0.25));
        assert!(beside.all(|p| arc_contact(&disc(0.2), ahead, p, 0.0).is_none()));
        let mut beside = (-20..=20).map(|i| Vector2::new(f64::from(i) * 0.1, 0.205));
        assert!(beside.all(|p| arc_contact(&cart(), ahead, p, 0.0).is_none()));
        let travelled = |hull: RoundedHull| arc_contact(&hull, ahead, Vector2::new(1.0, 0.0), 0.0).unwrap();
        assert!((travelled(disc(0.2)) - 0.8).abs() < 1e-12 && (travelled(cart()) - 0.6).abs() < 1e-12);
    }
}
