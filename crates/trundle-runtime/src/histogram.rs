//! A histogram with bounded relative error.

/// Quantiles of a stream of positive numbers in constant memory: bins of equal width in the logarithm.
///
/// A quantile has an error of at most 1 %; count, sum and maximum are exact. Numbers are clamped to 10^-6 to 10^6.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Histogram {
    /// Empty until the first value.
    bins: Vec<u32>,
    count: u64,
    sum: f64,
    max: f64,
}

/// Lower end of the first bin. Source: ours.
const FIRST_BIN_START: f64 = 1e-6;
/// Ratio of a bin's upper to its lower end: a quantile is the middle of its bin, an error below 1 %. Source: ours.
const BIN_RATIO: f64 = 1.02;
/// Number of bins: they end at 10^6. Source: ours.
const BIN_COUNT: usize = 1396;

impl Histogram {
    /// Counts a number. A number that is not finite is ignored.
    pub fn note(&mut self, value: f64) {
        if !value.is_finite() {
            return;
        }
        self.bins.resize(BIN_COUNT, 0);
        let bin = ((value.max(FIRST_BIN_START) / FIRST_BIN_START).ln() / BIN_RATIO.ln()) as usize;
        self.bins[bin.min(BIN_COUNT - 1)] += 1;
        self.count += 1;
        self.sum += value;
        self.max = self.max.max(value);
    }

    /// Adds the counts of `other`.
    pub fn add(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        self.bins.resize(BIN_COUNT, 0);
        self.bins.iter_mut().zip(&other.bins).for_each(|(mine, theirs)| *mine += theirs);
        self.count += other.count;
        self.sum += other.sum;
        self.max = self.max.max(other.max);
    }

    /// Number of counted values.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Sum of the counted values.
    pub fn sum(&self) -> f64 {
        self.sum
    }

    /// Maximum of the counted values; `None` if no value was counted.
    pub fn max(&self) -> Option<f64> {
        (self.count > 0).then_some(self.max)
    }

    /// The quantile: the part `fraction` (0 to 1) of all values does not exceed it; `None` if no value was counted.
    pub fn quantile(&self, fraction: f64) -> Option<f64> {
        let rank = (self.count.checked_sub(1)? as f64 * fraction.clamp(0.0, 1.0)).round() as u64;
        let mut below = 0;
        let bin = self.bins.iter().position(|&n| {
            below += u64::from(n);
            below > rank
        })?;
        Some((FIRST_BIN_START * BIN_RATIO.powf(bin as f64 + 0.5)).min(self.max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_within_a_hundredth_and_sums_exact() {
        let (mut odd, mut even) = (Histogram::default(), Histogram::default());
        for i in 1..=10_000 {
            if i % 2 == 1 { odd.note(f64::from(i)) } else { even.note(f64::from(i)) }
        }
        odd.add(&even);
        for fraction in [0.1, 0.5, 0.9, 0.99, 0.999] {
            let ratio = odd.quantile(fraction).unwrap() / (fraction * 10_000.0);
            assert!((ratio - 1.0).abs() < 0.0101, "{fraction}: {ratio}");
        }
        assert_eq!((odd.count(), odd.sum(), odd.max()), (10_000, 50_005_000.0, Some(10_000.0)));
    }

    #[test]
    fn nothing_has_no_quantile_and_extremes_have_a_place() {
        let mut all = Histogram::default();
        assert_eq!((all.quantile(0.5), all.max()), (None, None));
        for value in [0.0, 1e9, f64::NAN] {
            all.note(value);
        }
        assert_eq!((all.count(), all.max()), (2, Some(1e9)));
        assert!(all.quantile(0.0).unwrap() < 1.1e-6 && all.quantile(1.0).unwrap() > 0.9e6);
    }
}
