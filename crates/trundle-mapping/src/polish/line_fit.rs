//! Line through the surface around a hit.

use crate::scan_match::scan_points::ScanHit;
use trundle_core::Vector2;

/// Distance to each side over which a line is fitted \[m\]. A shorter baseline gives the normal of the noise. Source: ours, ten sigmas of a
/// laser's range.
const LINE_BASELINE_M: f64 = 0.2;
/// Largest gap between two hits of one surface \[m\]. Source: ours, the spacing of beams of 1 deg along a corridor's wall at 10 m.
const MAX_GAP_M: f64 = 1.5;
/// Largest number of beams between two hits of one surface, counted from hit to hit. Source: ours, one beam may be missing.
const MAX_BEAM_STEP: usize = 2;
/// Largest RMS distance of the hits from their line \[sigmas\]. Beyond it the surface is not straight. Source: ours.
const MAX_LINE_RESIDUAL_SIGMAS: f64 = 2.0;

/// A straight surface: the points p with normal * p = offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line {
    /// Unit normal towards the sensor.
    pub(super) normal: Vector2,
    /// Distance of the line from the base along the normal, m.
    pub(super) offset: f64,
}

/// The line through the straight surface around hit `k` of a sensor at `origin` (base frame, m); `None` without one.
pub(super) fn line_at(hits: &[ScanHit], k: usize, origin: Vector2) -> Option<Line> {
    // At the end of a surface, its remaining side determines the line.
    let (first, last) = match (reach(hits, k, -1), reach(hits, k, 1)) {
        (None, None) => return None,
        (first, last) => (first.unwrap_or(k), last.unwrap_or(k)),
    };
    let points = hits[first..=last].iter().map(|hit| hit.end);
    let count = (last - first + 1) as f64;
    let mean = points.clone().sum::<Vector2>() / count;
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for off in points.map(|point| point - mean) {
        xx += off.x * off.x;
        xy += off.x * off.y;
        yy += off.y * off.y;
    }
    // Direction of the larger eigenvector of the 2 x 2 scatter.
    let (s, c) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
    let residual = ((s * s * xx - 2.0 * s * c * xy + c * c * yy) / count).max(0.0).sqrt();
    let across = Vector2::new(-s, c);
    let normal = if across.dot(&(origin - mean)) < 0.0 { -across } else { across };
    (residual <= MAX_LINE_RESIDUAL_SIGMAS * hits[k].sigma).then(|| Line { normal, offset: normal.dot(&mean) })
}

/// The first hit on one side of hit `k` at the distance of the baseline, on the same surface.
fn reach(hits: &[ScanHit], k: usize, step: isize) -> Option<usize> {
    let mut at = k;
    loop {
        let next = at.checked_add_signed(step).filter(|&next| next < hits.len())?;
        let is_joined = hits[next].beam.abs_diff(hits[at].beam) <= MAX_BEAM_STEP
            && (hits[next].end - hits[at].end).norm() <= MAX_GAP_M;
        if !is_joined {
            return None;
        }
        at = next;
        if (hits[at].end - hits[k].end).norm() >= LINE_BASELINE_M {
            return Some(at);
        }
    }
}
