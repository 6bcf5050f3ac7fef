//! Construction of the hierarchy by the surface area heuristic.

use super::node::{LEAF, Node, WIDTH};
use crate::world::Aabb;
use trundle_core::Vector3;

/// Bins of the surface area heuristic, an axis. Source: ours.
const SAH_BINS: usize = 16;

/// Levels after which items are halved by number: no tree gets deeper than this and 32. Source: ours.
const MAX_SAH_DEPTH: usize = 24;

/// The nodes of a hierarchy, its items in the order of the leaves, and begin and end of each leaf among the items.
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    pub(super) items: Vec<u32>,
    pub(super) leaves: Vec<(u32, u32)>,
}

/// The hierarchy over `boxes`, with at most `max` items per leaf.
pub(super) fn build(boxes: &[Aabb], max: usize) -> Tree {
    let centers = boxes.iter().map(Aabb::center).collect();
    let items = (0..boxes.len() as u32).collect();
    let tree = Tree { nodes: Vec::new(), items, leaves: Vec::new() };
    let mut builder = Builder { boxes, centers, max, tree };
    if !boxes.is_empty() {
        builder.add_node(0, boxes.len(), 0);
    }
    builder.tree
}

struct Builder<'a> {
    boxes: &'a [Aabb],
    centers: Vec<Vector3>,
    max: usize,
    tree: Tree,
}

/// A range of items.
#[derive(Clone, Copy)]
struct Part {
    first: usize,
    end: usize,
    bounds: Aabb,
}

impl Part {
    fn len(&self) -> usize {
        self.end - self.first
    }
}

impl Builder<'_> {
    /// Adds a node over a range of items with its subtree; returns its index.
    fn add_node(&mut self, first: usize, end: usize, depth: usize) -> u32 {
        let mut parts = vec![self.part(first, end)];
        while parts.len() < WIDTH {
            // The largest is opened first.
            let open = parts.iter().enumerate().filter(|(_, part)| part.len() > self.max);
            let largest = open.max_by(|a, b| area(&a.1.bounds).total_cmp(&area(&b.1.bounds)));
            let Some((largest, _)) = largest else { break };
            let (left, right) = self.split(parts[largest], depth);
            parts[largest] = left;
            parts.push(right);
        }
        let index = self.tree.nodes.len();
        self.tree.nodes.push(node_over(&parts));
        for (i, part) in parts.iter().enumerate() {
            self.tree.nodes[index].links[i] = if part.len() <= self.max {
                self.tree.leaves.push((part.first as u32, part.end as u32));
                LEAF | (self.tree.leaves.len() as u32 - 1)
            } else {
                self.add_node(part.first, part.end, depth + 1)
            };
        }
        index as u32
    }

    fn part(&self, first: usize, end: usize) -> Part {
        let boxes = self.tree.items[first..end].iter().map(|&i| self.boxes[i as usize]);
        let bounds = boxes.reduce(Aabb::union).expect("invariant: a part holds an item");
        Part { first, end, bounds }
    }

    fn split(&mut self, part: Part, depth: usize) -> (Part, Part) {
        let middle = self.partition(part, depth).unwrap_or_else(|| part.first.midpoint(part.end));
        (self.part(part.first, middle), self.part(middle, part.end))
    }

    /// Orders the items by the best plane; returns the start of the right side. `None` if no plane separates them.
    fn partition(&mut self, part: Part, depth: usize) -> Option<usize> {
        let items = &mut self.tree.items[part.first..part.end];
        let scale = Scale::over(items, &self.centers);
        let axis_and_bin =
            if depth < MAX_SAH_DEPTH { best_plane(items, self.boxes, &self.centers, &scale) } else { None };
        let (axis, bin) = axis_and_bin?;
        let mut left = 0;
        for i in 0..items.len() {
            if scale.bin(&self.centers[items[i] as usize], axis) < bin {
                items.swap(i, left);
                left += 1;
            }
        }
        Some(part.first + left)
    }
}

/// Scale from centres to bins.
struct Scale {
    low: Vector3,
    bins_per_metre: Vector3,
}

impl Scale {
    fn over(items: &[u32], centers: &[Vector3]) -> Self {
        let mut low = Vector3::repeat(f64::INFINITY);
        let mut high = -low;
        for &item in items {
            let center = centers[item as usize];
            (low, high) = (low.inf(&center), high.sup(&center));
        }
        let bins = |extent: f64| if extent > 0.0 { SAH_BINS as f64 * (1.0 - 1e-9) / extent } else { 0.0 };
        Self { low, bins_per_metre: (high - low).map(bins) }
    }

    fn bin(&self, center: &Vector3, axis: usize) -> usize {
        (((center[axis] - self.low[axis]) * self.bins_per_metre[axis]) as usize).min(SAH_BINS - 1)
    }
}

/// The axis and the first bin of the right side with the minimum sum of area times number over both sides.
fn best_plane(items: &[u32], boxes: &[Aabb], centers: &[Vector3], scale: &Scale) -> Option<(usize, usize)> {
    let mut best = (f64::INFINITY, None);
    for axis in (0..3).filter(|&axis| scale.bins_per_metre[axis] > 0.0) {
        let mut bins: [(usize, Option<Aabb>); SAH_BINS] = [(0, None); SAH_BINS];
        for &item in items {
            let (count, bounds) = &mut bins[scale.bin(&centers[item as usize], axis)];
            *count += 1;
            let own = boxes[item as usize];
            *bounds = Some(bounds.map_or(own, |bounds| bounds.union(own)));
        }
        let costs_right = costs_from_the_end(&bins);
        let (mut count, mut bounds) = (0, None);
        for bin in 1..SAH_BINS {
            count += bins[bin - 1].0;
            bounds = union(bounds, bins[bin - 1].1);
            if count > 0 && count < items.len() {
                let cost = bounds.map_or(0.0, |b| area(&b)) * count as f64 + costs_right[bin];
                if cost < best.0 {
                    best = (cost, Some((axis, bin)));
                }
            }
        }
    }
    best.1
}

/// Area times number of all bins from each one on.
fn costs_from_the_end(bins: &[(usize, Option<Aabb>); SAH_BINS]) -> [f64; SAH_BINS] {
    let mut costs = [0.0; SAH_BINS];
    let (mut count, mut bounds) = (0, None);
    for bin in (0..SAH_BINS).rev() {
        count += bins[bin].0;
        bounds = union(bounds, bins[bin].1);
        costs[bin] = bounds.map_or(0.0, |b| area(&b)) * count as f64;
    }
    costs
}

fn union(a: Option<Aabb>, b: Option<Aabb>) -> Option<Aabb> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.union(b)),
        (a, b) => a.or(b),
    }
}

/// Half the surface of a box.
fn area(bounds: &Aabb) -> f64 {
    let size = bounds.max - bounds.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}

fn node_over(parts: &[Part]) -> Node {
    let (mut low, mut high) = ([[f32::INFINITY; WIDTH]; 3], [[f32::NEG_INFINITY; WIDTH]; 3]);
    for (i, part) in parts.iter().enumerate() {
        for k in 0..3 {
            low[k][i] = (part.bounds.min[k] as f32).next_down();
            high[k][i] = (part.bounds.max[k] as f32).next_up();
        }
    }
    Node { low, high, links: [0; WIDTH], count: parts.len() as u32 }
}
