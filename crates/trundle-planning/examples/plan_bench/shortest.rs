//! The shortest any-angle path by Theta*, a search that shares only the distances with the planner.

use std::{cmp::Ordering, collections::BinaryHeap};
use trundle_core::{GridGeometry, Vector2};
use trundle_planning::DistanceField;

/// Spacing of the samples along a line of sight, cells. Source: ours.
const LOOK: f64 = 0.2;
/// Tolerance of the checks, m: rounding of the stored distances and the interpolation's error. Source: ours.
const SLACK: f64 = 1e-3;

#[derive(PartialEq)]
struct Entry(f64, usize);

impl Eq for Entry {}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The length of a Theta* path \[Nash07\] of a disc's centre after string pulling, m; infinite without a path. An upper bound of the
/// shortest length, in practice within a few per mille.
pub fn shortest(field: &DistanceField, radius: f64, from: Vector2, to: Vector2) -> f64 {
    let geometry = *field.geometry();
    let (Some(first), Some(last)) = (geometry.cell_at(from), geometry.cell_at(to)) else {
        return f64::INFINITY;
    };
    let (first, last) = (geometry.linear(first), geometry.linear(last));
    let place = |cell: usize| match cell {
        _ if cell == first => from,
        _ if cell == last => to,
        _ => geometry.center(geometry.cell(cell)),
    };
    let (mut cost, mut parent) = (vec![f64::INFINITY; geometry.len()], vec![first; geometry.len()]);
    let mut queue = BinaryHeap::from([Entry(0.0, first)]);
    cost[first] = 0.0;
    while let Some(Entry(key, cell)) = queue.pop() {
        if cell == last {
            return taut(field, radius, trace(&parent, first, last).into_iter().map(place).collect());
        }
        if key > cost[cell] + (place(cell) - to).norm() + 1e-9 {
            continue;
        }
        for near in neighbours(&geometry, cell) {
            let from = if sees(field, radius, place(parent[cell]), place(near)) {
                parent[cell]
            } else if sees(field, radius, place(cell), place(near)) {
                cell
            } else {
                continue;
            };
            let reached = cost[from] + (place(near) - place(from)).norm();
            if reached < cost[near] - 1e-9 {
                (cost[near], parent[near]) = (reached, from);
                queue.push(Entry(reached + (place(near) - to).norm(), near));
            }
        }
    }
    f64::INFINITY
}

fn trace(parent: &[usize], first: usize, last: usize) -> Vec<usize> {
    let mut path = vec![last];
    while path[path.len() - 1] != first {
        path.push(parent[path[path.len() - 1]]);
    }
    path.reverse();
    path
}

/// Moves corners towards the line between their neighbours while that line is free.
fn taut(field: &DistanceField, radius: f64, mut path: Vec<Vector2>) -> f64 {
    for _ in 0..20 {
        for i in 1..path.len().saturating_sub(1) {
            let middle = (path[i - 1] + path[i + 1]) / 2.0;
            let moved = [0.5, 0.1, 0.02].map(|share| path[i] + (middle - path[i]) * share);
            let free =
                |p: &Vector2| sees(field, radius, path[i - 1], *p) && sees(field, radius, *p, path[i + 1]);
            if let Some(better) = moved.into_iter().find(free) {
                path[i] = better;
            }
        }
    }
    path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

fn sees(field: &DistanceField, radius: f64, a: Vector2, b: Vector2) -> bool {
    let length = (b - a).norm();
    let mut at = 0.0;
    while at < length {
        let room = field.distance(a + (b - a) * (at / length)) - radius;
        if room < -SLACK {
            return false;
        }
        at += room.max(LOOK * field.geometry().resolution);
    }
    field.distance(b) >= radius - SLACK
}

fn neighbours(geometry: &GridGeometry, cell: usize) -> impl Iterator<Item = usize> + use<> {
    let GridGeometry { width, height, .. } = *geometry;
    let (col, row) = ((cell % width) as i64, (cell / width) as i64);
    (0..9).filter(|k| *k != 4).filter_map(move |k| {
        let (c, r) = (col + k % 3 - 1, row + k / 3 - 1);
        let inside = c >= 0 && r >= 0 && c < width as i64 && r < height as i64;
        inside.then_some(r as usize * width + c as usize)
    })
}
