//! Analytic curves of polynomial pieces.

use crate::curve::bezier::{BezierPiece, Jet};
use crate::curve::half_plane::HalfPlane;
use crate::geometry::bearing;
use trundle_core::{Pose2, Twist2, Vector2};

/// An analytic curve: polynomial pieces that meet in position, heading and curvature. The parameter s is the chord length along the
/// waypoints, m, from 0 to [`Curve::span`].
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pieces: Vec<BezierPiece>,
    /// Parameter at the start of each piece, m; one more than pieces.
    begins: Vec<f64>,
    /// Corridor of each piece; empty for curves that were not fitted.
    corridors: Vec<Vec<HalfPlane>>,
    active: Vec<ActiveRow>,
}

/// A corridor's side that constrains a control point: without it the curve would differ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActiveRow {
    /// Index of the piece.
    pub piece: usize,
    /// Index of the control point in its piece.
    pub control: usize,
    /// Index of the half-plane in the piece's corridor.
    pub plane: usize,
    /// The Lagrange multiplier, m^2: the decrease of the objective (m^3) per metre of clearance.
    pub multiplier: f64,
}

/// A point of a curve with the quantities that timing needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveSample {
    /// Parameter, m of chord.
    pub s: f64,
    /// Length along the curve from its start, m.
    pub arc: f64,
    /// Position and tangent direction, map frame.
    pub pose: Pose2,
    /// Signed curvature, counter-clockwise, 1/m.
    pub curvature: f64,
}

/// Parametric speed below which the tangent has no direction, ratio. Source: rounding of f64.
const MIN_PARAMETRIC_SPEED: f64 = 1e-9;

impl Curve {
    /// A curve from its pieces, at least one.
    pub(crate) fn new(pieces: Vec<BezierPiece>) -> Self {
        let mut begins = vec![0.0];
        for piece in &pieces {
            begins.push(begins[begins.len() - 1] + piece.span());
        }
        Self { pieces, begins, corridors: vec![], active: vec![] }
    }

    /// The same curve with its corridors and its active constraints.
    pub(crate) fn within(self, corridors: Vec<Vec<HalfPlane>>, active: Vec<ActiveRow>) -> Self {
        Self { corridors, active, ..self }
    }

    /// The straight line between two different points.
    pub(crate) fn line(from: Vector2, to: Vector2) -> Self {
        Self::new(vec![BezierPiece::new(vec![from, to], (to - from).norm())])
    }

    /// The arc of constant `curvature` (1/m) from `start`, `length` m long, as a quintic. The quintic equals the arc at both ends in
    /// position, heading and curvature.
    pub(crate) fn arc(start: Pose2, curvature: f64, length: f64) -> Self {
        let end = start.advance(Twist2::new(length, curvature * length), 1.0);
        let near = |pose: Pose2, side: f64| {
            let (along, step) = (pose.direction(), side * length / 5.0);
            let curvature_of = Vector2::new(-along.y, along.x) * (curvature * length * length / 20.0);
            let p = pose.position();
            [p, p + along * step, p + along * (2.0 * step) + curvature_of]
        };
        let ([a, b, c], [f, e, d]) = (near(start, 1.0), near(end, -1.0));
        Self::new(vec![BezierPiece::new(vec![a, b, c, d, e, f], length)])
    }

    /// The polynomial pieces.
    pub fn pieces(&self) -> &[BezierPiece] {
        &self.pieces
    }

    /// The convex free polygon of each piece: the control points are inside, and therefore the piece too. Empty for straight lines and
    /// braking arcs, whose clearance is checked directly.
    pub fn corridors(&self) -> &[Vec<HalfPlane>] {
        &self.corridors
    }

    /// The constraints that shape the curve.
    pub fn active(&self) -> &[ActiveRow] {
        &self.active
    }

    /// The end of the parameter, m of chord.
    pub fn span(&self) -> f64 {
        self.begins[self.pieces.len()]
    }

    /// The position at `s`, map frame, m.
    pub fn position(&self, s: f64) -> Vector2 {
        let (piece, u) = self.locate(s);
        piece.position(u)
    }

    /// The derivative by s.
    pub fn derivative(&self, s: f64) -> Vector2 {
        let (piece, u) = self.locate(s);
        piece.derivative(u)
    }

    /// Position and tangent direction at `s`, map frame.
    pub fn pose(&self, s: f64) -> Pose2 {
        self.pose_and_curvature(s).0
    }

    /// The signed curvature at `s`, counter-clockwise, 1/m; 0 if the tangent vanishes.
    pub fn curvature(&self, s: f64) -> f64 {
        self.pose_and_curvature(s).1
    }

