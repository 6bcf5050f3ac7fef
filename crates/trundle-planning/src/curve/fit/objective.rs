//! The objective of the program: distance from the path, and smoothness.

use crate::curve::bezier::binomial;
use crate::curve::fit::layout::{Layout, Triplets};
use crate::curve::fit::segment::PathSegment;
use clarabel::algebra::CscMatrix;
use nalgebra::DMatrix;

/// Weight of the second derivative relative to the third, as a share of the smoothing length. Source: ours.
const BENDING_SHARE: f64 = 0.4;

/// 1/2 x'Px + q'x of integral |p - path|^2 + (0.4 l)^4 |p''|^2 + l^6 |p'''|^2 ds, l the smoothing length.
///
/// The least squares over infinitely dense samples of the path, in closed form: Gram matrices of the Bernstein basis.
/// Unknowns: x and y of each vector of the layout.
pub(super) fn objective(
    segments: &[PathSegment],
    layout: Layout,
    smoothing: f64,
) -> (CscMatrix<f64>, Vec<f64>) {
    let unknowns = layout.vectors() * 2;
    let grams = Grams::new(layout.degree);
    let mut q = vec![0.0; unknowns];
    let mut p = Triplets::default();
    for (i, segment) in segments.iter().enumerate() {
        let span = segment.length();
        let from_unknowns = control_from_unknowns(layout, span);
        let hessian = from_unknowns.tr_mul(&(grams.hessian(span, smoothing) * &from_unknowns));
        let linear = from_unknowns.tr_mul(&(&grams.position * span * straight(segment, layout.degree)));
        let first = layout.first(i);
        for row in 0..=layout.degree {
            q[(first + row) * 2] -= linear[(row, 0)];
            q[(first + row) * 2 + 1] -= linear[(row, 1)];
            for col in row..=layout.degree {
                for axis in 0..2 {
                    p.add((first + row) * 2 + axis, (first + col) * 2 + axis, hessian[(row, col)]);
                }
            }
        }
    }
    (p.finish(unknowns, unknowns), q)
}

/// The matrix that maps a piece's own unknown vectors to its control points.
fn control_from_unknowns(layout: Layout, span: f64) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(layout.degree + 1, layout.degree + 1);
    for k in 0..=layout.degree {
        let (terms, count) = layout.control(0, k, span);
        for (vector, share) in &terms[..count] {
            matrix[(k, *vector)] += share;
        }
    }
    matrix
}

/// The control points of the straight segment itself, a row each.
fn straight(segment: &PathSegment, degree: usize) -> DMatrix<f64> {
    let at = |k: usize| segment.from + (segment.to - segment.from) * (k as f64 / degree as f64);
    DMatrix::from_fn(degree + 1, 2, |k, axis| at(k)[axis])
}

/// Integrals over u in \[0, 1\] of products of the basis and of its derivatives.
struct Grams {
    position: DMatrix<f64>,
    second: DMatrix<f64>,
    third: DMatrix<f64>,
}

impl Grams {
    fn new(degree: usize) -> Self {
        Self {
            position: derivative_gram(degree, 0),
            second: derivative_gram(degree, 2),
            third: derivative_gram(degree, 3),
        }
    }

    /// For a piece of `span` m: d/ds = d/du / span.
    fn hessian(&self, span: f64, smoothing: f64) -> DMatrix<f64> {
        let curvature_weight = (BENDING_SHARE * smoothing).powi(4) / span.powi(3);
        let change = smoothing.powi(6) / span.powi(5);
        &self.position * span + &self.second * curvature_weight + &self.third * change
    }
}

/// The Gram matrix of the `order`-th derivatives of the Bernstein basis.
fn derivative_gram(degree: usize, order: usize) -> DMatrix<f64> {
    let m = degree - order;
    let gram = DMatrix::from_fn(m + 1, m + 1, |i, j| {
        binomial(m, i) * binomial(m, j) / (binomial(2 * m, i + j) * (2 * m + 1) as f64)
    });
    let mut differences = DMatrix::<f64>::identity(degree + 1, degree + 1);
    for step in 0..order {
        let left = degree - step;
        differences = (differences.rows(1, left) - differences.rows(0, left)) * left as f64;
    }
    differences.transpose() * gram * differences
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grams_integrate_polynomials() {
        // p = u^2 has Bernstein coefficients i(i-1)/20 at degree 5: integrals of p^2, p''^2, p'''^2 are 1/5, 4, 0.
        let p = nalgebra::DVector::from_fn(6, |i, _| (i as f64) * (i as f64 - 1.0) / 20.0);
        for (order, integral) in [(0, 0.2), (2, 4.0), (3, 0.0)] {
            assert!((p.dot(&(derivative_gram(5, order) * &p)) - integral).abs() < 1e-12);
        }
    }
}
