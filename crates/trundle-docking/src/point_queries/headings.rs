//! Query of point clouds: blocked headings.

use crate::scene::point_index::PointQuery;
use std::f64::consts::TAU;
use trundle_collision::{
    HeadingArc, HullProfile, OrientedBox, RoundedHull, Segment, blocked_headings, wrap_positive,
};
use trundle_core::Vector2;

/// The headings at which a hull overlaps points. All reported headings overlap; a small part at either end may be missing. It is used for
/// bounds, proofs and heuristics, for which a heading that wrongly counts as free is harmless.
pub struct HeadingsQuery<'q> {
    hull: &'q RoundedHull,
    profile: &'q HullProfile,
    position: Vector2,
    angles: &'q mut Vec<f64>,
    blocked: &'q mut Vec<HeadingArc>,
    first: usize,
    /// Width of headings that may be missing, rad.
    missing_heading: f64,
}

impl<'q> HeadingsQuery<'q> {
    /// A query that continues from the headings in `blocked` from `first` on, joined.
    pub fn new(
        (hull, profile): (&'q RoundedHull, &'q HullProfile),
        position: Vector2,
        angles: &'q mut Vec<f64>,
        blocked: &'q mut Vec<HeadingArc>,
        (first, missing_heading): (usize, f64),
    ) -> Self {
        Self { hull, profile, position, angles, blocked, first, missing_heading }
    }
}

impl PointQuery for HeadingsQuery<'_> {
    const COST: u64 = 50;

    fn relevance(&self, patch: &OrientedBox) -> Option<f64> {
        let arcs = &self.blocked[self.first..];
        let inside = |arc: &HeadingArc, from: f64, length: f64| {
            let core = (length - 2.0 * self.missing_heading).max(0.0);
            arc.length >= TAU
                || wrap_positive(from + self.missing_heading.min(length / 2.0) - arc.start) + core
                    <= arc.length
        };
        let seen = patch.in_frame(self.position, Vector2::x());
        let known = |from, length| arcs.iter().any(|arc| inside(arc, from, length));
        // Near boxes forbid the most headings.
        (!self.profile.all_known(&seen, known)).then(|| seen.center.norm_squared())
    }

    fn visit(&mut self, p: Vector2, _: u32) {
        let segment = Segment::point(p).in_frame(self.position, 1.0, 0.0);
        blocked_headings(self.hull, &segment, self.angles, self.blocked);
        join(self.blocked, self.first);
    }
}

/// Sorts intervals from `first` on and joins overlapping ones; an interval may extend over 2 pi.
pub fn join(arcs: &mut Vec<HeadingArc>, first: usize) {
    arcs[first..].sort_unstable_by(|a, b| a.start.total_cmp(&b.start));
    let mut kept = first;
    for i in first..arcs.len() {
        let arc = arcs[i];
        if kept > first && arc.start <= arcs[kept - 1].start + arcs[kept - 1].length {
            let last = &mut arcs[kept - 1];
            last.length = last.length.max(arc.start + arc.length - last.start);
        } else {
            arcs[kept] = arc;
            kept += 1;
        }
    }
    arcs.truncate(kept);
    // The last interval may extend over the first.
    while arcs.len() > first + 1 {
        let last = arcs[arcs.len() - 1];
        let over = last.start + last.length - TAU;
        if over < arcs[first].start {
            break;
        }
        let reach = (arcs[first].start + arcs[first].length).max(over);
        arcs.remove(first);
        let end = arcs.len() - 1;
        arcs[end].length = (reach + TAU - last.start).min(TAU);
    }
    if arcs[first..].iter().any(|arc| arc.length >= TAU - 1e-12) {
        arcs.truncate(first);
        arcs.push(HeadingArc::FULL);
    }
}
