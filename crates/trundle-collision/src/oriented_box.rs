//! Oriented boxes around points.

use crate::segment::Segment;
use trundle_core::Vector2;

/// Enlargement of the half sides against rounding, m, and ratio. Source: rounding of f64.
const ROUNDING_SLACK: f64 = 1e-11;

/// A box of any orientation around points: a tight bound for points of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrientedBox {
    /// Centre.
    pub center: Vector2,
    /// Unit vector along the longer sides.
    pub axis: Vector2,
    /// Half sides along the axis (0 for a point only) and across, m.
    pub half: Vector2,
}

impl OrientedBox {
    /// A box of one point.
    pub fn point(at: Vector2) -> Self {
        Self { center: at, axis: Vector2::x(), half: Vector2::zeros() }
    }

    /// The box around points, along their principal direction.
    pub fn around(points: impl Iterator<Item = Vector2> + Clone) -> Self {
        // Sums relative to one of the points: coordinates may be large.
        let first = points.clone().next().unwrap_or_default();
        let (mut count, mut sum, mut xx, mut xy, mut yy) = (0.0, Vector2::zeros(), 0.0, 0.0, 0.0);
        for p in points.clone() {
            let d = p - first;
            (count, sum) = (count + 1.0, sum + d);
            (xx, xy, yy) = (xx + d.x * d.x, xy + d.x * d.y, yy + d.y * d.y);
        }
        let off = sum / f64::max(count, 1.0);
        (xx, xy, yy) = (xx - sum.x * off.x, xy - sum.x * off.y, yy - sum.y * off.y);
        let mean = first + off;
        let bearing = 0.5 * (2.0 * xy).atan2(xx - yy);
        let axis = Vector2::new(bearing.cos(), bearing.sin());
        let across = Vector2::new(-axis.y, axis.x);
        let (mut low, mut high) = (Vector2::repeat(f64::INFINITY), Vector2::repeat(f64::NEG_INFINITY));
        for p in points {
            let seen = Vector2::new(axis.dot(&(p - mean)), across.dot(&(p - mean)));
            (low, high) = (low.inf(&seen), high.sup(&seen));
        }
        let middle = (low + high) / 2.0;
        let center = mean + axis * middle.x + across * middle.y;
        let slack = ROUNDING_SLACK * (1.0 + center.amax());
        let half = ((high - low) / 2.0 * (1.0 + ROUNDING_SLACK)).add_scalar(slack);
        Self { center, axis, half }
    }

    /// The box in a frame at `origin` whose x axis is `direction` (unit).
    pub fn in_frame(&self, origin: Vector2, direction: Vector2) -> Self {
        let turn = |d: Vector2| Vector2::new(direction.dot(&d), direction.perp(&d));
        Self { center: turn(self.center - origin), axis: turn(self.axis), half: self.half }
    }

    /// Half extents along x and y, m.
    pub fn extent(&self) -> Vector2 {
        let (along, across) = (self.axis.abs(), self.half);
        Vector2::new(along.x * across.x + along.y * across.y, along.y * across.x + along.x * across.y)
    }

    /// The centre line; every point is within `half.y` of it.
    pub fn centre_line(&self) -> Segment {
        let along = self.axis * self.half.x;
        Segment { a: self.center - along, b: self.center + along }
    }

    /// Distance of the origin, m; 0 inside.
    pub fn distance_from_origin(&self) -> f64 {
        let beyond = |at: f64, half: f64| (at.abs() - half).max(0.0);
        let along = beyond(self.axis.dot(&self.center), self.half.x);
        let across = beyond(self.axis.perp(&self.center), self.half.y);
        (along * along + across * across).sqrt()
    }

    /// Upper bound of half the angle that the box subtends at the origin, around the bearing of its centre, rad.
    pub fn half_angle(&self) -> f64 {
        if self.half.x == 0.0 {
            return 0.0;
        }
        let distance = self.center.norm();
        if distance == 0.0 {
            return std::f64::consts::PI;
        }
        let seen = self.in_frame(Vector2::zeros(), self.center / distance).extent();
        let nearest = distance - seen.x;
        if nearest > 0.0 { seen.y.atan2(nearest) } else { std::f64::consts::PI }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::wrap_angle;

    proptest! {
        #[test]
        fn every_point_is_inside_in_every_frame(points in prop::collection::vec((-2.0..2.0_f64, -2.0..2.0_f64), 1..9), turn in 0.0..6.3_f64) {
            let points: Vec<Vector2> = points.into_iter().map(|(x, y)| Vector2::new(x, y)).collect();
            let whole = OrientedBox::around(points.iter().copied());
            let (origin, direction) = (Vector2::new(0.3, -0.2), Vector2::new(turn.cos(), turn.sin()));
            let seen = whole.in_frame(origin, direction);
            for p in points {
                let p = OrientedBox::point(p).in_frame(origin, direction).center;
                let off = (p - seen.center).abs() - seen.extent();
                prop_assert!(off.max() <= 1e-9, "{off}");
                prop_assert!(seen.distance_from_origin() <= p.norm() + 1e-9);
                prop_assert!(seen.centre_line().distance(p) <= seen.half.y + 1e-9);
                let bearing = wrap_angle(p.y.atan2(p.x) - seen.center.y.atan2(seen.center.x));
                prop_assert!(bearing.abs() <= seen.half_angle() + 1e-9);
            }
        }
    }

    #[test]
    fn the_box_of_a_slanted_wall_is_thin() {
        let points = (0..50).map(|i| Vector2::new(0.1, 0.2) * f64::from(i));
        let bounds = OrientedBox::around(points);
        assert!(bounds.half.y < 1e-9 && (bounds.half.x - 49.0 * 0.05_f64.sqrt() / 2.0).abs() < 1e-6);
    }
}
