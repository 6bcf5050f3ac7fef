//! A bounding volume hierarchy with eight boxes in each node.

#![expect(clippy::needless_range_loop, reason = "loops over lanes by number become SIMD")]

mod build;
mod node;
mod stack;

pub(crate) use node::{Node, WIDTH};

use super::aabb::Aabb;
use build::{Tree, build};
use node::LEAF;
use stack::Stack;

/// A bounding volume hierarchy over boxes: eight boxes a node, tested together (Wald et al. 2008, "Getting rid of packets").
///
/// Built from the top by the surface area heuristic over bins (Wald 2007): O(n log n), deterministic. Boxes are stored in f32, rounded
/// outwards.
#[derive(Debug)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    /// Items in the order of the leaves.
    items: Vec<u32>,
    /// Start and end of each leaf's items in `items`.
    leaves: Vec<(u32, u32)>,
}

/// A query of the boxes.
pub(crate) trait Probe {
    /// A lower bound of the distance of each box's content; infinite for boxes that are missed.
    fn distances(&self, node: &Node) -> [f32; WIDTH];
}

impl Bvh {
    /// A hierarchy over `boxes`, with at most `max_items` items per leaf.
    pub(crate) fn new(boxes: &[Aabb], max_items: usize) -> Self {
        let Tree { nodes, items, leaves } = build(boxes, max_items);
        Self { nodes, items, leaves }
    }

    /// Start and end of a leaf's items in [`Bvh::items`].
    pub(crate) fn leaf(&self, leaf: usize) -> (usize, usize) {
        let (first, end) = self.leaves[leaf];
        (first as usize, end as usize)
    }

    /// Number of leaves.
    pub(crate) fn leaf_count(&self) -> usize {
        self.leaves.len()
    }

    /// All items, in the order of the leaves.
    pub(crate) fn items(&self) -> &[u32] {
        &self.items
    }

    /// Begins a search for leaves.
    #[inline(always)]
    pub(crate) fn walk(&self) -> Walk<'_> {
        let mut stack = Stack::new();
        if !self.nodes.is_empty() {
            stack.push((0.0, 0));
        }
        Walk { bvh: self, stack }
    }
}

/// A search among the leaves of a [`Bvh`], roughly the nearest first.
pub(crate) struct Walk<'a> {
    bvh: &'a Bvh,
    stack: Stack,
}

impl Walk<'_> {
    /// The next leaf that `probe` meets nearer than `reach`.
    #[inline(always)]
    pub(crate) fn next(&mut self, probe: &impl Probe, reach: f32) -> Option<usize> {
        while let Some((distance, link)) = self.stack.pop() {
            if distance >= reach {
                continue;
            }
            if link & LEAF != 0 {
                return Some((link & !LEAF) as usize);
            }
            let node = &self.bvh.nodes[link as usize];
            let distances = probe.distances(node);
            let bottom = self.stack.len();
            for i in 0..WIDTH {
                if distances[i] < reach && i < node.count as usize {
                    self.stack.push_sorted(bottom, (distances[i], node.links[i]));
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::Vector3;

    /// Query for boxes that contain a point; their distance is their index in the node.
    struct Point([f32; 3]);

    impl Probe for Point {
        fn distances(&self, node: &Node) -> [f32; WIDTH] {
            let holds =
                |i: usize| (0..3).all(|k| node.low[k][i] <= self.0[k] && self.0[k] <= node.high[k][i]);
            std::array::from_fn(|i| if holds(i) { node.low[0][i].abs() } else { f32::INFINITY })
        }
    }

    fn boxes(seeds: &[(u8, u8, u8)]) -> Vec<Aabb> {
        let place = |&(x, y, z): &(u8, u8, u8)| {
            let min = Vector3::new(f64::from(x % 32), f64::from(y % 16), f64::from(z % 4));
            Aabb { min, max: min.add_scalar(1.5 + f64::from(x / 64)) }
        };
        seeds.iter().map(place).collect()
    }

    proptest! {
        #[test]
        fn walking_finds_exactly_what_a_scan_finds(
            seeds in prop::collection::vec(any::<(u8, u8, u8)>(), 0..200), max_items in 1..5_usize, x in 0.1..33.9_f32,
        ) {
            let boxes = boxes(&seeds);
            let bvh = Bvh::new(&boxes, max_items);
            let point = Point([x, 7.3, 1.6]);
            let holds = |b: &Aabb| (0..3).all(|k| b.min[k] <= f64::from(point.0[k]) && f64::from(point.0[k]) <= b.max[k]);
            let mut found = Vec::new();
            let mut walk = bvh.walk();
            while let Some(leaf) = walk.next(&point, f32::INFINITY) {
                let (first, end) = bvh.leaf(leaf);
                assert!(end - first <= max_items);
                found.extend(bvh.items()[first..end].iter().map(|&i| i as usize).filter(|&i| holds(&boxes[i])));
            }
            found.sort_unstable();
            let expected: Vec<usize> = (0..boxes.len()).filter(|&i| holds(&boxes[i])).collect();
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn items_beyond_the_reach_are_left_out() {
        let bvh = Bvh::new(&boxes(&[(1, 0, 0), (2, 0, 0), (9, 0, 0), (10, 0, 0), (11, 0, 0)]), 1);
        struct All;
        impl Probe for All {
            fn distances(&self, node: &Node) -> [f32; WIDTH] {
                node.low[0]
            }
        }
        let (mut visited, mut walk, mut reach) = (Vec::new(), bvh.walk(), f32::INFINITY);
        while let Some(leaf) = walk.next(&All, reach) {
            visited.push(bvh.items()[bvh.leaf(leaf).0]);
            reach = 9.5;
        }
        assert_eq!(visited, [0, 1, 2]);
    }

    #[test]
    fn equal_boxes_and_growing_ones_make_no_deep_tree() {
        let same = vec![Aabb { min: Vector3::zeros(), max: Vector3::repeat(1.0) }; 5000];
        let bvh = Bvh::new(&same, 2);
        let growing: Vec<Aabb> = (0..2000)
            .map(|i| Aabb {
                min: Vector3::repeat(1.01_f64.powi(i)),
                max: Vector3::repeat(1.01_f64.powi(i + 1)),
            })
            .collect();
        let count =
            |bvh: &Bvh| (0..bvh.leaf_count()).map(|leaf| bvh.leaf(leaf).1 - bvh.leaf(leaf).0).sum::<usize>();
        assert_eq!((count(&bvh), count(&Bvh::new(&growing, 4))), (5000, 2000));
    }
}
