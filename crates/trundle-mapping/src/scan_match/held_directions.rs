//! Directions of a pose that a scan constrains, and degenerate directions.

use crate::scan_match::likelihood::ScanEquations;
use crate::scan_match::scan_points::ScanPoints;
use nalgebra::{Matrix3, Vector3};
use trundle_core::{Pose2, Vector2};

/// The directions determined by a scan and the degenerate ones, as along a bare corridor (\[Zhang16\]).
///
/// Displacements y are those of the hits' centroid. Turns are in cells at the hits' mean distance from the centroid, for comparable
/// directions. x = `pose_from_y` * y is the displacement of the base in the map (cells, cells, rad).
#[derive(Debug, Clone, Copy)]
pub(crate) struct HeldDirections {
    pub(crate) pose_from_y: Matrix3<f64>,
    /// Projection onto the directions with information.
    pub(crate) held: Matrix3<f64>,
    /// Number of degenerate directions.
    pub(crate) degenerate: usize,
}

impl HeldDirections {
    /// The directions at `pose`. A direction with less than the fraction `min` of the hits' information is degenerate.
    pub(crate) fn new(shape: &ScanPoints, pose: Pose2, equations: &ScanEquations, min: f64) -> Self {
        let (s, c) = pose.theta.sin_cos();
        let at = shape.spread.centroid;
        let centroid = Vector2::new(c * at.x - s * at.y, s * at.x + c * at.y);
        let pose_from_y = shape.spread.pose_from_centroid(centroid);
        let information = pose_from_y.transpose() * equations.normal.information * pose_from_y;
        let eigen = information.symmetric_eigen();
        let threshold = (min * equations.weight).max(1e-9);
        let (mut held, mut degenerate) = (Matrix3::zeros(), 0);
        for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *value >= threshold {
                held += vector * vector.transpose();
            } else {
                degenerate += 1;
            }
        }
        Self { pose_from_y, held, degenerate }
    }

    /// Information of the hits, in y, without the degenerate part.
    pub(crate) fn information(&self, equations: &ScanEquations) -> Matrix3<f64> {
        let in_y = self.pose_from_y.transpose() * equations.normal.information * self.pose_from_y;
        self.held * in_y * self.held
    }

    /// Gradient of the hits, in y, without the degenerate part.
    pub(crate) fn rhs(&self, equations: &ScanEquations) -> Vector3<f64> {
        self.held * (self.pose_from_y.transpose() * equations.normal.rhs)
    }

    /// Information about the pose, transformed to y.
    pub(crate) fn in_y(&self, information: &Matrix3<f64>) -> Matrix3<f64> {
        self.pose_from_y.transpose() * information * self.pose_from_y
    }
}
