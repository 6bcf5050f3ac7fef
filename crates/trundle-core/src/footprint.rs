//! The robot's footprint on the floor: a disc or a convex polygon in the base frame.

use crate::{Invalid, Vector2, require_positive};
use std::f64::consts::TAU;

/// Largest plausible distance of a point of the footprint from the base's origin \[m\]. Source: ours.
pub const MAX_FOOTPRINT_RADIUS_M: f64 = 3.0;

/// The robot's outline on the floor, base frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Footprint {
    /// A disc around the base's origin.
    Disc {
        /// Metres.
        radius: f64,
    },
    /// A convex polygon, counter-clockwise, base frame, m.
    Polygon {
        /// Three corners or more.
        corners: Vec<Vector2>,
    },
}

impl Footprint {
    /// The Kobuki: a disc of 0.351 m across (its data sheet).
    pub const KOBUKI: Self = Self::Disc { radius: 0.1755 };

    /// A disc around the base's origin.
    ///
    /// # Errors
    /// When the radius is not finite and positive.
    pub fn disc(radius: f64) -> Result<Self, Invalid> {
        require_positive("footprint radius", radius, "m")?;
        Ok(Self::Disc { radius })
    }

    /// A convex polygon; corners may come in either order and are stored counter-clockwise.
    ///
    /// # Errors
    /// When the polygon has fewer than three corners, a corner is not finite, the area is zero, or the polygon is not convex.
    pub fn polygon(mut corners: Vec<Vector2>) -> Result<Self, Invalid> {
        if corners.len() < 3 {
            return Err(Invalid::new("footprint corners", corners.len(), "", "3 or more"));
        }
        if let Some(c) = corners.iter().find(|c| !(c.x.is_finite() && c.y.is_finite())) {
            return Err(Invalid::new(
                "footprint corner",
                format!("({}, {})", c.x, c.y),
                "m",
                "finite numbers",
            ));
        }
        let area = signed_area(&corners);
        if area.abs() < 1e-12 {
            return Err(Invalid::new("footprint area", area, "m^2", "more than 0"));
        }
        if area < 0.0 {
            corners.reverse();
        }
        if let Some(i) = (0..corners.len()).find(|&i| turn_at(&corners, i) < -1e-12) {
            return Err(Invalid::new("footprint", format!("turned inward at corner {i}"), "", "convex"));
        }
        let turns = (total_turn(&corners) / TAU).round();
        if turns > 1.0 {
            return Err(Invalid::new("footprint", format!("a star of {turns} turns"), "", "convex"));
        }
        Ok(Self::Polygon { corners })
    }

    /// The largest distance of a point of the footprint from the base's origin, m.
    pub fn circumscribed_radius(&self) -> f64 {
        match self {
            Self::Disc { radius } => *radius,
            Self::Polygon { corners } => corners.iter().map(Vector2::norm).fold(0.0, f64::max),
        }
    }
}

fn signed_area(corners: &[Vector2]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| a.perp(b)).sum::<f64>() / 2.0
}

/// Sum of the changes of direction at all corners, rad: one full turn, or more if sides cross.
fn total_turn(corners: &[Vector2]) -> f64 {
    let side = |i: usize| corners[(i + 1) % corners.len()] - corners[i % corners.len()];
    (0..corners.len()).map(|i| side(i).perp(&side(i + 1)).atan2(side(i).dot(&side(i + 1)))).sum()
}

fn turn_at(corners: &[Vector2], i: usize) -> f64 {
    let n = corners.len();
    let (a, b, c) = (corners[i], corners[(i + 1) % n], corners[(i + 2) % n]);
    (b - a).perp(&(c - b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<Vector2> {
        list.iter().map(|&(x, y)| Vector2::new(x, y)).collect()
    }

    #[test]
    fn polygons_are_checked() {
        let square = points(&[(0.3, 0.2), (0.3, -0.2), (-0.3, -0.2), (-0.3, 0.2)]);
        let footprint = Footprint::polygon(square).unwrap();
        assert!((footprint.circumscribed_radius() - 0.13_f64.sqrt()).abs() < 1e-12);
        assert!(Footprint::polygon(points(&[(0., 0.), (1., 0.)])).is_err());
        assert!(Footprint::polygon(points(&[(0., 0.), (1., 1.), (2., 2.)])).is_err());
        assert!(Footprint::polygon(points(&[(0., 0.), (2., 0.), (0.5, 0.5), (0., 2.)])).is_err());
        assert!(Footprint::disc(f64::NAN).is_err());
    }
}
