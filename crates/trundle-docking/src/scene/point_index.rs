//! An index of points: a tree of oriented boxes.

use std::collections::HashSet;
use trundle_collision::OrientedBox;
use trundle_core::Vector2;

/// Points in a tree of boxes: a query visits only the boxes that matter.
#[derive(Debug, Clone, PartialEq)]
pub struct PointIndex {
    points: Vec<(Vector2, u32)>,
    /// The first node contains all; a node's two halves are neighbours.
    nodes: Vec<Node>,
}

/// Points within a box.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    patch: OrientedBox,
    from: u32,
    to: u32,
    /// Index of the first half; 0 for none.
    halves: u32,
}

/// Number of points of a node that is not halved. Source: ours.
const LEAF_POINTS: usize = 8;
/// Counted cost of the bound of a box. Source: ours.
const BOUND_COST: u64 = 12;
/// Capacity of the stack of nodes: halving makes it deep enough for 2^31 points. Source: ours.
const MAX_STACK: usize = 64;

/// A query over all points.
pub trait PointQuery {
    /// Whether a sample point of every box is visited before its halves, and then again with them.
    const VISITS_SAMPLES: bool = true;
    /// Counted cost of a visit, in units of [`crate::ContactSpace::work`]. Source: ours.
    const COST: u64 = 1;

    /// Relevance of the points in a box, given the results so far: boxes with the smallest value are visited first. `None` if the points
    /// are irrelevant.
    fn relevance(&self, patch: &OrientedBox) -> Option<f64>;

    /// Visits a point with its number.
    fn visit(&mut self, p: Vector2, number: u32);
}

impl PointIndex {
    /// The index of finite points, each with its own number; of points at one position, which no box separates, the first.
    pub fn new(mut points: Vec<(Vector2, u32)>) -> Self {
        let mut places = HashSet::with_capacity(points.len());
        points.retain(|(p, _)| places.insert([p.x.to_bits(), p.y.to_bits()]));
        let mut nodes = Vec::with_capacity(points.len() / LEAF_POINTS * 4);
        if !points.is_empty() {
            nodes.push(node(&points, 0, points.len()));
        }
        let mut next = 0;
        while next < nodes.len() {
            let Node { from, to, .. } = nodes[next];
            let (from, to) = (from as usize, to as usize);
            if to - from > LEAF_POINTS {
                let middle = halve(&mut points[from..to], nodes[next].patch.axis) + from;
                nodes[next].halves = nodes.len() as u32;
                nodes.extend([node(&points, from, middle), node(&points, middle, to)]);
            }
            next += 1;
        }
        Self { points, nodes }
    }

    /// All points.
    pub fn all(&self) -> &[(Vector2, u32)] {
        &self.points
    }

    /// Calls `visit` with every point in a box around `center`, and possibly some points nearby.
    pub fn visit(&self, center: Vector2, half: Vector2, visit: impl FnMut(Vector2, u32)) {
        self.run_query(&mut InBox { center, half, visit });
    }

    /// Runs a query over the points, the most relevant first; returns its cost.
    pub fn run_query<Q: PointQuery>(&self, query: &mut Q) -> u64 {
        let mut waiting = [0_u32; MAX_STACK];
        let mut count = usize::from(!self.nodes.is_empty());
        // The bound of the node on top of the stack is known.
        let (mut work, mut is_fresh) = (0, false);
        while count > 0 {
            (count, work) = (count - 1, work + 2 * BOUND_COST);
            let node = &self.nodes[waiting[count] as usize];
            if !std::mem::take(&mut is_fresh) && query.relevance(&node.patch).is_none() {
                continue;
            }
            if node.halves == 0 {
                for &(p, number) in &self.points[node.from as usize..node.to as usize] {
                    work += BOUND_COST;
                    if query.relevance(&OrientedBox::point(p)).is_some() {
                        query.visit(p, number);
                        work += Q::COST;
                    }
                }
                continue;
            }
            let (p, number) = self.points[(node.from + node.to) as usize / 2];
            if Q::VISITS_SAMPLES && query.relevance(&OrientedBox::point(p)).is_some() {
                query.visit(p, number);
                work += Q::COST;
            }
            let halves = [node.halves, node.halves + 1];
            let [a, b] = halves.map(|i| query.relevance(&self.nodes[i as usize].patch));
            let first = usize::from(b.unwrap_or(f64::INFINITY) < a.unwrap_or(f64::INFINITY));
            for half in [1 - first, first] {
                if [a, b][half].is_some() {
                    waiting[count] = halves[half];
                    count += 1;
                    is_fresh = true;
                }
            }
        }
        work
    }
}

fn node(points: &[(Vector2, u32)], from: usize, to: usize) -> Node {
    let patch = OrientedBox::around(points[from..to].iter().map(|(p, _)| *p));
    Node { patch, from: from as u32, to: to as u32, halves: 0 }
}

/// Partitions points along an axis into two halves; returns the start of the second.
fn halve(points: &mut [(Vector2, u32)], axis: Vector2) -> usize {
    let middle = points.len() / 2;
    let along = |(p, _): &(Vector2, u32)| axis.dot(p);
    points.select_nth_unstable_by(middle, |a, b| along(a).total_cmp(&along(b)).then(a.1.cmp(&b.1)));
    middle
}

struct InBox<F> {
    center: Vector2,
    half: Vector2,
    visit: F,
}

impl<F: FnMut(Vector2, u32)> PointQuery for InBox<F> {
    const VISITS_SAMPLES: bool = false;

    fn relevance(&self, patch: &OrientedBox) -> Option<f64> {
        let off = (patch.center - self.center).abs() - patch.extent();
        (off.x <= self.half.x && off.y <= self.half.y).then_some(0.0)
    }

    fn visit(&mut self, p: Vector2, number: u32) {
        (self.visit)(p, number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_query_finds_every_point_once() {
        let points: Vec<_> = (0..500u32)
            .map(|i| (Vector2::new(f64::from(i * 37 % 101) * 0.031, f64::from(i * 53 % 97) * 0.027), i))
            .collect();
        let index = PointIndex::new(points.clone());
        let (center, half) = (Vector2::new(1.3, 1.1), 0.42);
        let mut found = Vec::new();
        index.visit(center, Vector2::repeat(half), |p, i| {
            if (p - center).amax() <= half {
                found.push(i);
            }
        });
        found.sort_unstable();
        let expected: Vec<u32> =
            points.iter().filter(|(p, _)| (p - center).amax() <= half).map(|(_, i)| *i).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn points_at_one_position_are_one() {
        let index = PointIndex::new((0..1000).map(|i| (Vector2::new(1.0, 2.0), i)).collect());
        let mut found = Vec::new();
        index.visit(Vector2::new(1.0, 2.0), Vector2::zeros(), |_, i| found.push(i));
        assert_eq!(found, [0]);
    }
}
