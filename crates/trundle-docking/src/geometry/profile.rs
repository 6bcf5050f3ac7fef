//! A hull seen roughly, from outside of it: what a box of points cannot touch, by looking up.
//!
//! Problem: the closed forms cost half a microsecond a point. Idea: at rings about the axle the headings of contact are found
//! once, exactly; what lies farther out than a ring is met at fewer headings, as the hull together with the axle is convex. In
//! strips along x it is how far the hull reaches, rounded up. A box of points that is not met before what is known already
//! need not be asked about. Rounding is always outward, so that nothing is left out.

use super::driving::InTheWay;
use super::hull::Hull;
use super::segment::Segment;
use crate::scene::Patch;
use std::f64::consts::TAU;
use trundle_core::Vector2;

/// Rings between where the hull ends first and where it ends last: one for so many points, ...
const POINTS_A_RING: usize = 100;
/// ... at least and at most so many.
const RINGS: (usize, usize) = (32, 512);
/// What a ring costs, in units of [`crate::space::Space::work`].
const RING_COST: u64 = 100;
/// Strips along x: a fraction of a millimetre, as what they round away is asked of every point.
const STRIPS: usize = 512;
/// Half thicknesses below which a box is looked at as its middle line, m: one that is met askew is far nearer by its corner.
const THIN: [f64; 3] = [1e-8, 1e-5, 1e-3];
/// So much longer than thick it must be.
const SLENDER: f64 = 4.0;
/// More than rounding can take away, m or rad.
const SLACK: f64 = 1e-9;

/// The rough hull.
#[derive(Debug, Clone)]
pub struct Profile {
    inner: f64,
    outer: f64,
    rings: usize,
    /// Bearings, from and to (rad), at which a point on a ring is in the hull; where those of each ring begin.
    runs: Vec<(f64, f64)>,
    starts: Vec<u32>,
    bottom: f64,
    strip: f64,
    /// How far the hull reaches forward and backward in each strip, m; then in every two neighbours, every four, and so on.
    fronts: Vec<Vec<(f64, f64)>>,
    /// The hull grown by each of [`THIN`], for boxes that are no thicker than that.
    grown: [Hull; THIN.len()],
}

