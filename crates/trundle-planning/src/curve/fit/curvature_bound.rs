//! The curvature bound of the quadratic program.
//!
//! Problem: |p' x p''| <= k |p'|^3 is not linear. Idea: the bound is linearised about the last curve where the curve exceeds the bound, and
//! the program is solved again until the curve satisfies the bound (sequential linear constraints, \[Nocedal06\] ch. 18). The rows act on
//! p' and p'' alike, so the curve may get a smaller curvature or a wider swing. Cost: one row of two knots per point.

use crate::curve::analytic_curve::Curve;
use crate::curve::fit::rows::Rows;
use trundle_core::Vector2;

/// A point on the curve: piece, and u along it.
pub(super) type CurvePoint = (usize, f64);

/// Number of points checked per piece. Source: ours.
const CHECKS_PER_PIECE: usize = 16;
/// Share of the bound used in the rows, which leaves room for points between two checks. Source: ours.
const BOUND_SHARE: f64 = 0.97;

/// Parametric speed below which a curve is near a cusp, ratio: a small change of the curve has no effect there. Source: ours.
const MIN_PARAMETRIC_SPEED: f64 = 0.3;

/// The points at which the curve's curvature exceeds `max`, 1/m; `None` if the curve is near a cusp at one of them.
pub(super) fn exceeding(curve: &Curve, max: f64) -> Option<Vec<CurvePoint>> {
    let mut points = Vec::new();
    for (piece, bezier) in curve.pieces().iter().enumerate() {
        for k in 0..=CHECKS_PER_PIECE {
            let u = k as f64 / CHECKS_PER_PIECE as f64;
            let jet = bezier.jet(u);
            let speed = jet.derivative.norm();
            if jet.derivative.perp(&jet.second).abs() > max * speed * speed * speed {
                if speed < MIN_PARAMETRIC_SPEED {
                    return None;
                }
                points.push((piece, u));
            }
        }
    }
    Some(points)
}

impl Rows<'_> {
    /// The bound at each point, linearised about `curve`.
    pub(super) fn curvature_bounds(&mut self, curve: &Curve, points: &[CurvePoint], max: f64) {
        for (piece, u) in points {
            let jet = curve.pieces()[*piece].jet(*u);
            let (d, dd, speed) = (jet.derivative, jet.second, jet.derivative.norm().max(1e-3));
            let side = if d.perp(&dd) < 0.0 { -1.0 } else { 1.0 };
            let value = side * d.perp(&dd) - BOUND_SHARE * max * speed.powi(3);
            let by_d = Vector2::new(dd.y, -dd.x) * side - d * (3.0 * BOUND_SHARE * max * speed);
            let by_dd = Vector2::new(-d.y, d.x) * side;
            let right = by_d.dot(&d) + by_dd.dot(&dd) - value;
            // In units of p'', like the rows of p and p'.
            self.derivatives(*piece, *u, by_d / speed, by_dd / speed, right / speed);
        }
    }
}
