//! What the curve must keep: the rows of Ax + s = b, s = 0 for equalities, s >= 0 for inequalities.

use super::{Stretch, Tangent};
use clarabel::algebra::CscMatrix;
use trundle_core::Vector2;

pub(super) struct Rows<'a> {
    degree: usize,
    stretches: &'a [Stretch],
    rows: Vec<usize>,
    cols: Vec<usize>,
    values: Vec<f64>,
    right: Vec<f64>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(degree: usize, stretches: &'a [Stretch]) -> Self {
        Self { degree, stretches, rows: vec![], cols: vec![], values: vec![], right: vec![] }
    }

    pub(super) fn count(&self) -> usize {
        self.right.len()
    }

    pub(super) fn finish(self) -> (CscMatrix<f64>, Vec<f64>) {
        let unknowns = self.stretches.len() * (self.degree + 1) * 2;
        let m = self.right.len();
        (CscMatrix::new_from_triplets(m, unknowns, self.rows, self.cols, self.values), self.right)
    }

    /// Neighbouring pieces meet in position, first and second derivative by chord length.
    pub(super) fn joints(&mut self) {
        for i in 1..self.stretches.len() {
            let (before, after) = (self.stretches[i - 1].length(), self.stretches[i].length());
            // Scaled by the longer span, so that the numbers stay near one.
            let scale = before.max(after);
            let (f, g) = (scale / before, scale / after);
            let (end, first) = (i * (self.degree + 1) - 1, i * (self.degree + 1));
            self.both_axes(&[(end, 1.0), (first, -1.0)]);
            self.both_axes(&[(end, f), (end - 1, -f), (first + 1, -g), (first, g)]);
            self.both_axes(&[
                (end, f * f),
                (end - 1, -2.0 * f * f),
                (end - 2, f * f),
                (first + 2, -g * g),
                (first + 1, 2.0 * g * g),
                (first, -g * g),
            ]);
        }
    }

    /// Start point and start tangent.
    pub(super) fn start(&mut self, tangent: Tangent) {
        let stretch = &self.stretches[0];
        self.fix(0, stretch.from);
        self.tangent((0, 1, 2), stretch.length(), tangent);
    }

    /// End point and end tangent.
    pub(super) fn end(&mut self, tangent: Tangent) {
        let stretch = &self.stretches[self.stretches.len() - 1];
        let last = self.stretches.len() * (self.degree + 1) - 1;
        self.fix(last, stretch.to);
        self.tangent((last, last - 1, last - 2), stretch.length(), tangent);
    }

    /// x' sin(theta) - y' cos(theta) = 0, and for a motion under way its speed and curvature.
    fn tangent(&mut self, (at, next, after): (usize, usize, usize), span: f64, tangent: Tangent) {
        let n = self.degree as f64;
        match tangent {
            Tangent::Free => {}
            Tangent::Heading(theta) => {
                let across = Vector2::new(theta.sin(), -theta.cos());
                self.row(&[(next, across), (at, -across)], 0.0);
            }
            Tangent::Moving(theta, curvature) => {
                let along = Vector2::new(theta.cos(), theta.sin());
                self.fix(next, self.stretches[0].from + along * (span / n));
                let across = Vector2::new(-along.y, along.x);
                let right = curvature * span * span / (n * (n - 1.0));
                self.row(&[(after, across), (next, across * -2.0), (at, across)], right);
            }
        }
    }

    /// x' cos(theta) + y' sin(theta) >= least at both ends; along the way where the heading is free.
    pub(super) fn forward(&mut self, start: Tangent, end: Tangent, least: f64) {
        let last = self.stretches.len() * (self.degree + 1) - 1;
        let ends = [
            (start, &self.stretches[0], 0, 1),
            (end, &self.stretches[self.stretches.len() - 1], last - 1, last),
        ];
        for (tangent, stretch, from, to) in ends {
            let along = match tangent {
                Tangent::Moving(..) => continue,
                Tangent::Heading(theta) => Vector2::new(theta.cos(), theta.sin()),
                Tangent::Free => (stretch.to - stretch.from) / stretch.length(),
            };
            self.row(&[(from, along), (to, -along)], -least * stretch.length() / self.degree as f64);
        }
    }

    /// Every control point in its stretch's corridor; the two ends are fixed, and inside by construction.
    pub(super) fn corridors(&mut self) {
        let last = self.stretches.len() * (self.degree + 1) - 1;
        let stretches = self.stretches;
        for (i, stretch) in stretches.iter().enumerate() {
            for k in 0..=self.degree {
                let point = i * (self.degree + 1) + k;
                if point == 0 || point == last {
                    continue;
                }
                for plane in &stretch.planes {
                    self.row(&[(point, plane.normal)], plane.offset);
                }
            }
        }
    }

    fn fix(&mut self, point: usize, at: Vector2) {
        self.row(&[(point, Vector2::x())], at.x);
        self.row(&[(point, Vector2::y())], at.y);
    }

    fn both_axes(&mut self, terms: &[(usize, f64)]) {
        for axis in [Vector2::x(), Vector2::y()] {
            let row: Vec<_> = terms.iter().map(|(point, factor)| (*point, axis * *factor)).collect();
            self.row(&row, 0.0);
        }
    }

    fn row(&mut self, terms: &[(usize, Vector2)], right: f64) {
        let row = self.right.len();
        for (point, factor) in terms {
            for axis in 0..2 {
                if factor[axis] != 0.0 {
                    self.rows.push(row);
                    self.cols.push(point * 2 + axis);
                    self.values.push(factor[axis]);
                }
            }
        }
        self.right.push(right);
    }
}
