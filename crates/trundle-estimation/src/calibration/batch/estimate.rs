//! A value with its standard deviation.

/// A value with its standard deviation, both in the same unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Standard deviation, 0 or more.
    pub sigma: f64,
}

impl Estimate {
    /// A value with its standard deviation.
    #[must_use]
    pub fn new(value: f64, sigma: f64) -> Self {
        Self { value, sigma }
    }

    /// Mean of measurements of equal quality. Its standard deviation is their scatter over the square root of their number. `None` without
    /// measurements.
    #[must_use]
    pub fn mean_of(measurements: &[f64]) -> Option<Self> {
        let count = measurements.len() as f64;
        if measurements.is_empty() {
            return None;
        }
        let mean = measurements.iter().sum::<f64>() / count;
        let squares: f64 = measurements.iter().map(|x| (x - mean).powi(2)).sum();
        let scatter = (squares / (count - 1.0).max(1.0)).sqrt();
        Some(Self { value: mean, sigma: scatter / count.sqrt() })
    }
}
