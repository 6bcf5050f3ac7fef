//! The unknowns of the program, and the control points as linear functions of them.

use clarabel::algebra::CscMatrix;

/// Number of unknown vectors of a knot (a joint, or an end): position, first and second derivative by chord length. Source: ours.
pub(super) const KNOT_UNKNOWNS: usize = 3;

/// A control point as a sum of unknown vectors.
pub(super) type Terms = ([(usize, f64); KNOT_UNKNOWNS], usize);

/// Neighbouring pieces share the vectors of their common knot: they agree in position, heading and curvature by construction. A degree
/// above 5 adds free control points in the middle of each piece.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    pub(super) degree: usize,
    pub(super) pieces: usize,
}

impl Layout {
    /// The number of unknown vectors.
    pub(super) fn vectors(self) -> usize {
        self.pieces * self.stride() + KNOT_UNKNOWNS
    }

    /// The unknown that is the `order`-th derivative at a knot.
    pub(super) fn knot(self, knot: usize, order: usize) -> usize {
        knot * self.stride() + order
    }

    /// Control point `k` of a piece of `span` m: P1 = p + h p', P2 = p + 2h p' + span^2 / n(n - 1) p'', h = span / n.
    pub(super) fn control(self, piece: usize, k: usize, span: f64) -> Terms {
        let n = self.degree;
        let (knot, order, side) = if k < KNOT_UNKNOWNS {
            (piece, k, 1.0)
        } else if n - k < KNOT_UNKNOWNS {
            (piece + 1, n - k, -1.0)
        } else {
            return ([(self.knot(piece, k), 1.0), (0, 0.0), (0, 0.0)], 1);
        };
        let h = side * span / n as f64;
        let second = span * span / (n * (n - 1)) as f64;
        let at = |order| self.knot(knot, order);
        match order {
            0 => ([(at(0), 1.0), (0, 0.0), (0, 0.0)], 1),
            1 => ([(at(0), 1.0), (at(1), h), (0, 0.0)], 2),
            _ => ([(at(0), 1.0), (at(1), 2.0 * h), (at(2), second)], 3),
        }
    }

    /// The first unknown vector of a piece: its control points follow from this one and the `degree` next.
    pub(super) fn first(self, piece: usize) -> usize {
        piece * self.stride()
    }

    fn stride(self) -> usize {
        KNOT_UNKNOWNS + self.degree + 1 - 2 * KNOT_UNKNOWNS
    }
}

/// A sparse matrix under construction.
#[derive(Default)]
pub(super) struct Triplets {
    rows: Vec<usize>,
    cols: Vec<usize>,
    values: Vec<f64>,
}

impl Triplets {
    /// Adds to an entry.
    pub(super) fn add(&mut self, row: usize, col: usize, value: f64) {
        if value != 0.0 {
            self.rows.push(row);
            self.cols.push(col);
            self.values.push(value);
        }
    }

    pub(super) fn finish(self, rows: usize, cols: usize) -> CscMatrix<f64> {
        CscMatrix::new_from_triplets(rows, cols, self.rows, self.cols, self.values)
    }
}
