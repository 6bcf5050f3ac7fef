use crate::bezier::BezierPiece;
use crate::geometry::bearing;
use trundle_core::{Pose2, Vector2};

/// An analytic curve: polynomial pieces that meet in position, heading and curvature. Its parameter s is chord length
/// along the way-points, m, from 0 to [`Curve::span`].
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pieces: Vec<BezierPiece>,
    /// Where each piece begins, m; one more than pieces.
    begins: Vec<f64>,
}

/// A curve's point with everything that timing asks for.
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

/// Below this length the tangent has no direction.
const LEAST_SPEED: f64 = 1e-9;

impl Curve {
    /// A curve from its pieces, at least one.
    pub(crate) fn new(pieces: Vec<BezierPiece>) -> Self {
        let mut begins = vec![0.0];
        for piece in &pieces {
            begins.push(begins[begins.len() - 1] + piece.span());
        }
        Self { pieces, begins }
    }

    /// The straight line between two different points.
    pub(crate) fn line(from: Vector2, to: Vector2) -> Self {
        Self::new(vec![BezierPiece::new(vec![from, to], (to - from).norm())])
    }

    /// The pieces, whose coefficients are theirs to tell.
    pub fn pieces(&self) -> &[BezierPiece] {
        &self.pieces
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
        let (piece, u) = self.locate(s);
        let position = piece.position(u);
        Pose2::new(position.x, position.y, bearing(piece.derivative(u)))
    }

    /// The signed curvature at `s`, counter-clockwise, 1/m; 0 where the tangent vanishes.
    pub fn curvature(&self, s: f64) -> f64 {
        let (piece, u) = self.locate(s);
        curvature(piece, u)
    }

    /// The length along the curve, m, by Simpson's rule over centimetres.
    pub fn length(&self) -> f64 {
        self.samples(0.01).last().map_or(0.0, |sample| sample.arc)
    }

    /// Samples at most about `spacing` m apart, both ends and all joints included.
    pub fn samples(&self, spacing: f64) -> Vec<CurveSample> {
        let mut samples = Vec::new();
        let mut arc = 0.0;
        for (piece, begin) in self.pieces.iter().zip(&self.begins) {
            let count = (crate::geometry::polyline_length(piece.control()) / spacing).ceil().clamp(4.0, 1e5);
            let step = 1.0 / count;
            if samples.is_empty() {
                samples.push(sample(piece, *begin, 0.0, 0.0));
            }
            for k in 1..=count as usize {
                let u = k as f64 * step;
                arc += simpson(piece, u - step, u);
                samples.push(sample(piece, *begin, u, arc));
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

fn sample(piece: &BezierPiece, begin: f64, u: f64, arc: f64) -> CurveSample {
    let position = piece.position(u);
    let pose = Pose2::new(position.x, position.y, bearing(piece.derivative(u)));
    CurveSample { s: begin + u * piece.span(), arc, pose, curvature: curvature(piece, u) }
}

fn simpson(piece: &BezierPiece, from: f64, to: f64) -> f64 {
    let speed = |u: f64| piece.derivative(u).norm();
    (speed(from) + 4.0 * speed((from + to) / 2.0) + speed(to)) * (to - from) * piece.span() / 6.0
}

fn curvature(piece: &BezierPiece, u: f64) -> f64 {
    let derivative = piece.derivative(u);
    let speed = derivative.norm();
    if speed < LEAST_SPEED {
        return 0.0;
    }
    derivative.perp(&piece.second_derivative(u)) / (speed * speed * speed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_circle_has_its_length_and_curvature() {
        let k = 0.5522847498307936;
        let control = [(1.0, 0.0), (1.0, k), (k, 1.0), (0.0, 1.0)].map(|(x, y)| Vector2::new(x, y));
        let curve = Curve::new(vec![BezierPiece::new(control.to_vec(), 1.5)]);
        assert!((curve.length() - std::f64::consts::FRAC_PI_2).abs() < 1e-3);
        assert!((curve.curvature(0.7) - 1.0).abs() < 0.02);
        assert!((curve.pose(0.0).theta - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }
}