    /// [`Curve::pose`] and [`Curve::curvature`] together.
    pub(crate) fn pose_and_curvature(&self, s: f64) -> (Pose2, f64) {
        let (piece, u) = self.locate(s);
        let jet = piece.jet(u);
        (pose(&jet), curvature_of(jet.derivative, jet.second))
    }

    /// The length along the curve, m, by Gauss's rule over eighths of each piece.
    pub fn length(&self) -> f64 {
        self.pieces.iter().map(piece_length).sum()
    }

    /// Samples at most about `spacing` m apart, both ends and all joints included.
    pub fn samples(&self, spacing: f64) -> Vec<CurveSample> {
        let mut samples = Vec::new();
        let mut arc = 0.0;
        for (piece, begin) in self.pieces.iter().zip(&self.begins) {
            let count = (crate::geometry::polyline_length(piece.control()) / spacing).ceil().clamp(4.0, 1e5);
            let step = 1.0 / count;
            let mut last = piece.jet(0.0);
            if samples.is_empty() {
                samples.push(sample(&last, *begin, arc));
            }
            for k in 1..=count as usize {
                let u = k as f64 * step;
                let next = piece.jet(u);
                arc += length_between(&last, &next, step * piece.span());
                let s = if k == count as usize { begin + piece.span() } else { begin + u * piece.span() };
                samples.push(sample(&next, s, arc));
                last = next;
            }
        }
        samples
    }

    fn locate(&self, s: f64) -> (&BezierPiece, f64) {
        let after = self.begins[1..self.pieces.len()].partition_point(|begin| *begin <= s);
        let piece = &self.pieces[after];
        (piece, ((s - self.begins[after]) / piece.span()).clamp(0.0, 1.0))
    }
}

fn sample(jet: &Jet, s: f64, arc: f64) -> CurveSample {
    CurveSample { s, arc, pose: pose(jet), curvature: curvature_of(jet.derivative, jet.second) }
}

fn pose(jet: &Jet) -> Pose2 {
    Pose2::new(jet.position.x, jet.position.y, bearing(jet.derivative))
}

/// The length of the curve over `span` m of chord, by the trapezoidal rule with its end correction.
fn length_between(a: &Jet, b: &Jet, span: f64) -> f64 {
    let speeds = (a.derivative.norm(), b.derivative.norm());
    let change = |jet: &Jet, speed: f64| jet.derivative.dot(&jet.second) / speed.max(MIN_PARAMETRIC_SPEED);
    let correction = (change(a, speeds.0) - change(b, speeds.1)) * span / 6.0;
    (speeds.0 + speeds.1 + correction).max(0.0) * span / 2.0
}

/// Three-point Gauss over each eighth.
fn piece_length(piece: &BezierPiece) -> f64 {
    let reach = 0.6_f64.sqrt() / 16.0;
    let speed = |u: f64| piece.derivative(u).norm();
    let eighth = |k: i32| {
        let middle = (f64::from(k) + 0.5) / 8.0;
        (5.0 * speed(middle - reach) + 8.0 * speed(middle) + 5.0 * speed(middle + reach)) / 18.0
    };
    (0..8).map(eighth).sum::<f64>() / 8.0 * piece.span()
}

fn curvature_of(derivative: Vector2, second: Vector2) -> f64 {
    let speed = derivative.norm();
    if speed < MIN_PARAMETRIC_SPEED { 0.0 } else { derivative.perp(&second) / (speed * speed * speed) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_circle_has_the_right_length_and_curvature() {
        let k = 0.5522847498307936;
        let control = [(1.0, 0.0), (1.0, k), (k, 1.0), (0.0, 1.0)].map(|(x, y)| Vector2::new(x, y));
        let curve = Curve::new(vec![BezierPiece::new(control.to_vec(), 1.5)]);
        assert!((curve.length() - std::f64::consts::FRAC_PI_2).abs() < 1e-3);
        let arc = curve.samples(0.01).last().map(|sample| sample.arc);
        assert!((curve.length() - arc.unwrap()).abs() < 1e-7);
        assert!((curve.curvature(0.7) - 1.0).abs() < 0.02);
        assert!((curve.pose(0.0).theta - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }

    #[test]
    fn arcs_have_the_right_end_pose_and_curvature() {
        let start = Pose2::new(1.0, 2.0, 0.7);
        let curve = Curve::arc(start, -2.0, 0.5);
        let end = start.advance(Twist2::new(0.5, -1.0), 1.0);
        assert!(curve.pose(0.5).distance(&end) < 1e-12 && (curve.pose(0.5).theta - end.theta).abs() < 1e-12);
        assert!((curve.length() - 0.5).abs() < 1e-4);
        assert!((0..=10).all(|i| (curve.curvature(f64::from(i) / 20.0) + 2.0).abs() < 0.05));
    }
}
