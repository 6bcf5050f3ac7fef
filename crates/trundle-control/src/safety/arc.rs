use std::f64::consts::{PI, TAU};
use trundle_core::{Twist2, Vector2};

/// The way of a disc's centre along the arc of `twist` until the disc of `radius` touches the point `p` (base frame, m):
/// `None` when it never does, 0 when it touches already and the motion presses on, m.
///
/// A disc that touches already may move on when that takes it away from the point, or along it.
pub(super) fn way_to_contact(twist: Twist2, p: Vector2, radius: f64) -> Option<f64> {
    if twist.v == 0.0 {
        return None;
    }
    // Backward is forward in a mirror.
    let p = Vector2::new(p.x * twist.v.signum(), p.y);
    if p.norm() <= radius {
        return (p.x > 0.0).then_some(0.0);
    }
    let curvature = twist.omega / twist.v;
    if curvature.abs() < STRAIGHT { straight(p, radius) } else { circular(p, radius, curvature) }
}

/// A curvature that is none over the ways of interest, 1/m.
const STRAIGHT: f64 = 1e-4;

fn straight(p: Vector2, radius: f64) -> Option<f64> {
    (p.x > 0.0 && p.y.abs() < radius).then(|| p.x - (radius * radius - p.y * p.y).sqrt())
}

/// On the circle about (0, 1 / curvature): contact is where the disc's centre is `radius` away from the point.
fn circular(p: Vector2, radius: f64, curvature: f64) -> Option<f64> {
    let turn = 1.0 / curvature.abs();
    // Seen so that the circle's centre is to the left: mirror a right turn.
    let p = Vector2::new(p.x, p.y * curvature.signum());
    let from_centre = p - Vector2::new(0.0, turn);
    let distance = from_centre.norm();
    let cosine = (turn * turn + distance * distance - radius * radius) / (2.0 * turn * distance);
    if !(-1.0..=1.0).contains(&cosine) {
        return None;
    }
    // The robot starts straight below the centre and goes counter-clockwise.
    let bearing = (from_centre.y.atan2(from_centre.x) + PI / 2.0).rem_euclid(TAU);
    let angle = bearing - cosine.acos();
    (angle >= 0.0).then_some(angle * turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::Pose2;

    /// By driving in small steps.
    fn by_driving(twist: Twist2, p: Vector2, radius: f64, reach: f64) -> Option<f64> {
        let step = 1e-3;
        (0..(reach / step) as usize).map(|i| i as f64 * step).find(|way| {
            let pose = Pose2::IDENTITY.advance(twist, way / twist.v.abs());
            (pose.position() - p).norm() <= radius
        })
    }

    proptest! {
        #[test]
        fn the_formula_agrees_with_driving(
            (x, y) in (-1.5..1.5, -1.5..1.5),
            (v, curvature) in (prop::bool::ANY, -5.0..5.0),
            radius in 0.05..0.4,
        ) {
            let p = Vector2::new(x, y);
            prop_assume!(p.norm() > radius + 0.01);
            let (v, curvature): (f64, f64) = (if v { 0.4 } else { -0.4 }, curvature);
            let twist = Twist2::new(v, curvature * v);
            let reach = 1.2_f64.min(TAU / curvature.abs().max(1e-9));
            let driven = by_driving(twist, p, radius, reach);
            let grazing = by_driving(twist, p, radius + 0.004, reach).is_some()
                != by_driving(twist, p, radius - 0.004, reach).is_some();
            prop_assume!(!grazing);
            match (way_to_contact(twist, p, radius), driven) {
                (Some(formula), Some(driven)) => prop_assert!((formula - driven).abs() < 0.01, "{formula} {driven}"),
                (Some(formula), None) => prop_assert!(formula >= reach - 0.01, "{formula} beyond {reach}"),
                (None, driven) => prop_assert!(driven.is_none(), "{driven:?}"),
            }
        }
    }

    #[test]
    fn turning_on_the_spot_touches_nothing() {
        assert_eq!(way_to_contact(Twist2::new(0.0, 2.0), Vector2::new(0.1, 0.0), 0.2), None);
    }

    #[test]
    fn from_a_touch_it_may_go_away_but_not_on() {
        let p = Vector2::new(0.15, 0.05);
        assert_eq!(way_to_contact(Twist2::new(0.1, 0.0), p, 0.2), Some(0.0));
        assert_eq!(way_to_contact(Twist2::new(-0.1, 0.0), p, 0.2), None);
        assert_eq!(way_to_contact(Twist2::new(0.1, 0.0), Vector2::new(-0.01, 0.19), 0.2), None);
    }

    #[test]
    fn a_wall_beside_is_never_met_a_wall_ahead_is() {
        let beside = (-20..=20).map(|i| Vector2::new(f64::from(i) * 0.1, 0.25));
        assert!(beside.into_iter().all(|p| way_to_contact(Twist2::new(0.5, 0.0), p, 0.2).is_none()));
        let way = way_to_contact(Twist2::new(0.5, 0.0), Vector2::new(1.0, 0.0), 0.2).unwrap();
        assert!((way - 0.8).abs() < 1e-12);
    }
}
