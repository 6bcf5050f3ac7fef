//! Robust linear least squares with a covariance from the residuals.

use nalgebra::{SMatrix, SVector};

/// Residual, in standard deviations, above which an equation loses weight: 1.345, which keeps 95 % efficiency on Gaussian
/// noise. Source: \[Huber64\].
const HUBER_SIGMAS: f64 = 1.345;
/// Number of reweighting rounds. Source: ours; the weights change by less than 1 % after five.
const REWEIGHTING_ROUNDS: usize = 8;

/// Linear equations `row * x = right` with one noise level, and priors with known noise.
#[derive(Debug, Clone)]
pub(super) struct LinearFit<const N: usize> {
    rows: Vec<SVector<f64, N>>,
    rights: Vec<f64>,
    /// Information of the priors and its product with their values.
    prior: (SMatrix<f64, N, N>, SVector<f64, N>),
    /// Smallest noise of an equation, in the unit of `right`.
    min_sigma: f64,
}

/// Solution of a [`LinearFit`].
#[derive(Debug, Clone)]
pub(super) struct LinearSolution<const N: usize> {
    pub(super) x: SVector<f64, N>,
    pub(super) covariance: SMatrix<f64, N, N>,
    /// Noise of an equation by the residuals.
    pub(super) sigma: f64,
}

impl<const N: usize> LinearFit<N> {
    /// A system without equations. The noise counts as at least `min_sigma`.
    pub(super) fn new(min_sigma: f64) -> Self {
        let prior = (SMatrix::zeros(), SVector::zeros());
        Self { rows: Vec::new(), rights: Vec::new(), prior, min_sigma }
    }

    /// Adds the equation `row * x = right`.
    pub(super) fn add(&mut self, row: SVector<f64, N>, right: f64) {
        self.rows.push(row);
        self.rights.push(right);
    }

    /// Adds the prior `row * x = value`, with its standard deviation.
    pub(super) fn add_prior(&mut self, row: SVector<f64, N>, value: f64, sigma: f64) {
        self.prior.0 += row * row.transpose() * sigma.powi(-2);
        self.prior.1 += row * (value * sigma.powi(-2));
    }

    /// The solution by iteratively reweighted least squares; `None` if the equations do not determine it.
    pub(super) fn solve(&self) -> Option<LinearSolution<N>> {
        let mut weights = vec![1.0; self.rows.len()];
        let mut sigma = self.min_sigma;
        let mut solution = None;
        for _ in 0..REWEIGHTING_ROUNDS {
            let (x, covariance) = self.solve_weighted(&weights, sigma)?;
            let residuals: Vec<f64> =
                self.rows.iter().zip(&self.rights).map(|(row, right)| row.dot(&x) - right).collect();
            let squares: f64 = residuals.iter().zip(&weights).map(|(r, w)| w * r * r).sum();
            let freedom = (weights.iter().sum::<f64>() - N as f64).max(1.0);
            sigma = (squares / freedom).sqrt().max(self.min_sigma);
            for (weight, residual) in weights.iter_mut().zip(&residuals) {
                *weight = (HUBER_SIGMAS * sigma / residual.abs()).min(1.0);
            }
            solution = Some(LinearSolution { x, covariance, sigma });
        }
        solution
    }

    fn solve_weighted(&self, weights: &[f64], sigma: f64) -> Option<(SVector<f64, N>, SMatrix<f64, N, N>)> {
        let (mut information, mut vector) = self.prior;
        for ((row, right), weight) in self.rows.iter().zip(&self.rights).zip(weights) {
            let weight = weight / (sigma * sigma);
            information += row * row.transpose() * weight;
            vector += row * (right * weight);
        }
        let covariance = information.try_inverse()?;
        Some((covariance * vector, covariance))
    }
}
