//! Straight moves: the free distance until the swept hull meets a segment, in closed form.
//!
//! The distance along x to a segment is X(y) - F(y) over their common range of y. The segment is a line X and the hull's front F is
//! concave, so the distance is convex in y. Its minimum is at the point where the front is parallel to the segment, or at the nearest end
//! of the common range.

use crate::rounded_hull::RoundedHull;
use crate::segment::Segment;
use trundle_core::Vector2;

/// Common range of y below which a contact is a graze along a side, m: no contact. Source: rounding.
const MIN_COMMON_RANGE_M: f64 = 1e-9;

/// Contact of a straight move with a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StraightContact {
    /// Free distance forward, m.
    Ahead(f64),
    /// Free distance backward, m.
    Behind(f64),
}

/// Distance at which a segment stops a straight move (base frame, no overlap at the start); `None` without a contact.
pub fn straight_contact(hull: &RoundedHull, segment: &Segment) -> Option<StraightContact> {
    let (bottom, top) = hull.core_extent(Vector2::y());
    let low = segment.a.y.min(segment.b.y).max(bottom - hull.radius + MIN_COMMON_RANGE_M);
    let high = segment.a.y.max(segment.b.y).min(top + hull.radius - MIN_COMMON_RANGE_M);
    if low > high {
        return None;
    }
    let middle = (low + high) / 2.0;
    let ahead =
        x_at(segment, middle) > (front_extent(hull, middle, 1.0) - front_extent(hull, middle, -1.0)) / 2.0;
    let sign = if ahead { 1.0 } else { -1.0 };
    let y = parallel_y(hull, segment, sign).map_or(middle, |y| y.clamp(low, high));
    let x = if segment.a.y == segment.b.y { nearer_end(segment, sign) } else { x_at(segment, y) };
    let distance = (sign * x - front_extent(hull, y, sign)).max(0.0);
    Some(if ahead { StraightContact::Ahead(distance) } else { StraightContact::Behind(distance) })
}

/// Extent of the hull at `y`: along x for `sign` 1, against x for -1.
pub(crate) fn front_extent(hull: &RoundedHull, y: f64, sign: f64) -> f64 {
    let mut reach = f64::NEG_INFINITY;
    for corner in &hull.core {
        let up = y - corner.at.y;
        if up.abs() <= hull.radius {
            reach = reach.max(sign * corner.at.x + (hull.radius * hull.radius - up * up).sqrt());
        }
    }
    for edge in hull.edges.iter().filter(|e| sign * e.normal.x > 0.0) {
        let shift = edge.normal * hull.radius;
        let (a, b) = (edge.side.a + shift, edge.side.b + shift);
        if y >= a.y.min(b.y) && y <= a.y.max(b.y) {
            reach = reach.max(sign * x_at(&Segment { a, b }, y));
        }
    }
    reach
}

/// The y of the front point whose tangent is parallel to the segment; `None` for a point or a segment along x.
fn parallel_y(hull: &RoundedHull, segment: &Segment, sign: f64) -> Option<f64> {
    let along = segment.b - segment.a;
    if along.y == 0.0 {
        return None;
    }
    let normal = Vector2::new(along.y, -along.x).normalize();
    let normal = if normal.x * sign < 0.0 { -normal } else { normal };
    let foremost = hull.core.iter().max_by(|p, q| normal.dot(&p.at).total_cmp(&normal.dot(&q.at)));
    foremost.map(|corner| corner.at.y + hull.radius * normal.y)
}

/// The x of a segment at `y`; for a segment along x, that of its first end.
fn x_at(segment: &Segment, y: f64) -> f64 {
    let rise = segment.b.y - segment.a.y;
    if rise == 0.0 {
        segment.a.x
    } else {
        segment.a.x + (segment.b.x - segment.a.x) * ((y - segment.a.y) / rise).clamp(0.0, 1.0)
    }
}

/// The end of a segment along x that a move along x (`sign` 1) or against x (-1) meets first.
fn nearer_end(segment: &Segment, sign: f64) -> f64 {
    if sign > 0.0 { segment.a.x.min(segment.b.x) } else { segment.a.x.max(segment.b.x) }
}
