//! Random numbers from a seed.

use std::f64::consts::TAU;

/// 2^64 over the golden ratio: steps of this size are evenly distributed. Source: SplitMix64, Steele, Lea, Flood 2014.
const GOLDEN_RATIO_STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// A generator: SplitMix64 (Steele, Lea, Flood 2014).
#[derive(Debug, Clone)]
pub(super) struct Random(u64);

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN_RATIO_STEP);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    }

    /// Uniform in (0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        ((self.bits() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Uniform between two numbers.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Three independent normal numbers (Box and Muller).
    pub(super) fn normal3(&mut self) -> [f64; 3] {
        let mut pair = || {
            let radius = (-2.0 * self.unit().ln()).sqrt();
            let (s, c) = (TAU * self.unit()).sin_cos();
            [radius * c, radius * s]
        };
        let ([a, b], [c, _]) = (pair(), pair());
        [a, b, c]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_mean_zero_and_variance_one() {
        let mut random = Random::new(7);
        let draws: Vec<f64> = (0..4000).flat_map(|_| random.normal3()).collect();
        let n = draws.len() as f64;
        let mean = draws.iter().sum::<f64>() / n;
        let variance = draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n;
        assert!(mean.abs() < 0.03 && (variance - 1.0).abs() < 0.05, "{mean} {variance}");
        assert!((0..1000).map(|_| random.between(2.0, 3.0)).all(|x| x > 2.0 && x < 3.0));
    }
}
