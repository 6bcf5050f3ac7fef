//! The ranges of a CARMEN log: those that a laser can measure, and the reading that means no return.

use super::line::LaserLine;

/// Whether a laser can have measured this range, m.
pub(super) fn is_range(range: f64) -> bool {
    range > 0.0 && range.is_finite()
}

/// The reading at which many beams end, if there is one: a laser without a return says its limit, give or take.
pub(super) fn limit(lasers: &[(usize, &LaserLine)]) -> Option<f64> {
    /// Readings so far below the greatest are the limit too, m.
    const BAND: f64 = 0.25;
    /// Least part of all beams.
    const SHARE: f64 = 0.001;
    let readings = || lasers.iter().flat_map(|(_, l)| &l.ranges).copied().filter(|r| r.is_finite());
    let greatest = readings().fold(0.0, f64::max);
    let (mut many, mut all) = (0_usize, 0_usize);
    for range in readings() {
        all += 1;
        many += usize::from(range > greatest - BAND);
    }
    (many as f64 > SHARE * all as f64 && many > 20).then_some(greatest - BAND)
}
