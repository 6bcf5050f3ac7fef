//! Turns on the spot: which headings a piece of the surroundings forbids, in closed form.
//!
//! A footprint that turns sweeps annulus sectors. Contact begins or ends in one of two ways only: an end of the piece lies
//! on the hull's boundary (a circle about the axle meets an offset side or a round corner), or a corner of the core is a
//! radius away from the piece (the corner's circle meets a line). Between neighbouring such headings nothing changes, so
//! one test in the middle of each gap decides it.

use super::hull::Hull;
use super::segment::Segment;
use std::f64::consts::TAU;
use trundle_core::Vector2;

/// Headings from `start` on, counter-clockwise over `length`, rad; `start` in [0, 2 pi), `length` up to 2 pi.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// The first heading.
    pub start: f64,
    /// How far it reaches.
    pub length: f64,
}

impl Arc {
    /// Every heading.
    pub const FULL: Self = Self { start: 0.0, length: TAU };

    /// How far counter-clockwise and how far clockwise one may turn from `heading` until the arc begins; zeros inside.
    pub fn room_from(&self, heading: f64) -> (f64, f64) {
        let left = (self.start - heading).rem_euclid(TAU);
        if self.length >= TAU || left + self.length > TAU {
            (0.0, 0.0)
        } else {
            (left, TAU - left - self.length)
        }
    }
}

/// Slack of the span tests, m: a candidate too many costs one test, a candidate too few a contact.
const SPAN_SLACK: f64 = 1e-7;

impl Hull {
    /// Adds the headings at which a piece overlaps the hull. The piece is given relative to the base's origin, in the
    /// axes that headings count from. `angles` is scratch space.
    pub fn blocked_headings(&self, piece: &Segment, angles: &mut Vec<f64>, blocked: &mut Vec<Arc>) {
        if piece.is_point() && piece.a.norm_squared() >= self.outer * self.outer {
            return;
        }
        let nearest = piece.distance(Vector2::zeros());
        if nearest >= self.outer {
            return;
        }
        if nearest < self.inner {
            blocked.push(Arc::FULL);
            return;
        }
        angles.clear();
        self.contacts_of_end(piece.a, angles);
        if !piece.is_point() {
            self.contacts_of_end(piece.b, angles);
            self.contacts_of_corners(piece, angles);
        }
        self.decide(piece, angles, blocked);
    }

    /// Headings at which the point `p` lies on the boundary.
    fn contacts_of_end(&self, p: Vector2, angles: &mut Vec<f64>) {
        let distance = p.norm();
        if distance >= self.outer || distance <= self.inner || distance == 0.0 {
            return;
        }
        let bearing = p.y.atan2(p.x);
        for edge in &self.edges {
            let cosine = (edge.offset + self.radius) / distance;
            if cosine.abs() > 1.0 {
                continue;
            }
            // Along the side, from the foot of the axle: -/+ distance * sine for the two meeting points.
            let (along, sine) = (edge.side.b - edge.side.a, (1.0 - cosine * cosine).sqrt());
            let unit = Vector2::new(-edge.normal.y, edge.normal.x);
            let (low, high) = (unit.dot(&edge.side.a), unit.dot(&edge.side.a) + along.norm());
            for sign in [-1.0, 1.0] {
                let at = sign * distance * sine;
                if at > low - SPAN_SLACK && at < high + SPAN_SLACK {
                    angles.push(bearing - edge.normal_bearing - sign * cosine.acos());
                }
            }
        }
        for corner in &self.core {
            if corner.distance > 0.0 && (distance - corner.distance).abs() <= self.radius {
                let squares =
                    distance * distance + corner.distance * corner.distance - self.radius * self.radius;
                let cosine = squares / (2.0 * distance * corner.distance);
                let half = cosine.clamp(-1.0, 1.0).acos();
                angles.extend([bearing - corner.bearing - half, bearing - corner.bearing + half]);
            }
        }
    }

    /// Headings at which a corner of the core is a radius away from the inner part of the piece.
    fn contacts_of_corners(&self, piece: &Segment, angles: &mut Vec<f64>) {
        let along = (piece.b - piece.a).normalize();
        let mut normal = Vector2::new(along.y, -along.x);
        let mut offset = normal.dot(&piece.a);
        if offset < 0.0 {
            (normal, offset) = (-normal, -offset);
        }
        let unit = Vector2::new(-normal.y, normal.x);
        let (p, q) = (unit.dot(&piece.a), unit.dot(&piece.b));
        let (low, high) = (p.min(q) - SPAN_SLACK, p.max(q) + SPAN_SLACK);
        let normal_bearing = normal.y.atan2(normal.x);
        // With the axle inside, a corner beyond the piece leaves a side across it: no contact begins or ends there.
        let sides: &[f64] = if self.inner > 0.0 && offset > self.radius { &[-1.0] } else { &[-1.0, 1.0] };
        for corner in self.core.iter().filter(|c| c.distance > 0.0) {
            for side in sides {
                let cosine = (offset + side * self.radius) / corner.distance;
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

    /// Tests the middle of every gap between neighbouring contacts.
    fn decide(&self, piece: &Segment, angles: &mut [f64], blocked: &mut Vec<Arc>) {
        let overlaps_at = |heading: f64| {
            let (sin, cos) = heading.sin_cos();
            self.overlaps(&piece.seen_from(Vector2::zeros(), cos, sin))
        };
        if angles.is_empty() {
            if overlaps_at(0.0) {
                blocked.push(Arc::FULL);
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
                    _ => blocked.push(Arc { start, length }),
                }
            }
        }
    }
}