impl Profile {
    /// Looks at a hull, for questions about so many points.
    pub fn new(hull: &Hull, points: usize) -> Self {
        let rings = (points / POINTS_A_RING).clamp(RINGS.0, RINGS.1);
        let whole = hull.with_axle();
        let (inner, outer) = (whole.inner, whole.outer);
        let (mut runs, mut starts) = (Vec::new(), vec![0]);
        let (mut angles, mut blocked) = (Vec::new(), Vec::new());
        for k in 0..rings {
            let ring = inner + (outer - inner) * k as f64 / rings as f64 - SLACK;
            blocked.clear();
            let point = Segment::point(Vector2::new(ring.max(0.0), 0.0));
            whole.blocked_headings(&point, &mut angles, &mut blocked);
            runs.extend(blocked.iter().map(|arc| (-arc.start - arc.length - SLACK, -arc.start + SLACK)));
            starts.push(runs.len() as u32);
        }
        let (low, high) = hull.core_extent(Vector2::y());
        let (bottom, top) = (low - hull.radius, high + hull.radius);
        let strip = (top - bottom) / STRIPS as f64;
        let fronts = (0..STRIPS).map(|i| {
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
            grown: THIN.map(|by| hull.grown(by)),
        }
    }

    /// The runs of the ring just within a distance.
    fn runs(&self, distance: f64) -> &[(f64, f64)] {
        let part = (distance - self.inner) / (self.outer - self.inner).max(SLACK);
        let ring = ((part * self.rings as f64) as usize).min(self.rings - 1);
        &self.runs[self.starts[ring] as usize..self.starts[ring + 1] as usize]
    }

    /// What it cost to make, in units of [`crate::space::Space::work`].
    pub fn cost(&self) -> u64 {
        RING_COST * self.rings as u64
    }

    /// How far at least the hull can turn left and right before it meets a point of a box (from the axle, in the hull's axes),
    /// rad; `None` when it never does.
    pub fn rooms(&self, patch: &Patch) -> Option<(f64, f64)> {
        let nearest = patch.nearest() - SLACK;
        if nearest >= self.outer {
            return None;
        }
        if nearest <= self.inner || nearest <= 0.0 {
            return Some((0.0, 0.0));
        }
        let (bearing, half) = (patch.center.y.atan2(patch.center.x), patch.half_angle() + SLACK);
        let (mut left, mut right) = (f64::INFINITY, f64::INFINITY);
        for (from, to) in self.runs(nearest) {
            // A turn to the left takes a point to lower bearings, to the upper end of a run.
            let (from, length) = (from - half, to - from + 2.0 * half);
            let past = once_round(bearing - from);
            let room = past - length;
            if room <= 0.0 {
                return Some((0.0, 0.0));
            }
            (left, right) = (left.min(room), right.min(TAU - past));
        }
        left.is_finite().then_some((left, right))
    }

    /// Whether all headings at which the hull may meet a point of a box (from the axle, in the map's axes) are told by
    /// `is_known(from, length)`.
    pub fn all_known(&self, patch: &Patch, is_known: impl Fn(f64, f64) -> bool) -> bool {
        let nearest = patch.nearest() - SLACK;
        if nearest >= self.outer {
            return true;
        }
        if nearest <= self.inner || nearest <= 0.0 {
            return is_known(0.0, TAU);
        }
        let (bearing, half) = (patch.center.y.atan2(patch.center.x), patch.half_angle() + SLACK);
        self.runs(nearest).iter().all(|(from, to)| {
            let length = to - from + 2.0 * half;
            if length >= TAU { is_known(0.0, TAU) } else { is_known(bearing - to - half, length) }
        })
    }

    /// How far the hull reaches forward and backward in a run of strips, both ends with it, m.
    fn reach(&self, first: usize, last: usize) -> (f64, f64) {
        let size = (last - first + 1).ilog2();
        let runs = &self.fronts[size as usize];
        farther(runs[first], runs[last + 1 - (1 << size)])
    }

    /// How far at least the hull can drive ahead and back before it meets a point of a box (in the hull's frame), m; infinite
    /// where it never does.
    pub fn ways(&self, patch: &Patch) -> (f64, f64) {
        let never = (f64::INFINITY, f64::INFINITY);
        let (p, extent) = (patch.center, patch.extent().add_scalar(SLACK));
        let at = |y: f64| (y - self.bottom) / self.strip;
        let (low, high) = (at(p.y - extent.y) - SLACK, at(p.y + extent.y) + SLACK);
        if high < 0.0 || low > STRIPS as f64 {
            return never;
        }
        if let Some(ways) = self.ways_of_line(patch) {
            return ways;
        }
        let (first, last) = (low.max(0.0) as usize, (high as usize).min(STRIPS - 1));
        let reach = self.reach(first.min(STRIPS - 1), last);
        // Ahead of the hull lies nothing that is behind all of it.
        let is_behind = p.x + extent.x < -reach.1;
        let ahead = if is_behind { f64::INFINITY } else { (p.x - extent.x - reach.0).max(0.0) };
        let is_ahead = p.x - extent.x > reach.0;
        let behind = if is_ahead { f64::INFINITY } else { (-p.x - extent.x - reach.1).max(0.0) };
        (ahead, behind)
    }

    /// The same of a box that is hardly more than a line beside the hull.
    fn ways_of_line(&self, patch: &Patch) -> Option<(f64, f64)> {
        let is_slender = |by: f64| patch.half.y <= by && patch.half.x > SLENDER * by;
        let grown = &self.grown[THIN.iter().position(|&by| is_slender(by))?];
        let line = patch.spine();
        if grown.overlaps(&line) {
            return None;
        }
        Some(match grown.stop_by(&line) {
            Some(InTheWay::Ahead(way)) => (way - SLACK, f64::INFINITY),
            Some(InTheWay::Behind(way)) => (f64::INFINITY, way - SLACK),
            None => (f64::INFINITY, f64::INFINITY),
        })
    }
}

/// The farthest of one, of two, four, ... neighbours.
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

/// An angle within [0, 2 pi).
pub fn once_round(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).floor()
}

