//! Way-points from a lattice path: pulled taut like a string, wherever that costs nothing.

use crate::space::Space;
use trundle_core::Vector2;

/// Rounds of pulling; each halves what is left to gain.
const ROUNDS: usize = 3;

/// What a skipped point may cost more, as a share.
const SLACK: f64 = 2e-3;

/// The few way-points that a dense free path stands for: same ends, straight pieces free, hardly dearer than the path.
pub(crate) fn pull_taut(space: &Space<'_>, path: &[Vector2]) -> Vec<Vector2> {
    let mut way = thin(space, path);
    for _ in 0..ROUNDS {
        relax(space, &mut way);
        way = thin(space, &way);
    }
    way
}

/// Keeps the points that cannot be skipped: from each, the furthest later one that a straight move reaches as cheaply.
fn thin(space: &Space<'_>, path: &[Vector2]) -> Vec<Vector2> {
    let mut so_far = vec![0.0];
    for pair in path.windows(2) {
        so_far.push(so_far[so_far.len() - 1] + space.cost(pair[0], pair[1]));
    }
    let skips = |from: usize, to: usize| {
        let allowed = (so_far[to] - so_far[from]) * (1.0 + SLACK);
        (path[to] - path[from]).norm() <= allowed
            && space.cost(path[from], path[to]) <= allowed
            && space.sees(path[from], path[to])
    };
    let mut kept = vec![path[0]];
    let mut from = 0;
    while from + 1 < path.len() {
        from = furthest(from, path.len() - 1, skips);
        kept.push(path[from]);
    }
    kept.dedup_by(|a, b| (*a - *b).norm() < 1e-9);
    kept
}

/// By doubling, then halving: the furthest index that `skips` says can be reached from `from`, at least the next.
fn furthest(from: usize, last: usize, skips: impl Fn(usize, usize) -> bool) -> usize {
    let mut good = from + 1;
    let mut jump = 2;
    while good < last {
        let next = (from + jump).min(last);
        if !skips(from, next) {
            return halve(from, good, next, skips);
        }
        good = next;
        jump *= 2;
    }
    good
}

fn halve(from: usize, mut good: usize, mut bad: usize, skips: impl Fn(usize, usize) -> bool) -> usize {
    while bad - good > 1 {
        let middle = good.midpoint(bad);
        if skips(from, middle) {
            good = middle;
        } else {
            bad = middle;
        }
    }
    good
}

/// Moves each inner point towards the straight line between its neighbours, as far as that is free and gains.
fn relax(space: &Space<'_>, way: &mut [Vector2]) {
    for i in 1..way.len().saturating_sub(1) {
        let (before, here, after) = (way[i - 1], way[i], way[i + 1]);
        let target = crate::geometry::nearest_on_segment(here, before, after);
        let cost = space.cost(before, here) + space.cost(here, after);
        let gains = |point: Vector2| {
            space.cost(before, point) + space.cost(point, after) < cost - 1e-6
                && space.sees(before, point)
                && space.sees(point, after)
        };
        let shares = [1.0, 0.5, 0.25, 0.125];
        if let Some(moved) = shares.iter().map(|t| here + (target - here) * *t).find(|p| gains(*p)) {
            way[i] = moved;
        }
    }
}
