//! Normal equations of a pose, shared by the two scan matchers.

use nalgebra::{Matrix3, Vector3};

/// Sums over all hits at a pose: J'WJ, J'Wr, and the number of explained hits.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct NormalEquations {
    /// Information matrix of the pose.
    pub(crate) information: Matrix3<f64>,
    /// Right-hand side.
    pub(crate) rhs: Vector3<f64>,
    /// Number of hits that the map explains, each hit weighted by its probability, 0 to 1.
    pub(crate) explained: f64,
}
