//! Information of a match by direction, with its degenerate directions.

use super::ScanMatchConfig;
use crate::scan_match::normal_equations::NormalEquations;
use crate::scan_match::point_spread::PointSpread;
use nalgebra::{Matrix3, SymmetricEigen, U3, Vector3};

/// The information of a match by direction, with its degenerate directions (Zhang, Kaess and Singh, On degeneracy of optimization-based
/// state estimation problems, ICRA 2016).
///
/// Displacements are those of the hits' centroid. Turns are in metres at the hits' mean distance from the centroid, for comparable
/// directions.
#[derive(Debug, Clone)]
pub(crate) struct Information {
    /// Matrix B in: displacement of the base = B * displacement of the centroid, turns in metres.
    base_from_centroid: Matrix3<f64>,
    /// Inverse of `base_from_centroid`.
    centroid_from_base: Matrix3<f64>,
    eigen: SymmetricEigen<f64, U3>,
    min: f64,
}

impl Information {
    pub(crate) fn new(config: &ScanMatchConfig, equations: &NormalEquations, spread: &PointSpread) -> Self {
        let (centroid, lever) = (spread.centroid, spread.lever);
        let centroid_from_base = Matrix3::new(1.0, 0.0, -centroid.y, 0.0, 1.0, centroid.x, 0.0, 0.0, lever);
        let base_from_centroid = spread.pose_from_centroid(centroid);
        let information = base_from_centroid.transpose() * equations.information * base_from_centroid;
        let min = config.degenerate_below * equations.explained / config.kernel_sigma.powi(2);
        Self {
            base_from_centroid,
            centroid_from_base,
            eigen: information.symmetric_eigen(),
            min: min.max(1e-9),
        }
    }

    /// Whether any direction is degenerate.
    pub(crate) fn is_degenerate(&self) -> bool {
        self.eigen.eigenvalues.min() < self.min
    }

    /// The least-squares step without its degenerate part.
    pub(crate) fn solve(&self, rhs: &Vector3<f64>) -> Vector3<f64> {
        self.by_direction(|value| if value < self.min { 0.0 } else { 1.0 / value }) * rhs
    }

    /// A displacement (right perturbation) without its degenerate part.
    pub(crate) fn held(&self, displacement: &Vector3<f64>) -> Vector3<f64> {
        let vectors = &self.eigen.eigenvectors;
        let mut along = vectors.transpose() * self.centroid_from_base * displacement;
        for (part, value) in along.iter_mut().zip(self.eigen.eigenvalues.iter()) {
            if *value < self.min {
                *part = 0.0;
            }
        }
        self.base_from_centroid * vectors * along
    }

    /// The covariance, right perturbation.
    pub(crate) fn covariance(&self, config: &ScanMatchConfig) -> Matrix3<f64> {
        let variance = |value: f64| {
            if value < self.min { config.unknown_sigma.powi(2) } else { config.inflation.powi(2) / value }
        };
        let covariance = self.by_direction(variance);
        (covariance + covariance.transpose()) * 0.5
    }

    /// The matrix with the information's eigenvectors and a function of its eigenvalues, in m and rad.
    fn by_direction(&self, function: impl Fn(f64) -> f64) -> Matrix3<f64> {
        let directions = self.base_from_centroid * self.eigen.eigenvectors;
        let values = Matrix3::from_diagonal(&self.eigen.eigenvalues.map(function));
        directions * values * directions.transpose()
    }
}
