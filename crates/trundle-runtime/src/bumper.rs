//! Points of the map that a pressed bumper marks as occupied.

use trundle_core::{Footprint, Vector2};

/// Half of the bumper's angle \[deg\]. Contact is assumed at all bearings within it. Source: the Kobuki's front bumper.
const BUMPER_HALF_ANGLE_DEG: i32 = 30;
/// Angle between neighbouring contact points \[deg\]: closer than the cells of a map. Source: ours.
const CONTACT_POINT_STEP_DEG: i32 = 6;
/// Distance of a contact point from the footprint's outline \[m\]: it falls into the next cell. Source: ours.
const CONTACT_POINT_OFFSET_M: f64 = 0.03;

/// Possible positions of an obstacle that presses the bumper of a robot with this outline: points ahead of the outline, base frame, m.
pub(crate) fn ahead_of(footprint: &Footprint) -> Vec<Vector2> {
    let bearings = (-BUMPER_HALF_ANGLE_DEG..=BUMPER_HALF_ANGLE_DEG)
        .step_by(CONTACT_POINT_STEP_DEG as usize)
        .map(|deg| f64::from(deg).to_radians());
    let point = |bearing: f64| {
        let direction = Vector2::new(bearing.cos(), bearing.sin());
        direction * (distance_to_outline(footprint, direction) + CONTACT_POINT_OFFSET_M)
    };
    bearings.map(point).collect()
}

/// Distance from the base's origin to the front of the outline, m.
pub(crate) fn front_of(footprint: &Footprint) -> f64 {
    distance_to_outline(footprint, Vector2::new(1.0, 0.0))
}

/// Distance from the base's origin to the outline in a direction, m.
fn distance_to_outline(footprint: &Footprint, direction: Vector2) -> f64 {
    match footprint {
        Footprint::Disc { radius } => *radius,
        Footprint::Polygon { corners } => {
            let sides = corners.iter().zip(corners.iter().cycle().skip(1));
            let crossing = |(a, b): (&Vector2, &Vector2)| {
                let (side, across) = (b - a, direction.perp(&(b - a)));
                let (distance, part) = (a.perp(&side) / across, a.perp(&direction) / across);
                (distance >= 0.0 && (0.0..=1.0).contains(&part)).then_some(distance)
            };
            sides.filter_map(crossing).fold(0.0, f64::max)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_touched_obstacle_is_ahead_of_the_front() {
        let corners = [(0.4, 0.2), (-0.2, 0.2), (-0.2, -0.2), (0.4, -0.2)];
        let cart = Footprint::polygon(corners.map(|(x, y)| Vector2::new(x, y)).to_vec()).unwrap();
        let points = ahead_of(&cart);
        assert!(points.iter().any(|p| (p - Vector2::new(0.43, 0.0)).norm() < 1e-9), "{points:?}");
        let is_outside = |p: &Vector2| p.x > 0.4 || p.y.abs() > 0.2;
        assert!(points.len() == 11 && points.iter().all(|p| is_outside(p) && p.x > 0.35), "{points:?}");
        for p in ahead_of(&Footprint::disc(0.2).unwrap()) {
            assert!((p.norm() - 0.23).abs() < 1e-9 && p.x > 0.0);
        }
    }
}
