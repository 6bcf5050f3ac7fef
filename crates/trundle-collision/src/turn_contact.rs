//! Turns in place: the headings at which the hull overlaps a segment, in closed form.
//!
//! The hull is a convex core, grown by a radius. While it turns around the axle's centre, overlap with a segment begins or ends only at
//! two kinds of headings:
//!
//! 1. An end of the segment lies on the hull's boundary. It is where a circle around the axle's centre meets a side or a rounded corner.
//! 2. A corner of the core is one radius away from the segment. It is where the circle of the corner meets a line parallel to the segment.
//!
//! Between neighbouring headings of these kinds the overlap does not change. One overlap test in the middle of each interval decides it.

use crate::rounded_hull::RoundedHull;
use crate::segment::Segment;
use std::f64::consts::TAU;
use trundle_core::Vector2;

/// An interval of headings from `start`, counter-clockwise over `length`, rad; `start` in [0, 2 pi), `length` up to 2 pi.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadingArc {
    /// The first heading.
    pub start: f64,
    /// Length of the interval.
    pub length: f64,
}

impl HeadingArc {
    /// All headings.
    pub const FULL: Self = Self { start: 0.0, length: TAU };

    /// Free turn from `heading` until the interval begins, counter-clockwise and clockwise, rad; zeros inside.
    pub fn free_turn_from(&self, heading: f64) -> (f64, f64) {
        let left = (self.start - heading).rem_euclid(TAU);
        if self.length >= TAU || left + self.length > TAU {
            (0.0, 0.0)
        } else {
            (left, TAU - left - self.length)
        }
    }
}

/// Tolerance of the range tests, m. Too large a value costs additional overlap tests, too small a value misses contacts. Source: ours, far
/// above the rounding error of a length of metres.
const RANGE_SLACK_M: f64 = 1e-7;

/// Adds the headings at which a segment overlaps the hull. The segment is relative to the base's origin, in the axes in which
/// headings are measured. `angles` is a buffer, to save allocations.
pub fn blocked_headings(
    hull: &RoundedHull,
    segment: &Segment,
    angles: &mut Vec<f64>,
    blocked: &mut Vec<HeadingArc>,
) {
    if segment.is_point() && segment.a.norm_squared() >= hull.outer * hull.outer {
        return;
    }
    let nearest = segment.distance(Vector2::zeros());
    if nearest >= hull.outer {
        return;
    }
    if nearest < hull.inner {
        blocked.push(HeadingArc::FULL);
        return;
    }
    angles.clear();
    contacts_of_end(hull, segment.a, angles);
    if !segment.is_point() {
        contacts_of_end(hull, segment.b, angles);
        contacts_of_corners(hull, segment, angles);
    }
    decide(hull, segment, angles, blocked);
}

/// Headings at which the point `p` lies on the boundary.
fn contacts_of_end(hull: &RoundedHull, p: Vector2, angles: &mut Vec<f64>) {
    let distance = p.norm();
    if distance >= hull.outer || distance <= hull.inner || distance == 0.0 {
        return;
    }
    let bearing = p.y.atan2(p.x);
    for edge in &hull.edges {
        let cosine = (edge.offset + hull.radius) / distance;
        if cosine.abs() > 1.0 {
            continue;
        }
        // The circle meets the line of the side in two points: distance * sine to both sides of the foot of the axle's centre.
        let (along, sine) = (edge.side.b - edge.side.a, (1.0 - cosine * cosine).sqrt());
        let unit = Vector2::new(-edge.normal.y, edge.normal.x);
        let (low, high) = (unit.dot(&edge.side.a), unit.dot(&edge.side.a) + along.norm());
        for sign in [-1.0, 1.0] {
            let at = sign * distance * sine;
            if at > low - RANGE_SLACK_M && at < high + RANGE_SLACK_M {
                angles.push(bearing - edge.normal_bearing - sign * cosine.acos());
            }
        }
    }
    for corner in &hull.core {
        if corner.distance > 0.0 && (distance - corner.distance).abs() <= hull.radius {
            let squares = distance * distance + corner.distance * corner.distance - hull.radius * hull.radius;
            let cosine = squares / (2.0 * distance * corner.distance);
            let half = cosine.clamp(-1.0, 1.0).acos();
            angles.extend([bearing - corner.bearing - half, bearing - corner.bearing + half]);
        }
    }
}

/// Headings at which a corner of the core is a radius away from the inner part of the segment.
fn contacts_of_corners(hull: &RoundedHull, segment: &Segment, angles: &mut Vec<f64>) {
    let along = (segment.b - segment.a).normalize();
    let mut normal = Vector2::new(along.y, -along.x);
    let mut offset = normal.dot(&segment.a);
    if offset < 0.0 {
        (normal, offset) = (-normal, -offset);
    }
    let unit = Vector2::new(-normal.y, normal.x);
    let (p, q) = (unit.dot(&segment.a), unit.dot(&segment.b));
    let (low, high) = (p.min(q) - RANGE_SLACK_M, p.max(q) + RANGE_SLACK_M);
    let normal_bearing = normal.y.atan2(normal.x);
    // With the axle's centre inside the hull, a corner beyond the segment is no event: a side of the hull still crosses the segment.
    let sides: &[f64] = if hull.inner > 0.0 && offset > hull.radius { &[-1.0] } else { &[-1.0, 1.0] };
    for corner in hull.core.iter().filter(|c| c.distance > 0.0) {
        for side in sides {
            let cosine = (offset + side * hull.radius) / corner.distance;
            if cosine.abs() > 1.0 {
                continue;
            }
            let (half, sine) = (cosine.acos(), (1.0 - cosine * cosine).sqrt());
            for sign in [-1.0, 1.0] {
                let at = sign * corner.distance * sine;
                if at > low && at < high {
                    angles.push(normal_bearing + sign * half - corner.bearing);
                }
            }
        }
    }
}

/// Tests the middle of every interval between neighbouring events.
fn decide(hull: &RoundedHull, segment: &Segment, angles: &mut [f64], blocked: &mut Vec<HeadingArc>) {
    let overlaps_at = |heading: f64| {
        let (sin, cos) = heading.sin_cos();
        hull.overlaps(&segment.in_frame(Vector2::zeros(), cos, sin))
    };
    if angles.is_empty() {
        if overlaps_at(0.0) {
            blocked.push(HeadingArc::FULL);
        }
        return;
    }
    for angle in angles.iter_mut() {
        *angle = angle.rem_euclid(TAU);
    }
    angles.sort_unstable_by(f64::total_cmp);
    let first_new = blocked.len();
    for (i, &start) in angles.iter().enumerate() {
        let end = if i + 1 < angles.len() { angles[i + 1] } else { angles[0] + TAU };
        let length = end - start;
        if length > 1e-12 && overlaps_at(start + length / 2.0) {
            match blocked[first_new..].last_mut() {
                Some(last) if last.start + last.length >= start - 1e-12 => last.length = end - last.start,
                _ => blocked.push(HeadingArc { start, length }),
            }
        }
    }
}
