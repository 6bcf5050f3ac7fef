//! Convex regions of the plane and their exact clearance.

use trundle_core::Vector2;

/// A convex region of the plane: a point, a segment or a counter-clockwise polygon, grown by a radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Region<'a> {
    /// Corners, at least one, m.
    pub(crate) corners: &'a [Vector2],
    /// Metres.
    pub(crate) radius: f64,
}

impl Region<'_> {
    /// Metres between two regions; 0 when polygons overlap, less when it is their radii that overlap.
    pub(crate) fn clearance(&self, other: &Region<'_>) -> f64 {
        let overlap = holds(self.corners, other.corners[0]) || holds(other.corners, self.corners[0]);
        let gap = if overlap { 0.0 } else { polygon_gap2(self.corners, other.corners).sqrt() };
        gap - self.radius - other.radius
    }

    /// The lowest and the highest corner of the bounding box of the corners, without the radius.
    pub(super) fn box_of_corners(&self) -> (Vector2, Vector2) {
        let first = self.corners[0];
        self.corners.iter().fold((first, first), |(low, high), corner| (low.inf(corner), high.sup(corner)))
    }

    /// The lowest and the highest x between two values of y; `None` if empty.
    pub(super) fn span_between(&self, low: f64, high: f64) -> Option<(f64, f64)> {
        let mut span: Option<(f64, f64)> = None;
        let mut take = |x0: f64, x1: f64| {
            let (a, b) = span.unwrap_or((x0, x1));
            span = Some((a.min(x0), b.max(x1)));
        };
        for (a, b) in edges(self.corners) {
            if let Some((x0, x1)) = span_of_edge((a, b), low, high) {
                take(x0, x1);
            }
        }
        if self.radius > 0.0 {
            debug_assert_eq!(self.corners.len(), 1, "rounded polygons are not drawn");
            let center = self.corners[0];
            let off = (low - center.y).max(center.y - high).max(0.0);
            if off <= self.radius {
                let half = (self.radius * self.radius - off * off).sqrt();
                take(center.x - half, center.x + half);
            }
        }
        span
    }
}

/// The x range of the part of a segment between two heights.
fn span_of_edge((a, b): Segment, low: f64, high: f64) -> Option<(f64, f64)> {
    let (a, b) = if a.y <= b.y { (a, b) } else { (b, a) };
    if b.y < low || a.y > high {
        return None;
    }
    let at = |y: f64| if b.y > a.y { a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)) } else { a.x };
    let x0 = if a.y < low { at(low) } else { a.x };
    let x1 = if b.y > high { at(high) } else { b.x };
    Some((x0.min(x1), x0.max(x1)))
}

/// The squared gap of two convex polygons, neither of which contains the other's first corner: the distance of a corner and a side, or 0 if
/// sides cross.
fn polygon_gap2(a: &[Vector2], b: &[Vector2]) -> f64 {
    if a.len() > 1 && b.len() > 1 && edges(a).any(|a| edges(b).any(|b| cross(a, b))) {
        return 0.0;
    }
    corner_gap2(a, b).min(corner_gap2(b, a))
}

/// The least squared distance of a corner of `a` from a side of `b`.
fn corner_gap2(a: &[Vector2], b: &[Vector2]) -> f64 {
    let to_sides = |corner: Vector2| edges(b).map(move |side| point_gap2(corner, side));
    a.iter().flat_map(|&corner| to_sides(corner)).fold(f64::INFINITY, f64::min)
}

type Segment = (Vector2, Vector2);

/// The sides of a polygon; for a segment or a point the only one.
fn edges(corners: &[Vector2]) -> impl Iterator<Item = Segment> + '_ {
    let n = corners.len();
    (0..if n == 2 { 1 } else { n }).map(move |i| (corners[i], corners[if i + 1 == n { 0 } else { i + 1 }]))
}

/// Whether a convex counter-clockwise polygon contains a point; always false for points and segments.
fn holds(corners: &[Vector2], point: Vector2) -> bool {
    corners.len() > 2 && edges(corners).all(|(a, b)| (b - a).perp(&(point - a)) >= 0.0)
}