/// No point of the hull between two heights reaches farther along x (against it for `sign` -1), m. The front is concave: it is
/// highest at the foremost corner, or at the end that is nearer to it.
fn front_in(hull: &Hull, low: f64, high: f64, sign: f64) -> f64 {
    let (_, most) = hull.core_extent(Vector2::x() * sign);
    let foremost = hull.core.iter().find(|corner| sign * corner.at.x >= most);
    let apex = foremost.map_or(low, |corner| corner.at.y);
    let reach = hull.front(apex.clamp(low, high), sign);
    let is_known = reach.is_finite() && !(low..=high).contains(&apex);
    if is_known { reach + SLACK } else { most + hull.radius + SLACK }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Arc, Segment};
    use proptest::prelude::*;
    use trundle_core::Footprint;

    fn hull(shift: (f64, f64), margin: f64) -> Hull {
        let corners = [(0.3, 0.2), (-0.3, 0.25), (-0.35, -0.2), (0.3, -0.2), (0.4, 0.0)];
        let at = |(x, y): (f64, f64)| Vector2::new(x + shift.0, y + shift.1);
        Hull::new(&Footprint::polygon(corners.map(at).to_vec()).unwrap(), margin)
    }

    proptest! {
        /// What the profile says of a box holds for every point in it.
        #[test]
        fn never_more_than_the_closed_forms(
            shift in (-0.6..0.6_f64, -0.5..0.5_f64), margin in 0.0..0.05_f64,
            center in (-0.8..0.8_f64, -0.8..0.8_f64), half in (0.0..0.3_f64, 0.0..0.2_f64), thin in -7.0..0.0_f64,
            part in (-1.0..1.0_f64, -1.0..1.0_f64), bearing in 0.0..TAU,
        ) {
            let hull = hull(shift, margin);
            let profile = Profile::new(&hull, 5000);
            let center = Vector2::new(center.0, center.1);
            let axis = Vector2::new(bearing.cos(), bearing.sin());
            let patch = Patch { center, axis, half: Vector2::new(half.0, half.1 * 10_f64.powf(thin)) };
            let p = center + axis * (half.0 * part.0) + Vector2::new(-axis.y, axis.x) * (patch.half.y * part.1);
            let (mut angles, mut blocked) = (Vec::new(), Vec::<Arc>::new());
            hull.blocked_headings(&Segment::point(p), &mut angles, &mut blocked);
            let rooms = profile.rooms(&patch);
            for arc in &blocked {
                let (left, right) = arc.room_from(0.0);
                let least = rooms.expect("it is met");
                prop_assert!(least.0 <= left + 1e-9 && least.1 <= right + 1e-9, "{least:?} {left} {right}");
            }
            let inside = |heading: f64| blocked.iter().any(|arc| (heading - arc.start).rem_euclid(TAU) <= arc.length);
            for i in 0..90 {
                let heading = TAU * f64::from(i) / 90.0;
                let holds = |from: f64, length: f64| (heading - from).rem_euclid(TAU) <= length;
                // Were all headings known but this one, the box would matter where this one is blocked.
                prop_assert!(!inside(heading) || !profile.all_known(&patch, |from, length| !holds(from, length)));
            }
            if !hull.overlaps(&Segment::point(p)) {
                let (ahead, behind) = profile.ways(&patch);
                match hull.stop_by(&Segment::point(p)) {
                    Some(InTheWay::Ahead(way)) => prop_assert!(ahead <= way + 1e-9, "{ahead} {way}"),
                    Some(InTheWay::Behind(way)) => prop_assert!(behind <= way + 1e-9, "{behind} {way}"),
                    None => {}
                }
            }
        }
    }
}
