//! A manoeuvre along a motion of any kind.
//!
//! Idea \[Laumond94\]: where poses hang together, a motion that may also go sideways leads from one end to the other. Its
//! poses are joined by one or two legs, far ones first; where these are not free, half the way is tried, and half of
//! that. A base that can turn a little and drive a little can go sideways a little, so that short parts come free wherever
//! there is any room.

use super::connect::connect;
use super::legs::Legs;
use super::shorten::through;
use super::task::Task;
use crate::space::Space;
use trundle_core::{Pose2, wrap_angle};

/// How often the way between two neighbouring poses is halved.
const HALVINGS: u32 = 5;

/// Legs along `poses`, which lead from start to goal, and their time (s); `None` when some part is not
/// free, or when [`Space::work`] comes to `limit` before.
pub async fn trace(task: &Task, space: &mut Space<'_>, poses: &[Pose2], limit: u64) -> Option<(f64, Legs)> {
    let chain = linked(task, space, poses, limit).await?;
    through(task, space, &chain, limit).await
}

/// A part of the way that is still to be joined; those to come first lie on top.
#[derive(Debug, Clone, Copy)]
enum Part {
    /// From one of the poses to another of them.
    Run(usize, usize),
    /// Between two neighbours, which may be halved so often.
    Gap(Pose2, Pose2, u32),
}

/// Poses from the first of `poses` to the last, neighbours joined by legs.
async fn linked(task: &Task, space: &mut Space<'_>, poses: &[Pose2], limit: u64) -> Option<Vec<Pose2>> {
    let mut chain = vec![task.start];
    let mut parts = vec![Part::Run(0, poses.len().checked_sub(1)?)];
    while let Some(part) = parts.pop() {
        if space.work() >= limit {
            return None;
        }
        let (first, last) = match part {
            Part::Run(from, to) => (poses[from], poses[to]),
            Part::Gap(first, last, _) => (first, last),
        };
        if connect(task, space, &first, &last).await.is_some() {
            chain.push(last);
            continue;
        }
        match part {
            Part::Run(from, to) if to > from + 1 => {
                let middle = from + (to - from).div_ceil(2);
                parts.extend([Part::Run(middle, to), Part::Run(from, middle)]);
            }
            Part::Run(..) => parts.extend(halves(space, &first, &last, HALVINGS)?),
            Part::Gap(.., times) => parts.extend(halves(space, &first, &last, times)?),
        }
    }
    Some(chain)
}

/// The two halves of a gap, the second first; `None` when it may not be halved, or its middle is not free.
fn halves(space: &Space<'_>, first: &Pose2, last: &Pose2, times: u32) -> Option<[Part; 2]> {
    let times = times.checked_sub(1)?;
    let turn = wrap_angle(last.theta - first.theta);
    let middle = Pose2::new((first.x + last.x) / 2.0, (first.y + last.y) / 2.0, first.theta + turn / 2.0);
    let is_free = space.contact(&middle).is_none();
    is_free.then_some([Part::Gap(middle, *last, times), Part::Gap(*first, middle, times)])
}
