//! Feasibility of turns and legs between boxes, by shrunk hulls.

use crate::contact_space::ContactSpace;
use crate::lower_bound::boxes::{PositionBox, Region, Square};
use crate::lower_bound::ranges::LegRange;
use std::collections::BTreeMap;
use std::f64::consts::{SQRT_2, TAU};
use trundle_collision::HeadingArc;
use trundle_core::Pose2;

/// Hulls shrunk in steps of the square root of two, for positions known to within a box.
#[derive(Debug)]
pub struct ShrunkHulls<'a> {
    whole: ContactSpace<'a>,
    /// Created on demand; `None` for a hull without area.
    spaces: [Option<Option<ContactSpace<'a>>>; SHRINK_STEPS],
    gaps: BTreeMap<Square, Vec<HeadingArc>>,
    blocked: Vec<HeadingArc>,
}

/// Smallest shrinking, m. Source: ours.
const MIN_SHRINK_M: f64 = 5e-4;
/// Number of shrinking steps. Source: ours.
const SHRINK_STEPS: usize = 20;

impl<'a> ShrunkHulls<'a> {
    /// Prepares the hulls.
    pub fn new(whole: &ContactSpace<'a>) -> Self {
        let spaces = std::array::from_fn(|_| None);
        Self { whole: whole.clone(), spaces, gaps: BTreeMap::new(), blocked: Vec::new() }
    }

    /// The hull for positions known within `depth` (m); `None` if no area remains.
    fn space(&mut self, depth: f64) -> Option<&mut ContactSpace<'a>> {
        let step = (2.0 * (depth / MIN_SHRINK_M).log2()).ceil().max(0.0) as usize;
        let whole = &self.whole;
        let half_step = if step.is_multiple_of(2) { 1.0 } else { SQRT_2 };
        let depth = MIN_SHRINK_M * 2_f64.powi((step / 2).min(SHRINK_STEPS) as i32) * half_step;
        let make = || whole.hull().shrunk(depth).map(|hull| whole.with_hull(hull));
        self.spaces.get_mut(step)?.get_or_insert_with(make).as_mut()
    }

    /// Computes the headings that may be free somewhere in a square, unless they are known.
    pub fn find_gaps(&mut self, region: &Region, square: Square) {
        if !self.gaps.contains_key(&square) {
            let gaps = self.gaps_at(&region.place(square));
            self.gaps.insert(square, gaps);
        }
    }

    /// The headings computed by [`ShrunkHulls::find_gaps`].
    pub fn gaps(&self, square: Square) -> &[HeadingArc] {
        self.gaps.get(&square).map_or(&[], Vec::as_slice)
    }

    fn gaps_at(&mut self, place: &PositionBox) -> Vec<HeadingArc> {
        let mut blocked = std::mem::take(&mut self.blocked);
        blocked.clear();
        if let Some(space) = self.space(place.radius()) {
            space.blocked_headings(place.center, &mut blocked);
        }
        let after =
            |i: usize| if i + 1 < blocked.len() { blocked[i + 1].start } else { blocked[0].start + TAU };
        let gap = |(i, arc): (usize, &HeadingArc)| {
            let start = arc.start + arc.length;
            HeadingArc { start: start.rem_euclid(TAU), length: after(i) - start }
        };
        let gaps: Vec<HeadingArc> =
            blocked.iter().enumerate().map(gap).filter(|gap| gap.length > 0.0).collect();
        let gaps = if blocked.is_empty() { vec![HeadingArc::FULL] } else { gaps };
        self.blocked = blocked;
        gaps
    }

    /// Whether a leg between two boxes may be free, driven forward or backward.
    pub fn may_drive(
        &mut self,
        from: &PositionBox,
        to: &PositionBox,
        leg: &LegRange,
        backward: bool,
    ) -> bool {
        let rest = to.center - from.center;
        let arm = self.whole.hull().outer_radius();
        let depth = from.radius().max(to.radius()) + arm * leg.spread;
        let Some(space) = self.space(depth) else { return true };
        let heading = leg.headings(backward).middle;
        let pose = Pose2::new(from.center.x, from.center.y, heading);
        let distance = if backward { -rest.norm() } else { rest.norm() };
        // A free drive backs off before a contact, which a bound must not do.
        space
            .drive(&pose, distance.abs() + 0.01)
            .allows(distance - (2.0 * crate::free_motion::BACK_OFF).copysign(distance))
    }
}
