//! Statistics of a list of errors: mean, root mean square, median and extremes.

use serde::{Deserialize, Serialize};

/// Statistics of a list of errors, in their unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ErrorStatistics {
    /// Number of errors.
    pub count: usize,
    /// Root of the mean square.
    pub rmse: f64,
    /// Arithmetic mean.
    pub mean: f64,
    /// Middle value; for an even number, the mean of the two middle ones.
    pub median: f64,
    /// Standard deviation of the population (division by `count`).
    pub std: f64,
    /// Smallest.
    pub min: f64,
    /// Largest.
    pub max: f64,
}

impl ErrorStatistics {
    /// The statistics of `errors`; `None` without errors or for one that is not finite.
    pub fn of(errors: &[f64]) -> Option<Self> {
        if errors.is_empty() || errors.iter().any(|e| !e.is_finite()) {
            return None;
        }
        let mut sorted = errors.to_vec();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let mean_of = |f: &dyn Fn(f64) -> f64| sorted.iter().map(|&e| f(e)).sum::<f64>() / count as f64;
        let mean = mean_of(&|e| e);
        Some(Self {
            count,
            rmse: mean_of(&|e| e * e).sqrt(),
            mean,
            median: (sorted[(count - 1) / 2] + sorted[count / 2]) / 2.0,
            std: mean_of(&|e| (e - mean) * (e - mean)).sqrt(),
            min: sorted[0],
            max: sorted[count - 1],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn of_four_known_numbers() {
        let s = ErrorStatistics::of(&[4.0, 1.0, 3.0, 2.0]).unwrap();
        assert_eq!((s.count, s.mean, s.median, s.min, s.max), (4, 2.5, 2.5, 1.0, 4.0));
        assert!((s.rmse - 7.5_f64.sqrt()).abs() < 1e-15 && (s.std - 1.25_f64.sqrt()).abs() < 1e-15);
        assert_eq!(ErrorStatistics::of(&[5.0, 1.0, 2.0]).unwrap().median, 2.0);
        assert_eq!(ErrorStatistics::of(&[]), None);
        assert_eq!(ErrorStatistics::of(&[1.0, f64::NAN]), None);
    }

    proptest! {
        #[test]
        fn rmse_is_mean_and_std_together(errors in prop::collection::vec(0.0..100.0f64, 1..50)) {
            let s = ErrorStatistics::of(&errors).unwrap();
            prop_assert!((s.rmse * s.rmse - s.mean * s.mean - s.std * s.std).abs() < 1e-9);
            prop_assert!(s.min <= s.median && s.median <= s.max && s.rmse <= s.max * (1.0 + 1e-12));
        }
    }
}
