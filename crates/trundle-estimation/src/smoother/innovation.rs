//! Innovations: agreement of a measurement with the prediction.

use super::error_process::{log_density, wrong_place};
use nalgebra::{Matrix3, Vector3};

/// Agreement of a measurement with the prediction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Innovation {
    /// Normalised squared innovation; expected value: [`Innovation::DEGREES_OF_FREEDOM`].
    pub squared: f64,
    /// Log-likelihood of the measurement, minus that of a measurement at a random place. A negative value contradicts the estimate.
    pub log_likelihood_ratio: f64,
}

impl Innovation {
    /// Degrees of freedom of a planar pose. Source: x, y and heading.
    pub const DEGREES_OF_FREEDOM: usize = 3;

    pub(crate) fn new(residual: &Vector3<f64>, spread: &Matrix3<f64>) -> Self {
        let squared = spread.cholesky().map_or(f64::INFINITY, |lower| residual.dot(&lower.solve(residual)));
        let log_likelihood_ratio =
            log_density(residual, spread) - log_density(residual, &(spread + wrong_place()));
        Self { squared, log_likelihood_ratio }
    }
}
