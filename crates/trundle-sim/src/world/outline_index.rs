//! A hierarchy over many outlines for the nearest one.

use super::region::Region;
use trundle_core::Vector2;

/// Maximum number of outlines of a leaf. Source: ours.
const LEAF_SIZE: usize = 4;

/// Many outlines and a hierarchy of boxes over them: a nearest query takes O(log n).
///
/// Built by median splits of the longest side, O(n log n); the same input makes the same tree.
#[derive(Debug, Clone, Default)]
pub(super) struct OutlineIndex {
    /// Corners of all outlines, contiguous per leaf.
    corners: Vec<Vector2>,
    /// (first corner, number of corners, radius) of every outline.
    outlines: Vec<(u32, u32, f64)>,
    nodes: Vec<Node>,
}

#[derive(Debug, Clone)]
struct Node {
    /// The box around the corners below.
    low: Vector2,
    high: Vector2,
    /// The largest radius below.
    radius: f64,
    /// Outlines of a leaf: a range of `outlines`. Of an inner node `count` is 0 and `first` its second child; its first
    /// child is the next node.
    first: u32,
    count: u32,
}

impl OutlineIndex {
    pub(super) fn new(outlines: &[Region<'_>]) -> Self {
        let boxes: Vec<(Vector2, Vector2)> = outlines.iter().map(Region::box_of_corners).collect();
        let mut index = Self::default();
        let mut order: Vec<u32> = (0..outlines.len() as u32).collect();
        index.add(&mut order, outlines, &boxes);
        index
    }

    fn add(&mut self, order: &mut [u32], outlines: &[Region<'_>], boxes: &[(Vector2, Vector2)]) {
        let around = order.iter().map(|&i| boxes[i as usize]).reduce(|a, b| (a.0.inf(&b.0), a.1.sup(&b.1)));
        let Some((low, high)) = around else { return };
        let this = self.nodes.len();
        let radius = order.iter().map(|&i| outlines[i as usize].radius).fold(0.0, f64::max);
        self.nodes.push(Node { low, high, radius, first: self.outlines.len() as u32, count: 0 });
        if order.len() <= LEAF_SIZE {
            self.nodes[this].count = order.len() as u32;
            for &i in order.iter() {
                let Region { corners, radius } = outlines[i as usize];
                self.outlines.push((self.corners.len() as u32, corners.len() as u32, radius));
                self.corners.extend_from_slice(corners);
            }
            return;
        }
        let axis = (high - low).imax();
        let place = |i: u32| boxes[i as usize].0[axis] + boxes[i as usize].1[axis];
        let middle = order.len() / 2;
        order.select_nth_unstable_by(middle, |&a, &b| place(a).total_cmp(&place(b)).then(a.cmp(&b)));
        let (left, right) = order.split_at_mut(middle);
        self.add(left, outlines, boxes);
        self.nodes[this].first = self.nodes.len() as u32;
        self.add(right, outlines, boxes);
    }

    /// The clearance of the nearest outline; infinite without outlines.
    pub(super) fn clearance(&self, robot: Region<'_>) -> f64 {
        let walls = Walls::new(robot);
        let bound = |at: u32| {
            let node = &self.nodes[at as usize];
            walls.gap_of_box(node.low, node.high) - node.radius - robot.radius
        };
        let mut best = f64::INFINITY;
        let mut stack = [(0_u32, f64::NEG_INFINITY); 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let (at, nearest) = stack[depth];
            if nearest >= best {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.count > 0 {
                for outline in (node.first..node.first + node.count).map(|i| self.outline(i as usize)) {
                    if walls.gap_of_corners(outline.corners) - outline.radius - robot.radius < best {
                        best = best.min(outline.clearance(&robot));
                    }
                }
                continue;
            }
            let children = [at + 1, node.first].map(|child| (child, bound(child)));
            let [near, far] =
                if children[0].1 <= children[1].1 { children } else { [children[1], children[0]] };
            (stack[depth], stack[depth + 1]) = (far, near);
            depth += 2;
        }
        best
    }

    fn outline(&self, i: usize) -> Region<'_> {
        let (first, count, radius) = self.outlines[i];
        Region { corners: &self.corners[first as usize..(first + count) as usize], radius }
    }
}

/// Maximum number of the robot's sides used as bounds; any number is valid, more are tighter. Source: ours.
const MAX_SIDES: usize = 8;

/// Distance by which bounds are reduced, m, against rounding errors. Source: ours.
const BOUND_SLACK_M: f64 = 1e-9;

/// The box and the sides of a robot: lower bounds of the distance of objects outside of them.
struct Walls {
    low: Vector2,
    high: Vector2,
    /// Outward normal of a side, and its distance from the origin along the normal.
    sides: [(Vector2, f64); MAX_SIDES],
    count: usize,
}

impl Walls {
    fn new(robot: Region<'_>) -> Self {
        let (low, high) = robot.box_of_corners();
        let mut walls = Self { low, high, sides: [(Vector2::zeros(), 0.0); MAX_SIDES], count: 0 };
        if robot.corners.len() > 2 {
            let next = robot.corners.iter().cycle().skip(1);
            for (a, b) in robot.corners.iter().zip(next).take(MAX_SIDES) {
                if let Some(out) = Vector2::new(b.y - a.y, a.x - b.x).try_normalize(0.0) {
                    walls.sides[walls.count] = (out, out.dot(a));
                    walls.count += 1;
                }
            }
        }
        walls
    }

    /// No point of a box is nearer than this, m.
    fn gap_of_box(&self, low: Vector2, high: Vector2) -> f64 {
        let (center, half) = ((low + high) / 2.0, (high - low) / 2.0);
        self.beyond(low, high, |out| out.dot(&center) - out.abs().dot(&half))
    }

    /// No point of the hull of some corners is nearer than this, m.
    fn gap_of_corners(&self, corners: &[Vector2]) -> f64 {
        let (low, high) = Region { corners, radius: 0.0 }.box_of_corners();
        let min = |out: &Vector2| corners.iter().map(|c| out.dot(c)).fold(f64::INFINITY, f64::min);
        self.beyond(low, high, min)
    }

    /// The maximum of the boxes' gap and of the distances outside each side; `min` is the smallest coordinate of the object along a
    /// normal.
    fn beyond(&self, low: Vector2, high: Vector2, min: impl Fn(&Vector2) -> f64) -> f64 {
        let gap = (low - self.high).sup(&(self.low - high)).sup(&Vector2::zeros()).norm();
        let sides = self.sides[..self.count].iter().map(|(out, offset)| min(out) - offset);
        (sides.fold(gap, f64::max) - BOUND_SLACK_M).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    type Raw = (Vec<(f64, f64)>, f64);

    /// Points, segments and polygons; only points have a radius.
    fn any_outline() -> impl Strategy<Value = Raw> {
        let point = (-5.0..5.0, -5.0..5.0);
        prop_oneof![
            (point.clone(), 0.0..1.0).prop_map(|(p, r)| (vec![p], r)),
            prop::collection::vec(point, 2..=5).prop_map(|corners| (corners, 0.0)),
        ]
    }

    fn corners((corners, _): &Raw) -> Vec<Vector2> {
        let mut points: Vec<Vector2> = corners.iter().map(|&(x, y)| Vector2::new(x, y)).collect();
        let mut hull = Vec::new();
        super::super::outline::fill_hull(&mut points, &mut hull);
        hull
    }

    proptest! {
        #[test]
        fn the_index_finds_what_a_scan_finds(raw in prop::collection::vec(any_outline(), 0..60), robot in any_outline()) {
            let hulls: Vec<Vec<Vector2>> = raw.iter().map(corners).collect();
            let outlines: Vec<Region> =
                hulls.iter().zip(&raw).map(|(corners, (_, radius))| Region { corners, radius: *radius }).collect();
            let robot_corners = corners(&robot);
            let robot = Region { corners: &robot_corners, radius: robot.1 };
            let scan = outlines.iter().map(|o| o.clearance(&robot)).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(OutlineIndex::new(&outlines).clearance(robot), scan);
        }
    }
}
