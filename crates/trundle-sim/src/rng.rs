//! Chance without state: hashes of counters, and normal deviates from their bits.
//!
//! Per-pixel noise must not depend on the order of threads: it is a hash of (seed, frame, pixel), not the next number of a generator.

use std::sync::LazyLock;

/// Bits of a hash that one deviate of [`NormalTable`] takes. Source: ours.
pub(crate) const NORMAL_BITS: u32 = 12;

/// 2^64 over the golden ratio: steps that fill the circle evenly. Source: SplitMix64, Steele, Lea, Flood 2014.
pub(crate) const GOLDEN_RATIO_STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// A bijective scrambling of 64 bits: the finaliser of SplitMix64 (Steele, Lea, Flood 2014).
pub(crate) fn mix(x: u64) -> u64 {
    let x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

/// The hash of a seed and a counter.
pub(crate) fn hash(seed: u64, counter: u64) -> u64 {
    mix(seed ^ mix(counter.wrapping_add(1).wrapping_mul(GOLDEN_RATIO_STEP)))
}

/// A number in (0, 1) from the upper bits of a hash, or of a word of a generator.
pub(crate) fn unit(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) / (1u64 << 52) as f64
}

/// A standard normal deviate from the upper bits of a hash, or of a word of a generator.
pub(crate) fn normal(bits: u64) -> f64 {
    normal_quantile(unit(bits))
}

/// Standard normal deviates by table: 2^12 equally likely values, zero mean, unit variance, up to 3.7 sigma.
pub(crate) struct NormalTable(Box<[f32; 1 << NORMAL_BITS]>);

impl NormalTable {
    /// The one table.
    pub(crate) fn shared() -> &'static Self {
        static TABLE: LazyLock<NormalTable> = LazyLock::new(NormalTable::new);
        &TABLE
    }

    fn new() -> Self {
        let size = 1 << NORMAL_BITS;
        let raw: Vec<f64> = (0..size).map(|i| normal_quantile((i as f64 + 0.5) / size as f64)).collect();
        let deviation = (raw.iter().map(|x| x * x).sum::<f64>() / size as f64).sqrt();
        let mut table = Box::new([0.0; 1 << NORMAL_BITS]);
        for (entry, x) in table.iter_mut().zip(raw) {
            *entry = (x / deviation) as f32;
        }
        Self(table)
    }

    /// The deviate of the `nth` group of [`NORMAL_BITS`] bits of a hash; n is 0 to 4.
    pub(crate) fn pick(&self, bits: u64, nth: u32) -> f32 {
        self.0[(bits >> (nth * NORMAL_BITS)) as usize & ((1 << NORMAL_BITS) - 1)]
    }
}

/// The quantile of the standard normal distribution, relative error below 1.2e-9 (P. J. Acklam's rational form).
#[expect(clippy::excessive_precision, reason = "the coefficients as published")]
fn normal_quantile(p: f64) -> f64 {
    const A: [f64; 6] = [
        -3.969683028665376e1,
        2.209460984245205e2,
        -2.759285104469687e2,
        1.383577518672690e2,
        -3.066479806614716e1,
        2.506628277459239,
    ];
    const B: [f64; 6] = [
        -5.447609879822406e1,
        1.615858368580409e2,
        -1.556989798598866e2,
        6.680131188771972e1,
        -1.328068155288572e1,
        1.0,
    ];
    const C: [f64; 6] = [
        -7.784894002430293e-3,
        -3.223964580411365e-1,
        -2.400758277161838,
        -2.549732539343734,
        4.374664141464968,
        2.938163982698783,
    ];
    const D: [f64; 5] =
        [7.784695709041462e-3, 3.224671290700398e-1, 2.445134137142996, 3.754408661907416, 1.0];
    let polynomial = |coefficients: &[f64], x: f64| coefficients.iter().fold(0.0, |sum, c| sum * x + c);
    let tail = |p: f64| {
        let q = (-2.0 * p.ln()).sqrt();
        polynomial(&C, q) / polynomial(&D, q)
    };
    if p < 0.02425 {
        tail(p)
    } else if p > 1.0 - 0.02425 {
        -tail(1.0 - p)
    } else {
        let q = p - 0.5;
        q * polynomial(&A, q * q) / polynomial(&B, q * q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        for (p, x) in [(0.5, 0.0), (0.841_344_746, 1.0), (0.977_249_868, 2.0), (0.001_349_898, -3.0)] {
            assert!((normal_quantile(p) - x).abs() < 1e-6, "{p}");
        }
    }

    #[test]
    fn hashed_deviates_are_normal() {
        let table = NormalTable::shared();
        let n = 200_000;
        let moment = |power: i32| {
            (0..n).map(|i| f64::from(table.pick(hash(7, i), 2)).powi(power)).sum::<f64>() / n as f64
        };
        assert!(moment(1).abs() < 0.01 && (moment(2) - 1.0).abs() < 0.02, "{} {}", moment(1), moment(2));
        assert!(moment(3).abs() < 0.05 && (moment(4) - 3.0).abs() < 0.15, "{} {}", moment(3), moment(4));
    }
}
