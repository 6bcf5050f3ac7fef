//! Replaces runs of legs by shorter ones.

use crate::contact_space::ContactSpace;
use crate::legs::leg_sequence::Legs;
use crate::legs::query::DockingQuery;
use crate::search::connect::connect;
use trundle_core::Pose2;

/// Number of poses above which not all pairs are compared. Source: ours.
const MAX_COMPARED_POSES: usize = 90;

/// Replaces runs of legs by one or two, if these are free and save time, until [`ContactSpace::work`] reaches `limit`; never slower than
/// the input.
pub async fn shorten(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    mut best: (f64, Legs),
    limit: u64,
) -> (f64, Legs) {
    while best.1.0.len() > 2 {
        let mut poses = vec![query.start];
        poses.extend(best.1.poses(&query.start));
        let last = poses.len() - 1;
        poses[last] = query.goal;
        match through(query, space, &poses, limit).await {
            Some((time, legs)) if time < best.0 - 1e-3 => best = (time, legs),
            _ => break,
        }
    }
    best
}

/// The fastest legs along a list of poses, each of which may be skipped, and their time (s); `None` if no legs are free. Once
/// [`ContactSpace::work`] reaches `limit`, only neighbours are joined.
pub async fn through(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    poses: &[Pose2],
    limit: u64,
) -> Option<(f64, Legs)> {
    let count = poses.len();
    // The time to each pose with the following pause, the previous pose, and the legs in between.
    let mut best: Vec<(f64, usize, Legs)> = vec![(f64::INFINITY, 0, Legs::default()); count];
    best[0].0 = 0.0;
    let span = if count > MAX_COMPARED_POSES { MAX_COMPARED_POSES / 4 } else { count };
    for i in 0..count - 1 {
        let so_far = best[i].0;
        for j in (i + 1..count.min(i + 1 + span)).rev() {
            let min = query.drive_cost(poses[i].distance(&poses[j]));
            if j > i + 1 && space.work() >= limit {
                continue;
            }
            if so_far + min >= best[j].0 {
                continue;
            }
            if let Some((time, legs)) = connect(query, space, &poses[i], &poses[j]).await {
                let total = so_far + time + query.limits.switch_time;
                if total < best[j].0 {
                    best[j] = (total, i, legs);
                }
            }
        }
    }
    let (mut at, mut parts) = (count - 1, Vec::new());
    while at > 0 {
        if best[at].0.is_infinite() {
            return None;
        }
        parts.push(at);
        at = best[at].1;
    }
    let legs = Legs(parts.iter().rev().flat_map(|&at| best[at].2.0.iter().copied()).collect());
    let (time, _) = legs.motions(query, space)?;
    Some((time, legs))
}
