//! A lookup table of a hull: fast lower bounds of the free motion for boxes of points.
//!
//! Problem: the closed forms cost half a microsecond per point. Idea: at rings around the axle the headings of contact are computed once,
//! exactly. A point farther out than a ring is touched at fewer headings, as the hull together with the axle is convex. In strips along x the
//! table holds the hull's extent, rounded up. A box of points that is not touched before a known contact can be skipped. All rounding is
//! outward, so no contact is missed.

use crate::oriented_box::OrientedBox;
use crate::rounded_hull::RoundedHull;
use crate::segment::Segment;
use crate::straight_contact::{StraightContact, front_extent, straight_contact};
use crate::turn_contact::blocked_headings;
use std::f64::consts::TAU;
use trundle_core::Vector2;

/// Number of points per ring of the table. Source: ours.
const POINTS_PER_RING: usize = 100;
/// Smallest number of rings. Source: ours.
const MIN_RINGS: usize = 32;
/// Largest number of rings. Source: ours.
const MAX_RINGS: usize = 512;
/// Counted cost of a ring, in steps of about 10 ns. Source: ours.
const RING_COST: u64 = 100;
/// Number of strips along x: a fraction of a millimetre each, as their rounding delays every point. Source: ours.
const STRIP_COUNT: usize = 512;
/// Half thicknesses below which a box counts as its centre line, m: a slanted box would otherwise touch with its corner first. Source:
/// ours.
const THIN_HALF_THICKNESS_M: [f64; 3] = [1e-8, 1e-5, 1e-3];
/// Smallest ratio of length to thickness of such a box. Source: ours.
const MIN_SLENDERNESS: f64 = 4.0;
/// Margin against rounding, m or rad. Source: rounding of f64.
const ROUNDING_SLACK: f64 = 1e-9;

/// The lookup table of a hull.
#[derive(Debug, Clone)]
pub struct HullProfile {
    inner: f64,
    outer: f64,
    rings: usize,
    /// Bearings, from and to (rad), at which a point on a ring is in the hull; and the first of each ring.
    runs: Vec<(f64, f64)>,
    starts: Vec<u32>,
    bottom: f64,
    strip: f64,
    /// Extent of the hull forward and backward in each strip, m; then in every two neighbours, every four, and so on.
    fronts: Vec<Vec<(f64, f64)>>,
    /// The hull grown by each of [`THIN_HALF_THICKNESS_M`], for boxes up to this thickness.
    grown: [RoundedHull; THIN_HALF_THICKNESS_M.len()],
}

impl HullProfile {
    /// The table of a hull, for queries about this number of points.
    pub fn new(hull: &RoundedHull, points: usize) -> Self {
        let rings = (points / POINTS_PER_RING).clamp(MIN_RINGS, MAX_RINGS);
        let whole = hull.with_axle();
        let (inner, outer) = (whole.inner, whole.outer);
        let (mut runs, mut starts) = (Vec::new(), vec![0]);
        let (mut angles, mut blocked) = (Vec::new(), Vec::new());
        for k in 0..rings {
            let ring = inner + (outer - inner) * k as f64 / rings as f64 - ROUNDING_SLACK;
            blocked.clear();
            let point = Segment::point(Vector2::new(ring.max(0.0), 0.0));
            blocked_headings(&whole, &point, &mut angles, &mut blocked);
            runs.extend(
                blocked
                    .iter()
                    .map(|arc| (-arc.start - arc.length - ROUNDING_SLACK, -arc.start + ROUNDING_SLACK)),
            );
            starts.push(runs.len() as u32);
        }
        let (low, high) = hull.core_extent(Vector2::y());
        let (bottom, top) = (low - hull.radius, high + hull.radius);
        let strip = (top - bottom) / STRIP_COUNT as f64;
        let fronts = (0..STRIP_COUNT).map(|i| {
            let (y0, y1) = (bottom + strip * i as f64, bottom + strip * (i + 1) as f64);
            (front_in(hull, y0, y1, 1.0), front_in(hull, y0, y1, -1.0))
        });
        Self {
            inner,
            outer,
            rings,
            runs,
            starts,
            bottom,
            strip,
            fronts: runs_of(fronts.collect()),
            grown: THIN_HALF_THICKNESS_M.map(|by| hull.grown(by)),
        }
    }

    /// The runs of the next ring inside a distance.
    fn runs(&self, distance: f64) -> &[(f64, f64)] {
        let part = (distance - self.inner) / (self.outer - self.inner).max(ROUNDING_SLACK);
        let ring = ((part * self.rings as f64) as usize).min(self.rings - 1);
        &self.runs[self.starts[ring] as usize..self.starts[ring + 1] as usize]
    }

