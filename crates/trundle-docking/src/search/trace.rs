//! A manoeuvre along a motion of any kind.
//!
//! Idea \[Laumond94\]: a motion that may also go sideways follows connected poses. Its poses are joined by one or two legs, distant poses
//! first; if these are not free, the motion is halved, repeatedly. A base that can turn and drive a little can move sideways a little:
//! short parts are free with any clearance.

use crate::contact_space::ContactSpace;
use crate::legs::leg_sequence::Legs;
use crate::legs::query::DockingQuery;
use crate::search::connect::connect;
use crate::search::shorten::through;
use trundle_core::{Pose2, wrap_angle};

/// Largest number of halvings between two neighbouring poses. Source: ours.
const MAX_HALVINGS: u32 = 5;

/// Legs along `poses` from start to goal, and their time (s); `None` if some part is not free, or when [`ContactSpace::work`] reaches
/// `limit`.
pub async fn trace(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    poses: &[Pose2],
    limit: u64,
) -> Option<(f64, Legs)> {
    let chain = linked(query, space, poses, limit).await?;
    through(query, space, &chain, limit).await
}

/// A part of the motion still to be joined; the next parts are on top of the stack.
#[derive(Debug, Clone, Copy)]
enum Part {
    /// A run from one of the poses to another.
    Run(usize, usize),
    /// A gap between two neighbours, with the remaining halvings.
    Gap(Pose2, Pose2, u32),
}

/// Poses from the first of `poses` to the last, neighbours joined by legs.
async fn linked(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    poses: &[Pose2],
    limit: u64,
) -> Option<Vec<Pose2>> {
    let mut chain = vec![query.start];
    let mut parts = vec![Part::Run(0, poses.len().checked_sub(1)?)];
    while let Some(part) = parts.pop() {
        if space.work() >= limit {
            return None;
        }
        let (first, last) = match part {
            Part::Run(from, to) => (poses[from], poses[to]),
            Part::Gap(first, last, _) => (first, last),
        };
        if connect(query, space, &first, &last).await.is_some() {
            chain.push(last);
            continue;
        }
        match part {
            Part::Run(from, to) if to > from + 1 => {
                let middle = from + (to - from).div_ceil(2);
                parts.extend([Part::Run(middle, to), Part::Run(from, middle)]);
            }
            Part::Run(..) => parts.extend(halves(space, &first, &last, MAX_HALVINGS)?),
            Part::Gap(.., times) => parts.extend(halves(space, &first, &last, times)?),
        }
    }
    Some(chain)
}

/// The two halves of a gap, the second first; `None` if the gap must not be halved, or its middle is not free.
fn halves(space: &ContactSpace<'_>, first: &Pose2, last: &Pose2, times: u32) -> Option<[Part; 2]> {
    let times = times.checked_sub(1)?;
    let turn = wrap_angle(last.theta - first.theta);
    let middle = Pose2::new((first.x + last.x) / 2.0, (first.y + last.y) / 2.0, first.theta + turn / 2.0);
    let is_free = space.contact(&middle).is_none();
    is_free.then_some([Part::Gap(middle, *last, times), Part::Gap(*first, middle, times)])
}
