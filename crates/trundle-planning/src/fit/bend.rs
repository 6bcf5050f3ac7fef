//! Bounded curvature, inside the programme.
//!
//! Problem: |p' x p''| <= k |p'|^3 is no linear row. Idea: where the last curve bends too much, the bound is linearised about
//! that curve, and the programme is solved again, until the curve keeps it (sequential linear constraints, \[Nocedal06\] ch. 18).
//! The rows act on p' and p'' alike, so the curve may bend less or reach further. Cost: a row of two knots a place.

use super::rows::Rows;
use crate::curve::Curve;
use trundle_core::Vector2;

/// A place on the curve: piece, and u along it.
pub(super) type Place = (usize, f64);

/// Places looked at a piece.
const LOOKS: usize = 16;
/// The share of the bound that is asked for, so that what lies between two looks keeps it too.
const SHARE: f64 = 0.97;

/// Parametric speed below which a curve is near a cusp, where no small change helps.
const CUSP: f64 = 0.3;

/// The places where the curve bends more than `most`, 1/m; `None` when it is near a cusp at one of them.
pub(super) fn bent(curve: &Curve, most: f64) -> Option<Vec<Place>> {
    let mut places = Vec::new();
    for (piece, bezier) in curve.pieces().iter().enumerate() {
        for k in 0..=LOOKS {
            let u = k as f64 / LOOKS as f64;
            let jet = bezier.jet(u);
            let speed = jet.derivative.norm();
            if jet.derivative.perp(&jet.second).abs() > most * speed * speed * speed {
                if speed < CUSP {
                    return None;
                }
                places.push((piece, u));
            }
        }
    }
    Some(places)
}

impl Rows<'_> {
    /// The bound at each place, linearised about `curve`.
    pub(super) fn bends(&mut self, curve: &Curve, places: &[Place], most: f64) {
        for (piece, u) in places {
            let jet = curve.pieces()[*piece].jet(*u);
            let (d, dd, speed) = (jet.derivative, jet.second, jet.derivative.norm().max(1e-3));
            let side = if d.perp(&dd) < 0.0 { -1.0 } else { 1.0 };
            let value = side * d.perp(&dd) - SHARE * most * speed.powi(3);
            let by_d = Vector2::new(dd.y, -dd.x) * side - d * (3.0 * SHARE * most * speed);
            let by_dd = Vector2::new(-d.y, d.x) * side;
            let right = by_d.dot(&d) + by_dd.dot(&dd) - value;
            // In units of p'', as the other rows are of p and p'.
            self.derivatives(*piece, *u, by_d / speed, by_dd / speed, right / speed);
        }
    }
}
