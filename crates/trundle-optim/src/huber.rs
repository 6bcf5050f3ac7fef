//! The loss of Huber.

/// The loss of Huber (1964) on a squared residual: quadratic within `threshold` standard deviations, linear beyond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Huber {
    threshold: f64,
}

impl Huber {
    /// Linear for a squared residual above `chi2`, which is positive.
    pub fn beyond(chi2: f64) -> Self {
        Self { threshold: chi2.sqrt() }
    }

    /// The loss of a squared residual `chi2`.
    pub fn cost(self, chi2: f64) -> f64 {
        let residual = chi2.sqrt();
        if residual <= self.threshold { chi2 } else { self.threshold * (2.0 * residual - self.threshold) }
    }

    /// The derivative of the loss by `chi2`: the weight of the residual in a reweighted least-squares step, in (0, 1].
    pub fn weight(self, chi2: f64) -> f64 {
        let residual = chi2.sqrt();
        if residual <= self.threshold { 1.0 } else { self.threshold / residual }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weight_is_the_derivative_of_the_cost_and_the_cost_is_smooth() {
        let huber = Huber::beyond(5.0);
        for chi2 in [0.1, 1.0, 4.9, 5.1, 20.0, 900.0] {
            let slope = (huber.cost(chi2 + 1e-6) - huber.cost(chi2 - 1e-6)) / 2e-6;
            assert!((slope - huber.weight(chi2)).abs() < 1e-6, "at {chi2}");
        }
        assert!((huber.cost(5.0 + 1e-9) - 5.0).abs() < 1e-8);
    }
}
