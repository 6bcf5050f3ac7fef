//! Local improvement of legs.

use crate::contact_space::ContactSpace;
use crate::legs::leg_sequence::Legs;
use crate::legs::query::DockingQuery;
use trundle_core::wrap_angle;

/// Improves legs by small changes of single headings and distances; the last two distances follow from the exact end. Returns the legs and
/// their time (s), never slower than the input. Ends when [`ContactSpace::work`] reaches `limit`.
///
/// Coordinate search with halving steps. No derivative is used: the time has kinks where a turn vanishes or a speed limit is reached, and
/// the free set has corners.
pub async fn polish(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    legs: &Legs,
    time: f64,
    limit: u64,
) -> (f64, Legs) {
    let mut best = (time, legs.clone());
    let n = legs.0.len();
    if n < 2 {
        return best;
    }
    let (mut angle, mut distance) = (4_f64.to_radians(), 0.08);
    for _ in 0..9 {
        for _ in 0..6 {
            let mut improved = false;
            for i in 0..n {
                if space.work() >= limit {
                    return best;
                }
                space.yield_point().await;
                improved |= try_heading(query, space, &mut best, i, angle);
                if i + 2 < n {
                    improved |=
                        try_change(query, space, &mut best, |legs, sign| legs.0[i].1 += sign * distance);
                }
            }
            if !improved {
                break;
            }
        }
        (angle, distance) = (angle / 2.0, distance / 2.0);
    }
    best
}

fn try_heading(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    best: &mut (f64, Legs),
    i: usize,
    step: f64,
) -> bool {
    let mut improved =
        try_change(query, space, best, |legs, sign| legs.0[i].0 = wrap_angle(legs.0[i].0 + sign * step));
    // The removal of the first or last turn saves its pause.
    if i == 0 {
        improved |= try_change(query, space, best, |legs, _| legs.0[0].0 = query.start.theta);
    }
    if i + 1 == best.1.0.len() {
        improved |= try_change(query, space, best, |legs, _| legs.0[i].0 = query.goal.theta);
    }
    improved
}

fn try_change(
    query: &DockingQuery,
    space: &mut ContactSpace<'_>,
    best: &mut (f64, Legs),
    change: impl Fn(&mut Legs, f64),
) -> bool {
    for sign in [1.0, -1.0] {
        let mut legs = best.1.clone();
        change(&mut legs, sign);
        let Some(legs) = legs.closed(query) else { continue };
        if legs.min_time(query) >= best.0 - 1e-9 {
            continue;
        }
        if let Some((time, _)) = legs.motions(query, space)
            && time < best.0 - 1e-9
        {
            *best = (time, legs);
            return true;
        }
    }
    false
}
