//! Polynomial pieces in the Bernstein basis.

use trundle_core::Vector2;

/// One polynomial piece of a curve in the Bernstein basis: a Bezier curve over `span` metres of chord.
///
/// The piece is inside the convex hull of its control points. The parameter is u = s / span in \[0, 1\].
#[derive(Debug, Clone, PartialEq)]
pub struct BezierPiece {
    control: Vec<Vector2>,
    /// Coefficients of u^k.
    powers: Vec<Vector2>,
    span: f64,
}

/// Position, and first and second derivative by chord length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Jet {
    pub(crate) position: Vector2,
    pub(crate) derivative: Vector2,
    pub(crate) second: Vector2,
}

impl BezierPiece {
    /// A piece from its control points (two or more) and its chord length, m, above 0.
    pub(crate) fn new(control: Vec<Vector2>, span: f64) -> Self {
        debug_assert!(control.len() >= 2 && span > 0.0, "{} control points over {span} m", control.len());
        let powers = monomials(&control);
        Self { control, powers, span }
    }

    /// The control points, map frame, m.
    pub fn control(&self) -> &[Vector2] {
        &self.control
    }

    /// Chord length of the piece, m.
    pub fn span(&self) -> f64 {
        self.span
    }

    /// The coefficients (a_i, b_i) of x = sum a_i u^i, y = sum b_i u^i: the form of \[Li18\], of the same polynomial.
    pub fn monomials(&self) -> Vec<Vector2> {
        self.powers.clone()
    }

    /// Position and derivatives at `u` by Horner's rule, accurate to 1e-12 m.
    pub(crate) fn jet(&self, u: f64) -> Jet {
        let (mut p, mut d, mut h) = (Vector2::zeros(), Vector2::zeros(), Vector2::zeros());
        for coefficient in self.powers.iter().rev() {
            h = h * u + d;
            d = d * u + p;
            p = p * u + coefficient;
        }
        let per_metre = 1.0 / self.span;
        Jet { position: p, derivative: d * per_metre, second: h * (2.0 * per_metre * per_metre) }
    }

    /// The position at `u`, map frame, m.
    pub fn position(&self, u: f64) -> Vector2 {
        de_casteljau(&self.control, u, 0)
    }

    /// The derivative by chord length at `u`.
    pub fn derivative(&self, u: f64) -> Vector2 {
        de_casteljau(&self.control, u, 1) * (self.degree() as f64 / self.span)
    }

    /// The second derivative by chord length at `u`, 1/m.
    pub fn second_derivative(&self, u: f64) -> Vector2 {
        let n = self.degree() as f64;
        if n < 2.0 {
            return Vector2::zeros();
        }
        de_casteljau(&self.control, u, 2) * (n * (n - 1.0) / (self.span * self.span))
    }

    fn degree(&self) -> usize {
        self.control.len() - 1
    }
}

fn monomials(control: &[Vector2]) -> Vec<Vector2> {
    let n = control.len() - 1;
    let mut differences = control.to_vec();
    let mut coefficient = |i: usize| {
        let first = differences[0] * binomial(n, i);
        for k in 0..n - i {
            differences[k] = differences[k + 1] - differences[k];
        }
        first
    };
    (0..=n).map(&mut coefficient).collect()
}

/// Largest number of control points evaluated without an allocation. More are a programming error. Source: ours.
const MAX_CONTROL_POINTS: usize = 16;

/// Evaluates the polynomial of the `order`-th differences of `control` at `u`.
fn de_casteljau(control: &[Vector2], u: f64, order: usize) -> Vector2 {
    let mut work = [Vector2::zeros(); MAX_CONTROL_POINTS];
    let mut left = control.len();
    debug_assert!(left <= MAX_CONTROL_POINTS, "degree {} above {}", left - 1, MAX_CONTROL_POINTS - 1);
    work[..left].copy_from_slice(control);
    for _ in 0..order {
        left -= 1;
        for k in 0..left {
            work[k] = work[k + 1] - work[k];
        }
    }
    while left > 1 {
        left -= 1;
        for k in 0..left {
            work[k] += (work[k + 1] - work[k]) * u;
        }
    }
    work[0]
}

/// n over k.
pub(crate) fn binomial(n: usize, k: usize) -> f64 {
    (0..k.min(n - k)).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn monomials_and_derivatives_agree_with_the_control_points() {
        let points = [(0.0, 0.0), (1.0, 2.0), (3.0, -1.0), (4.0, 0.5), (6.0, 1.0), (7.0, 7.0)];
        let piece = BezierPiece::new(points.iter().map(|p| Vector2::new(p.0, p.1)).collect(), 2.0);
        let coefficients = piece.monomials();
        for u in [0.0, 0.3, 0.77, 1.0] {
            let sum = coefficients.iter().rev().fold(Vector2::zeros(), |sum, c| sum * u + c);
            assert!((sum - piece.position(u)).norm() < 1e-12);
            let h = 1e-5;
            let d = (piece.position(u + h) - piece.position(u - h)) / (2.0 * h * 2.0);
            assert!((d - piece.derivative(u)).norm() < 1e-8);
            let dd = (piece.derivative(u + h) - piece.derivative(u - h)) / (2.0 * h * 2.0);
            assert!((dd - piece.second_derivative(u)).norm() < 1e-7);
            let jet = piece.jet(u);
            assert!((jet.position - piece.position(u)).norm() < 1e-12);
            assert!((jet.derivative - piece.derivative(u)).norm() < 1e-12);
            assert!((jet.second - piece.second_derivative(u)).norm() < 1e-12);
        }
    }
}
