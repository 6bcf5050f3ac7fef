//! The ranges of a CARMEN log: measurable ones, and the reading for a missing return.

use super::line::LaserLine;

/// Whether a laser can have measured this range, m.
pub(super) fn is_range(range: f64) -> bool {
    range > 0.0 && range.is_finite()
}

/// Readings so far below the greatest are the limit too, m. Source: ours.
const LIMIT_BAND_M: f64 = 0.25;

/// The smallest range at which a beam of a laser with this limit has no return, m, at least 0.
pub(super) fn no_return_from(limit: f64) -> f64 {
    (limit - LIMIT_BAND_M).max(0.0)
}

/// The largest reading, m, if many beams end near it: a laser without a return reports approximately its limit.
pub(super) fn limit(lasers: &[(usize, &LaserLine)]) -> Option<f64> {
    /// Smallest share of all beams. Source: ours.
    const SHARE: f64 = 0.001;
    let readings = || lasers.iter().flat_map(|(_, l)| &l.ranges).copied().filter(|r| r.is_finite());
    let greatest = readings().fold(0.0, f64::max);
    let (mut many, mut all) = (0_usize, 0_usize);
    for range in readings() {
        all += 1;
        many += usize::from(range > no_return_from(greatest));
    }
    (many as f64 > SHARE * all as f64 && many > 20).then_some(greatest)
}
