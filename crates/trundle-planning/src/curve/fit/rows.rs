//! The constraints of the program: the rows of Ax + s = b, s = 0 for equalities, s >= 0 for inequalities.

use crate::curve::bezier::binomial;
use crate::curve::fit::layout::{Layout, Triplets};
use crate::curve::fit::segment::{PathSegment, Tangent};
use clarabel::algebra::CscMatrix;
use trundle_core::Vector2;

/// A control point and a side of its segment's corridor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    pub(super) piece: usize,
    pub(super) control: usize,
    pub(super) plane: usize,
}

pub(super) struct Rows<'a> {
    layout: Layout,
    segments: &'a [PathSegment],
    entries: Triplets,
    right: Vec<f64>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(layout: Layout, segments: &'a [PathSegment]) -> Self {
        Self { layout, segments, entries: Triplets::default(), right: vec![] }
    }

    pub(super) fn count(&self) -> usize {
        self.right.len()
    }

    pub(super) fn finish(self) -> (CscMatrix<f64>, Vec<f64>) {
        (self.entries.finish(self.right.len(), self.layout.vectors() * 2), self.right)
    }

    /// End points and end tangents: equalities.
    pub(super) fn ends(&mut self, start: Tangent, end: Tangent) {
        let last = self.layout.pieces;
        self.fix(self.layout.knot(0, 0), self.segments[0].from);
        self.fix(self.layout.knot(last, 0), self.segments[last - 1].to);
        self.tangent(0, start);
        self.tangent(last, end);
    }

    /// x' sin(theta) - y' cos(theta) = 0, and for a start in motion also speed and curvature.
    fn tangent(&mut self, knot: usize, tangent: Tangent) {
        let velocity = self.layout.knot(knot, 1);
        match tangent {
            Tangent::Free => {}
            Tangent::Heading(theta) => self.row(velocity, Vector2::new(theta.sin(), -theta.cos()), 0.0),
            Tangent::Moving(theta, curvature) => {
                let along = Vector2::new(theta.cos(), theta.sin());
                self.fix(velocity, along);
                self.row(self.layout.knot(knot, 2), Vector2::new(-along.y, along.x), curvature);
            }
        }
    }

    /// x' cos(theta) + y' sin(theta) >= min at both ends; along the segment if the heading is free.
    pub(super) fn forward(&mut self, start: Tangent, end: Tangent, min: f64) {
        let last = self.layout.pieces;
        let ends = [(0, start, &self.segments[0]), (last, end, &self.segments[last - 1])];
        for (knot, tangent, segment) in ends {
            let along = match tangent {
                Tangent::Moving(..) => continue,
                Tangent::Heading(theta) => Vector2::new(theta.cos(), theta.sin()),
                Tangent::Free => (segment.to - segment.from) / segment.length(),
            };
            self.row(self.layout.knot(knot, 1), -along, -min);
        }
    }

    /// Control points on the inner side of corridor sides.
    pub(super) fn sides(&mut self, sides: &[Side]) {
        for side in sides {
            let segment = &self.segments[side.piece];
            let plane = segment.planes[side.plane];
            let (terms, count) = self.layout.control(side.piece, side.control, segment.length());
            for (vector, share) in &terms[..count] {
                self.put(*vector, plane.normal * *share);
            }
            self.right.push(plane.offset);
        }
    }

    /// first . p'(u) + second . p''(u) <= right on a piece.
    pub(super) fn derivatives(&mut self, piece: usize, u: f64, first: Vector2, second: Vector2, right: f64) {
        let (n, span) = (self.layout.degree, self.segments[piece].length());
        let basis = |degree: usize, k: isize| match usize::try_from(k) {
            Ok(k) if k <= degree => {
                binomial(degree, k) * u.powi(k as i32) * (1.0 - u).powi((degree - k) as i32)
            }
            _ => 0.0,
        };
        for k in 0..=n {
            let i = k as isize;
            let by_first = (basis(n - 1, i - 1) - basis(n - 1, i)) * n as f64 / span;
            let twice = basis(n - 2, i - 2) - 2.0 * basis(n - 2, i - 1) + basis(n - 2, i);
            let by_second = twice * (n * (n - 1)) as f64 / (span * span);
            let (terms, count) = self.layout.control(piece, k, span);
            for (vector, share) in &terms[..count] {
                self.put(*vector, (first * by_first + second * by_second) * *share);
            }
        }
        self.right.push(right);
    }

    fn fix(&mut self, vector: usize, at: Vector2) {
        self.row(vector, Vector2::x(), at.x);
        self.row(vector, Vector2::y(), at.y);
    }

    /// factor . vector = (or at most) right.
    fn row(&mut self, vector: usize, factor: Vector2, right: f64) {
        self.put(vector, factor);
        self.right.push(right);
    }

    fn put(&mut self, vector: usize, factor: Vector2) {
        self.entries.add(self.right.len(), vector * 2, factor.x);
        self.entries.add(self.right.len(), vector * 2 + 1, factor.y);
    }
}