    /// Counted cost of the table, in steps of about 10 ns.
    pub fn cost(&self) -> u64 {
        RING_COST * self.rings as u64
    }

    /// Lower bounds of the free turn, counter-clockwise and clockwise, before the hull meets a point of a box (relative to the axle, in the
    /// hull's axes), rad; `None` without a contact.
    pub fn free_turns(&self, bounds: &OrientedBox) -> Option<(f64, f64)> {
        let nearest = bounds.distance_from_origin() - ROUNDING_SLACK;
        if nearest >= self.outer {
            return None;
        }
        if nearest <= self.inner || nearest <= 0.0 {
            return Some((0.0, 0.0));
        }
        let (bearing, half) = (bounds.center.y.atan2(bounds.center.x), bounds.half_angle() + ROUNDING_SLACK);
        let (mut left, mut right) = (f64::INFINITY, f64::INFINITY);
        for (from, to) in self.runs(nearest) {
            // A turn to the left takes a point to lower bearings, to the upper end of a run.
            let (from, length) = (from - half, to - from + 2.0 * half);
            let past = wrap_positive(bearing - from);
            let turn = past - length;
            if turn <= 0.0 {
                return Some((0.0, 0.0));
            }
            (left, right) = (left.min(turn), right.min(TAU - past));
        }
        left.is_finite().then_some((left, right))
    }

    /// Whether `is_known(from, length)` covers all headings at which the hull may meet a point of a box (relative to the axle, in the
    /// map's axes).
    pub fn all_known(&self, bounds: &OrientedBox, is_known: impl Fn(f64, f64) -> bool) -> bool {
        let nearest = bounds.distance_from_origin() - ROUNDING_SLACK;
        if nearest >= self.outer {
            return true;
        }
        if nearest <= self.inner || nearest <= 0.0 {
            return is_known(0.0, TAU);
        }
        let (bearing, half) = (bounds.center.y.atan2(bounds.center.x), bounds.half_angle() + ROUNDING_SLACK);
        self.runs(nearest).iter().all(|(from, to)| {
            let length = to - from + 2.0 * half;
            if length >= TAU { is_known(0.0, TAU) } else { is_known(bearing - to - half, length) }
        })
    }

    /// Extent of the hull forward and backward in a run of strips, both ends included, m.
    fn reach(&self, first: usize, last: usize) -> (f64, f64) {
        let size = (last - first + 1).ilog2();
        let runs = &self.fronts[size as usize];
        farther(runs[first], runs[last + 1 - (1 << size)])
    }

    /// Lower bounds of the free distance forward and backward before the hull meets a point of a box (in the hull's frame), m; infinite
    /// without a contact.
    pub fn free_distances(&self, bounds: &OrientedBox) -> (f64, f64) {
        let never = (f64::INFINITY, f64::INFINITY);
        let (p, extent) = (bounds.center, bounds.extent().add_scalar(ROUNDING_SLACK));
        let at = |y: f64| (y - self.bottom) / self.strip;
        let (low, high) = (at(p.y - extent.y) - ROUNDING_SLACK, at(p.y + extent.y) + ROUNDING_SLACK);
        if high < 0.0 || low > STRIP_COUNT as f64 {
            return never;
        }
        if let Some(distances) = self.free_distances_of_line(bounds) {
            return distances;
        }
        let (first, last) = (low.max(0.0) as usize, (high as usize).min(STRIP_COUNT - 1));
        let reach = self.reach(first.min(STRIP_COUNT - 1), last);
        // A box entirely behind the hull is not ahead of it.
        let is_behind = p.x + extent.x < -reach.1;
        let ahead = if is_behind { f64::INFINITY } else { (p.x - extent.x - reach.0).max(0.0) };
        let is_ahead = p.x - extent.x > reach.0;
        let behind = if is_ahead { f64::INFINITY } else { (-p.x - extent.x - reach.1).max(0.0) };
        (ahead, behind)
    }

    /// Free distances ahead and behind of a box that is thin enough to count as a segment.
    fn free_distances_of_line(&self, bounds: &OrientedBox) -> Option<(f64, f64)> {
        let is_slender = |by: f64| bounds.half.y <= by && bounds.half.x > MIN_SLENDERNESS * by;
        let grown = &self.grown[THIN_HALF_THICKNESS_M.iter().position(|&by| is_slender(by))?];
        let line = bounds.centre_line();
        if grown.overlaps(&line) {
            return None;
        }
        Some(match straight_contact(grown, &line) {
            Some(StraightContact::Ahead(distance)) => (distance - ROUNDING_SLACK, f64::INFINITY),
            Some(StraightContact::Behind(distance)) => (f64::INFINITY, distance - ROUNDING_SLACK),
            None => (f64::INFINITY, f64::INFINITY),
        })
    }
}

