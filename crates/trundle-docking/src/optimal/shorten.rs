use super::connect::connect;
use super::legs::Legs;
use super::task::Task;
use crate::space::Space;
use trundle_core::Pose2;

/// More poses than this are not compared all with all.
const MOST: usize = 90;

/// Replaces runs of legs by one or two, wherever that is free and saves time, until [`Space::work`] comes to `limit`; never
/// slower than before.
pub async fn shorten(task: &Task, space: &mut Space<'_>, mut best: (f64, Legs), limit: u64) -> (f64, Legs) {
    while best.1.0.len() > 2 {
        let mut poses = vec![task.start];
        poses.extend(best.1.poses(&task.start));
        let last = poses.len() - 1;
        poses[last] = task.goal;
        match through(task, space, &poses, limit).await {
            Some((time, legs)) if time < best.0 - 1e-3 => best = (time, legs),
            _ => break,
        }
    }
    best
}

/// The fastest way along a list of poses, each of which may be passed over: legs and time (s), when there is one. Once
/// [`Space::work`] comes to `limit`, only neighbours are joined.
pub async fn through(task: &Task, space: &mut Space<'_>, poses: &[Pose2], limit: u64) -> Option<(f64, Legs)> {
    let count = poses.len();
    // The time to each pose with the pause after it, the pose before, and the legs between.
    let mut best: Vec<(f64, usize, Legs)> = vec![(f64::INFINITY, 0, Legs::default()); count];
    best[0].0 = 0.0;
    let span = if count > MOST { MOST / 4 } else { count };
    for i in 0..count - 1 {
        let so_far = best[i].0;
        for j in (i + 1..count.min(i + 1 + span)).rev() {
            let least = task.drive_cost(poses[i].distance(&poses[j]));
            if j > i + 1 && space.work() >= limit {
                continue;
            }
            if so_far + least >= best[j].0 {
                continue;
            }
            if let Some((time, legs)) = connect(task, space, &poses[i], &poses[j]).await {
                let total = so_far + time + task.limits.switch_time;
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
    let (time, _) = legs.motions(task, space)?;
    Some((time, legs))
}
