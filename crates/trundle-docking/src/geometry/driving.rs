//! Straight moves: how far until the swept hull meets a piece of the surroundings, in closed form.
//!
//! Along x the way to a piece is X(y) - F(y) over the heights y they share: the piece is a line X, the hull's front F is
//! concave, so the way is convex in y and least where the front is parallel to the piece, or at the end of the shared
//! heights that lies nearest.

use super::hull::Hull;
use super::segment::Segment;
use trundle_core::Vector2;

/// Heights shared by less than this are a graze along a side, not a contact, m.
const GRAZE: f64 = 1e-9;

/// On which side a piece stands in the way, and how far off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InTheWay {
    /// Metres of free way forward.
    Ahead(f64),
    /// Metres of free way backward.
    Behind(f64),
}

impl Hull {
    /// Where a piece, given in the base frame and not overlapping the hull, stops a straight move; `None` when nowhere.
    pub fn stop_by(&self, piece: &Segment) -> Option<InTheWay> {
        let (bottom, top) = self.core_extent(Vector2::y());
        let low = piece.a.y.min(piece.b.y).max(bottom - self.radius + GRAZE);
        let high = piece.a.y.max(piece.b.y).min(top + self.radius - GRAZE);
        if low > high {
            return None;
        }
        let middle = (low + high) / 2.0;
        let ahead = x_at(piece, middle) > (self.front(middle, 1.0) - self.front(middle, -1.0)) / 2.0;
        let sign = if ahead { 1.0 } else { -1.0 };
        let y = self.parallel_height(piece, sign).map_or(middle, |y| y.clamp(low, high));
        let x = if piece.a.y == piece.b.y { nearer_end(piece, sign) } else { x_at(piece, y) };
        let way = (sign * x - self.front(y, sign)).max(0.0);
        Some(if ahead { InTheWay::Ahead(way) } else { InTheWay::Behind(way) })
    }

    /// How far the hull reaches at height `y`: along x for `sign` 1, against x for -1.
    pub(super) fn front(&self, y: f64, sign: f64) -> f64 {
        let mut reach = f64::NEG_INFINITY;
        for corner in &self.core {
            let up = y - corner.at.y;
            if up.abs() <= self.radius {
                reach = reach.max(sign * corner.at.x + (self.radius * self.radius - up * up).sqrt());
            }
        }
        for edge in self.edges.iter().filter(|e| sign * e.normal.x > 0.0) {
            let shift = edge.normal * self.radius;
            let (a, b) = (edge.side.a + shift, edge.side.b + shift);
            if y >= a.y.min(b.y) && y <= a.y.max(b.y) {
                reach = reach.max(sign * x_at(&Segment { a, b }, y));
            }
        }
        reach
    }

    /// The height of the front point whose tangent is parallel to the piece; `None` for a point or a level piece.
    fn parallel_height(&self, piece: &Segment, sign: f64) -> Option<f64> {
        let along = piece.b - piece.a;
        if along.y == 0.0 {
            return None;
        }
        let normal = Vector2::new(along.y, -along.x).normalize();
        let normal = if normal.x * sign < 0.0 { -normal } else { normal };
        let foremost = self.core.iter().max_by(|p, q| normal.dot(&p.at).total_cmp(&normal.dot(&q.at)));
        foremost.map(|corner| corner.at.y + self.radius * normal.y)
    }
}

/// The x of a piece at height `y`; of its first end when it is level.
fn x_at(piece: &Segment, y: f64) -> f64 {
    let rise = piece.b.y - piece.a.y;
    if rise == 0.0 {
        piece.a.x
    } else {
        piece.a.x + (piece.b.x - piece.a.x) * ((y - piece.a.y) / rise).clamp(0.0, 1.0)
    }
}

/// The end of a level piece that a move along x (`sign` 1) or against it (-1) meets first.
fn nearer_end(piece: &Segment, sign: f64) -> f64 {
    if sign > 0.0 { piece.a.x.min(piece.b.x) } else { piece.a.x.max(piece.b.x) }
}
