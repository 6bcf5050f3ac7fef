//! Conversion between probability and log-odds.

/// Probability p of the log-odds l = ln(p / (1 - p)).
pub fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}

/// Log-odds l = ln(p / (1 - p)) of the probability p.
pub fn log_odds(probability: f64) -> f64 {
    (probability / (1.0 - probability)).ln()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_two_conversions_are_inverse(value in -12.0..12.0_f64) {
            prop_assert!((log_odds(probability(value)) - value).abs() < 1e-9);
            prop_assert!((probability(value) + probability(-value) - 1.0).abs() < 1e-12);
        }
    }
}
