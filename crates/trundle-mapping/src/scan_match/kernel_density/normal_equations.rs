//! Normal equations of a pose from the kernel density.

use nalgebra::{Matrix3, Vector3};

/// Sums over all hits at a pose: information matrix, right-hand side, and the number of explained hits.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct NormalEquations {
    pub(crate) information: Matrix3<f64>,
    pub(crate) rhs: Vector3<f64>,
    pub(crate) explained: f64,
}
