//! Waypoints from a lattice path by string pulling.

use crate::search::configuration_space::ConfigurationSpace;

/// Number of rounds; each halves the remaining gain. Source: ours.
const PULLING_ROUNDS: usize = 3;

/// Relative increase of the cost that a skipped point may cause. Source: ours.
const MAX_COST_INCREASE: f64 = 2e-3;

use trundle_collision::Segment;
use trundle_core::Vector2;

/// The waypoints of a dense free path: same ends, free straight segments, and at most a slightly higher cost.
pub(crate) fn string_pulled(space: &ConfigurationSpace<'_>, path: &[Vector2]) -> Vec<Vector2> {
    let mut points = thin(space, path);
    for _ in 0..PULLING_ROUNDS {
        relax(space, &mut points);
        points = thin(space, &points);
    }
    points
}

/// Keeps the points that cannot be skipped: from each, the farthest later one that a straight move reaches at no higher cost.
fn thin(space: &ConfigurationSpace<'_>, path: &[Vector2]) -> Vec<Vector2> {
    let mut so_far = vec![0.0];
    for pair in path.windows(2) {
        so_far.push(so_far[so_far.len() - 1] + space.cost(pair[0], pair[1]));
    }
    let skips = |from: usize, to: usize| {
        let allowed = (so_far[to] - so_far[from]) * (1.0 + MAX_COST_INCREASE);
        (path[to] - path[from]).norm() <= allowed
            && space.cost(path[from], path[to]) <= allowed
            && space.connects(path[from], path[to])
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

/// The farthest index reachable from `from` according to `skips`, by doubling and bisection; at least the next one.
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

/// Moves each inner point towards the line between its neighbours while this is free and reduces the cost.
fn relax(space: &ConfigurationSpace<'_>, points: &mut [Vector2]) {
    for i in 1..points.len().saturating_sub(1) {
        let (before, here, after) = (points[i - 1], points[i], points[i + 1]);
        let target = Segment { a: before, b: after }.nearest(here);
        let cost = space.cost(before, here) + space.cost(here, after);
        let gains = |point: Vector2| {
            space.cost(before, point) + space.cost(point, after) < cost - 1e-6
                && space.connects(before, point)
                && space.connects(point, after)
        };
        let shares = [1.0, 0.5, 0.25, 0.125];
        if let Some(moved) = shares.iter().map(|t| here + (target - here) * *t).find(|p| gains(*p)) {
            points[i] = moved;
        }
    }
}
