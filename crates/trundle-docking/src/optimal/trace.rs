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
pub fn trace(task: &Task, space: &mut Space<'_>, poses: &[Pose2], limit: u64) -> Option<(f64, Legs)> {
    let mut chain = vec![task.start];
    link(task, space, poses, &mut chain, limit)?;
    through(task, space, &chain, limit)
}

/// Adds poses to the chain that lead from the first of `poses` (already there) to the last, neighbours joined by legs.
fn link(
    task: &Task,
    space: &mut Space<'_>,
    poses: &[Pose2],
    chain: &mut Vec<Pose2>,
    limit: u64,
) -> Option<()> {
    if space.work() >= limit {
        return None;
    }
    let (first, last) = (poses.first()?, poses.last()?);
    if connect(task, space, first, last).is_some() {
        chain.push(*last);
        return Some(());
    }
    if poses.len() == 2 {
        return halve(task, space, first, last, HALVINGS, chain);
    }
    let middle = poses.len() / 2;
    link(task, space, &poses[..=middle], chain, limit)?;
    link(task, space, &poses[middle..], chain, limit)
}

fn halve(
    task: &Task,
    space: &mut Space<'_>,
    first: &Pose2,
    last: &Pose2,
    times: u32,
    chain: &mut Vec<Pose2>,
) -> Option<()> {
    if connect(task, space, first, last).is_some() {
        chain.push(*last);
        return Some(());
    }
    if times == 0 {
        return None;
    }
    let turn = wrap_angle(last.theta - first.theta);
    let middle = Pose2::new((first.x + last.x) / 2.0, (first.y + last.y) / 2.0, first.theta + turn / 2.0);
    if space.contact(&middle).is_some() {
        return None;
    }
    halve(task, space, first, &middle, times - 1, chain)?;
    halve(task, space, &middle, last, times - 1, chain)
}
