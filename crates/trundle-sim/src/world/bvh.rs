use super::aabb::Aabb;

/// Most items of a leaf.
const LEAF_SIZE: usize = 2;

/// A bounding volume hierarchy over boxes, in depth-first order with skip links: walking it needs no stack.
///
/// Built by median splits of the longest axis: O(n log^2 n), deterministic.
#[derive(Debug)]
pub(crate) struct Bvh {
    nodes: Vec<Node>,
    items: Vec<u32>,
}

#[derive(Debug)]
struct Node {
    bounds: Aabb,
    /// Where to go on when this node is not entered.
    skip: u32,
    /// Items of a leaf: a range of `items`, empty for an inner node.
    first: u32,
    count: u32,
}

impl Bvh {
    pub(crate) fn new(boxes: &[Aabb]) -> Self {
        let mut bvh = Self { nodes: Vec::new(), items: Vec::new() };
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        bvh.add(&mut order, boxes);
        bvh
    }

    fn add(&mut self, order: &mut [u32], boxes: &[Aabb]) {
        let Some(bounds) = order.iter().map(|&i| boxes[i as usize]).reduce(Aabb::union) else { return };
        let this = self.nodes.len();
        let is_leaf = order.len() <= LEAF_SIZE;
        let count = if is_leaf { order.len() as u32 } else { 0 };
        self.nodes.push(Node { bounds, skip: 0, first: self.items.len() as u32, count });
        if is_leaf {
            self.items.extend_from_slice(order);
        } else {
            let axis = bounds.half().imax();
            let place = |i: &u32| boxes[*i as usize].center()[axis];
            order.sort_by(|a, b| place(a).total_cmp(&place(b)).then(a.cmp(b)));
            let (left, right) = order.split_at_mut(order.len() / 2);
            self.add(left, boxes);
            self.add(right, boxes);
        }
        self.nodes[this].skip = self.nodes.len() as u32;
    }

    /// Calls `visit` with every item of every leaf whose boxes, from the root down, all pass `enter`.
    ///
    /// Both see `state`, so that what was found can narrow what is entered.
    pub(crate) fn walk<S>(
        &self,
        state: &mut S,
        mut enter: impl FnMut(&mut S, &Aabb) -> bool,
        mut visit: impl FnMut(&mut S, usize),
    ) {
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if enter(state, &node.bounds) {
                for &item in &self.items[node.first as usize..(node.first + node.count) as usize] {
                    visit(state, item as usize);
                }
                at += 1;
            } else {
                at = node.skip as usize;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector3;

    #[test]
    fn walking_finds_exactly_what_a_scan_finds() {
        let boxes: Vec<Aabb> = (0..37)
            .map(|i| {
                let min = Vector3::new(f64::from(i * 7 % 37), f64::from(i * 5 % 11), 0.0);
                Aabb { min, max: min.add_scalar(1.5) }
            })
            .collect();
        let holds = |b: &Aabb, p: Vector3| (0..3).all(|k| b.min[k] <= p[k] && p[k] <= b.max[k]);
        let bvh = Bvh::new(&boxes);
        for point in [Vector3::new(3.2, 4.1, 0.5), Vector3::new(20.0, 9.0, 1.0), Vector3::new(-1.0, 0.0, 0.0)]
        {
            let mut found = Vec::new();
            bvh.walk(
                &mut found,
                |_, bounds| holds(bounds, point),
                |found, i| {
                    if holds(&boxes[i], point) {
                        found.push(i);
                    }
                },
            );
            found.sort_unstable();
            let expected: Vec<usize> = (0..boxes.len()).filter(|&i| holds(&boxes[i], point)).collect();
            assert_eq!(found, expected);
        }
    }
}