fn cross(a: Segment, b: Segment) -> bool {
    let side = |s: Segment, p: Vector2| (s.1 - s.0).perp(&(p - s.0));
    side(a, b.0) * side(a, b.1) < 0.0 && side(b, a.0) * side(b, a.1) < 0.0
}

fn point_gap2(p: Vector2, (a, b): Segment) -> f64 {
    let along = b - a;
    let length2 = along.norm_squared();
    let t = if length2 > 0.0 { ((p - a).dot(&along) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (p - a - along * t).norm_squared()
}

#[cfg(test)]
mod tests {
    use super::super::outline::Outline;
    use super::*;
    use trundle_core::{Footprint, Pose2};

    fn square(x: f64, y: f64) -> Outline {
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
        Outline::new(corners.iter().map(|&(dx, dy)| Vector2::new(x + dx, y + dy)).collect(), 0.0)
    }

    fn clearance(a: &Outline, b: &Outline) -> f64 {
        assert_eq!(a.region().clearance(&b.region()), b.region().clearance(&a.region()));
        a.region().clearance(&b.region())
    }

    #[test]
    fn clearances_are_those_of_elementary_geometry() {
        let disc = |x, y, r| Outline::new(vec![Vector2::new(x, y)], r);
        assert_eq!(clearance(&square(0.0, 0.0), &square(3.0, 0.5)), 1.0);
        assert!((clearance(&square(0.0, 0.0), &square(5.0, 6.0)) - 5.0).abs() < 1e-12);
        assert_eq!(clearance(&square(0.0, 0.0), &square(0.5, 0.5)), 0.0);
        assert_eq!(clearance(&square(0.0, 0.0), &disc(3.0, 0.0, 0.5)), 1.5);
        assert_eq!(clearance(&disc(0.0, 0.0, 1.0), &disc(3.0, 4.0, 1.5)), 2.5);
        assert_eq!(clearance(&square(0.0, 0.0), &disc(0.2, 0.0, 0.5)), -0.5);
        let wall = Outline::new(vec![Vector2::new(-5.0, 2.0), Vector2::new(5.0, 2.0)], 0.0);
        assert_eq!(clearance(&wall, &square(0.0, 0.0)), 1.0);
        assert_eq!(clearance(&wall, &square(0.0, 1.5)), 0.0, "a wall through a square touches it");
        assert_eq!(clearance(&wall, &disc(7.0, 2.0, 0.5)), 1.5, "beyond the wall's end");
    }

    #[test]
    fn a_plus_of_two_bars_overlaps_though_no_corner_is_inside() {
        let bar = |w: f64, h: f64| {
            let corners = [(w, h), (-w, h), (-w, -h), (w, -h)].map(|(x, y)| Vector2::new(x, y));
            Outline::new(corners.to_vec(), 0.0)
        };
        assert_eq!(clearance(&bar(3.0, 0.1), &bar(0.1, 3.0)), 0.0);
        let corners = bar(0.3, 0.2).region().corners.to_vec();
        let footprint = Footprint::Polygon { corners };
        let turned = Outline::of_footprint(&footprint, Pose2::new(2.0, 0.0, std::f64::consts::FRAC_PI_2));
        assert!((clearance(&square(0.0, 0.0), &turned) - 0.8).abs() < 1e-12);
    }

    #[test]
    fn spans_are_those_of_the_slice() {
        let triangle = [Vector2::new(0.0, 0.0), Vector2::new(4.0, 0.0), Vector2::new(0.0, 4.0)];
        let region = Region { corners: &triangle, radius: 0.0 };
        assert_eq!(region.span_between(1.0, 2.0), Some((0.0, 3.0)));
        assert_eq!(region.span_between(-1.0, 0.0), Some((0.0, 4.0)));
        assert_eq!(region.span_between(4.5, 5.0), None);
        let disc = Region { corners: &triangle[..1], radius: 5.0 };
        assert_eq!(disc.span_between(3.0, 9.0), Some((-4.0, 4.0)));
        assert_eq!(disc.span_between(-1.0, 9.0), Some((-5.0, 5.0)));
    }
}
