use super::legs::Legs;
use super::task::Task;
use crate::space::Space;
use trundle_core::wrap_angle;

/// Improves legs by small changes of headings and ways, one at a time, the last two ways following so that the end stays
/// exact; returns the legs and their time (s), never worse than before; as far as [`Space::work`]
/// comes to `limit`.
///
/// Coordinate search with halving steps: the time has kinks where a turn vanishes or a speed limit is met, and the free
/// set has corners, so no derivative is asked for.
pub async fn polish(task: &Task, space: &mut Space<'_>, legs: &Legs, time: f64, limit: u64) -> (f64, Legs) {
    let mut best = (time, legs.clone());
    let n = legs.0.len();
    if n < 2 {
        return best;
    }
    let (mut angle, mut way) = (4_f64.to_radians(), 0.08);
    for _ in 0..9 {
        for _ in 0..6 {
            let mut improved = false;
            for i in 0..n {
                if space.work() >= limit {
                    return best;
                }
                space.rest().await;
                improved |= try_heading(task, space, &mut best, i, angle);
                if i + 2 < n {
                    improved |= try_change(task, space, &mut best, |legs, sign| legs.0[i].1 += sign * way);
                }
            }
            if !improved {
                break;
            }
        }
        (angle, way) = (angle / 2.0, way / 2.0);
    }
    best
}

fn try_heading(task: &Task, space: &mut Space<'_>, best: &mut (f64, Legs), i: usize, step: f64) -> bool {
    let mut improved =
        try_change(task, space, best, |legs, sign| legs.0[i].0 = wrap_angle(legs.0[i].0 + sign * step));
    // A first or last turn that vanishes saves its pause.
    if i == 0 {
        improved |= try_change(task, space, best, |legs, _| legs.0[0].0 = task.start.theta);
    }
    if i + 1 == best.1.0.len() {
        improved |= try_change(task, space, best, |legs, _| legs.0[i].0 = task.goal.theta);
    }
    improved
}

fn try_change(
    task: &Task,
    space: &mut Space<'_>,
    best: &mut (f64, Legs),
    change: impl Fn(&mut Legs, f64),
) -> bool {
    for sign in [1.0, -1.0] {
        let mut legs = best.1.clone();
        change(&mut legs, sign);
        let Some(legs) = legs.closed(task) else { continue };
        if legs.least_time(task) >= best.0 - 1e-9 {
            continue;
        }
        if let Some((time, _)) = legs.motions(task, space)
            && time < best.0 - 1e-9
        {
            *best = (time, legs);
            return true;
        }
    }
    false
}
