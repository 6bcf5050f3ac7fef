//! The ranges of a CARMEN log: measurable ones, and the reading for a missing return.

use std::collections::BTreeMap;

/// Whether a laser can have measured this range, m.
pub(super) fn is_range(range: f64) -> bool {
    range > 0.0 && range.is_finite()
}

/// Readings so far below the greatest are the limit too, m. Source: ours.
const LIMIT_BAND_M: f64 = 0.25;
/// Smallest share of all beams that end near the limit \[1\]. Source: ours.
const MIN_LIMIT_SHARE: f64 = 0.001;
/// Largest number of beams that end near the greatest reading by chance. Source: ours.
const MAX_CHANCE_COUNT: usize = 20;
/// Number of bins per metre by which readings near the limit are counted \[1/m\]. Source: ours; a bin is smaller than the centimetre of
/// CARMEN's lasers.
const BINS_PER_METRE: f64 = 1024.0;

/// The smallest range at which a beam of a laser with this limit has no return, m, at least 0.
pub(super) fn no_return_from(limit: f64) -> f64 {
    (limit - LIMIT_BAND_M).max(0.0)
}

/// The readings of a laser near the greatest one, counted as they come.
#[derive(Debug, Default)]
pub(super) struct RangeLimit {
    greatest: f64,
    count: usize,
    /// Number of readings by their bin, of those within [`LIMIT_BAND_M`] of the greatest.
    near: BTreeMap<i64, usize>,
}

impl RangeLimit {
    /// Counts a reading, m.
    pub(super) fn count(&mut self, range: f64) {
        if !range.is_finite() {
            return;
        }
        self.count += 1;
        if range > self.greatest {
            self.greatest = range;
            self.near = self.near.split_off(&bin(no_return_from(range)));
        }
        if range > no_return_from(self.greatest) {
            *self.near.entry(bin(range)).or_default() += 1;
        }
    }

    /// The largest reading, m, if many beams end near it: a laser without a return reports approximately its limit.
    pub(super) fn limit(&self) -> Option<f64> {
        let near: usize = self.near.values().sum();
        let is_limit = near as f64 > MIN_LIMIT_SHARE * self.count as f64 && near > MAX_CHANCE_COUNT;
        is_limit.then_some(self.greatest)
    }
}

fn bin(range: f64) -> i64 {
    (range * BINS_PER_METRE).floor() as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_below_the_band_of_a_later_greater_one_do_not_count() {
        let mut readings = RangeLimit::default();
        (0..30).for_each(|_| readings.count(5.0));
        assert_eq!(readings.limit(), Some(5.0));
        readings.count(8.0);
        assert_eq!(readings.limit(), None, "one beam at 8 m");
        (0..20).for_each(|k| readings.count(7.8 + 0.01 * f64::from(k)));
        readings.count(f64::INFINITY);
        assert_eq!(readings.limit(), Some(8.0));
    }
}
