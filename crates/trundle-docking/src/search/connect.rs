//! Direct connections of two poses by a turn, or by one or two legs.

use crate::contact_space::ContactSpace;
use crate::legs::leg_sequence::Legs;
use crate::legs::query::DockingQuery;
use crate::search::leg_search::LegSearch;
use crate::search::rays::rays;
use trundle_core::Pose2;

/// Number of headings tried at either end. Source: ours.
const END_HEADINGS: usize = 24;
/// Smallest difference of two headings, rad. Source: ours.
const MIN_HEADING_STEP_RAD: f64 = 2e-3;

/// The fastest sampled connection of two poses by a turn alone or by one or two legs, and its time, s; `None` if none is free.
pub async fn connect(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    from: &Pose2,
    to: &Pose2,
) -> Option<(f64, Legs)> {
    let part = DockingQuery { start: *from, goal: *to, ..*query };
    if from.distance(to) < 1e-9 {
        let (time, _) = Legs::default().motions(&part, space)?;
        return Some((time, Legs::default()));
    }
    let mut fan = Vec::new();
    rays(&part, space, from, END_HEADINGS, MIN_HEADING_STEP_RAD, &mut fan).await;
    let mut search = LegSearch::new(part, space, (END_HEADINGS, MIN_HEADING_STEP_RAD), u64::MAX).await;
    search.complete(from, &fan, &[], 0.0).await;
    search.best.filter(|(_, legs)| legs.corners(from).all(|p| query.in_region(p)))
}