/// Maxima over one, two, four, ... neighbours.
fn runs_of(fronts: Vec<(f64, f64)>) -> Vec<Vec<(f64, f64)>> {
    let mut all = vec![fronts];
    while let Some(last) = all.last().filter(|last| last.len() > 1 << (all.len() - 1)) {
        let half = 1 << (all.len() - 1);
        let next = last.iter().zip(&last[half..]).map(|(a, b)| farther(*a, *b)).collect();
        all.push(next);
    }
    all
}

fn farther(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.max(b.0), a.1.max(b.1))
}

/// An angle in [0, 2 pi).
pub fn wrap_positive(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).floor()
}

/// Upper bound of the hull's extent along x (for `sign` -1 against x) between two values of y, m. The front is concave: its maximum is at
/// the foremost corner, or at the end nearer to it.
fn front_in(hull: &RoundedHull, low: f64, high: f64, sign: f64) -> f64 {
    let (_, max) = hull.core_extent(Vector2::x() * sign);
    let foremost = hull.core.iter().find(|corner| sign * corner.at.x >= max);
    let apex = foremost.map_or(low, |corner| corner.at.y);
    let reach = front_extent(hull, apex.clamp(low, high), sign);
    let is_known = reach.is_finite() && !(low..=high).contains(&apex);
    if is_known { reach + ROUNDING_SLACK } else { max + hull.radius + ROUNDING_SLACK }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::turn_contact::HeadingArc;
    use proptest::prelude::*;
    use trundle_core::Footprint;

    fn hull(shift: (f64, f64), margin: f64) -> RoundedHull {
        let corners = [(0.3, 0.2), (-0.3, 0.25), (-0.35, -0.2), (0.3, -0.2), (0.4, 0.0)];
        let at = |(x, y): (f64, f64)| Vector2::new(x + shift.0, y + shift.1);
        RoundedHull::new(&Footprint::polygon(corners.map(at).to_vec()).unwrap(), margin)
    }

    proptest! {
        /// The bounds for a box hold for every point in it.
        #[test]
        fn bounds_never_exceed_the_closed_forms(
            shift in (-0.6..0.6_f64, -0.5..0.5_f64), margin in 0.0..0.05_f64,
            center in (-0.8..0.8_f64, -0.8..0.8_f64), half in (0.0..0.3_f64, 0.0..0.2_f64), thin in -7.0..0.0_f64,
            part in (-1.0..1.0_f64, -1.0..1.0_f64), bearing in 0.0..TAU,
        ) {
            let hull = hull(shift, margin);
            let profile = HullProfile::new(&hull, 5000);
            let center = Vector2::new(center.0, center.1);
            let axis = Vector2::new(bearing.cos(), bearing.sin());
            let bounds = OrientedBox { center, axis, half: Vector2::new(half.0, half.1 * 10_f64.powf(thin)) };
            let p = center + axis * (half.0 * part.0) + Vector2::new(-axis.y, axis.x) * (bounds.half.y * part.1);
            let (mut angles, mut blocked) = (Vec::new(), Vec::<HeadingArc>::new());
            blocked_headings(&hull, &Segment::point(p), &mut angles, &mut blocked);
            let turns = profile.free_turns(&bounds);
            for arc in &blocked {
                let (left, right) = arc.free_turn_from(0.0);
                let min = turns.expect("the box is met");
                prop_assert!(min.0 <= left + 1e-9 && min.1 <= right + 1e-9, "{min:?} {left} {right}");
            }
            let inside = |heading: f64| blocked.iter().any(|arc| (heading - arc.start).rem_euclid(TAU) <= arc.length);
            for i in 0..90 {
                let heading = TAU * f64::from(i) / 90.0;
                let holds = |from: f64, length: f64| (heading - from).rem_euclid(TAU) <= length;
                // A box is still relevant if all headings but a blocked one are known.
                prop_assert!(!inside(heading) || !profile.all_known(&bounds, |from, length| !holds(from, length)));
            }
            if !hull.overlaps(&Segment::point(p)) {
                let (ahead, behind) = profile.free_distances(&bounds);
                match straight_contact(&hull, &Segment::point(p)) {
                    Some(StraightContact::Ahead(travelled)) => prop_assert!(ahead <= travelled + 1e-9, "{ahead} {travelled}"),
                    Some(StraightContact::Behind(travelled)) => prop_assert!(behind <= travelled + 1e-9, "{behind} {travelled}"),
                    None => {}
                }
            }
        }
    }
}
