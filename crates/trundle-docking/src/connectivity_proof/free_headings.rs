//! Free headings over the cells of a grid of positions.

use crate::contact_space::ContactSpace;
use std::f64::consts::TAU;
use trundle_collision::HeadingArc;
use trundle_core::{Pose2, Vector2};

/// Counted cost of a node without its headings, in units of [`ContactSpace::work`]. Source: ours.
const NODE_COST: u64 = 40;
/// Largest difference between two headings that count as nearly equal, rad. Source: ours.
const NEAR_HEADING_RAD: f64 = 0.03;

/// A free gap of headings over a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Node {
    /// Number of the cell, row by row.
    pub cell: u32,
    /// Number of the gap, for [`FreeHeadings::gap`].
    pub gap: u32,
}

/// Free headings over the cells of a square, computed on demand.
#[derive(Debug)]
pub struct FreeHeadings<'s, 'a> {
    space: &'s mut ContactSpace<'a>,
    low: Vector2,
    /// Side of a cell, m.
    pub side: f64,
    count: usize,
    /// First gap and number of gaps of each cell; `u32::MAX` before their computation.
    ranges: Vec<(u32, u32)>,
    gaps: Vec<HeadingArc>,
    blocked: Vec<HeadingArc>,
}

impl<'s, 'a> FreeHeadings<'s, 'a> {
    /// Cells of `side` (m) over the square of half side `half` (m) about `center`.
    pub fn new(space: &'s mut ContactSpace<'a>, center: Vector2, half: f64, side: f64) -> Self {
        let count = (2.0 * half / side).ceil() as usize + 1;
        let low = center - Vector2::repeat(count as f64 * side / 2.0);
        let ranges = vec![(u32::MAX, 0); count * count];
        space.set_heading_resolution(side / 4.0);
        Self { space, low, side, count, ranges, gaps: Vec::new(), blocked: Vec::new() }
    }

    /// The number of gaps found so far.
    pub fn gaps_found(&self) -> usize {
        self.gaps.len()
    }

    /// Footprint and obstacles.
    pub fn space(&mut self) -> &mut ContactSpace<'a> {
        self.space
    }

    /// The headings of a gap.
    pub fn gap(&self, node: Node) -> HeadingArc {
        self.gaps[node.gap as usize]
    }

    /// The middle of a cell, m.
    pub fn center(&self, cell: u32) -> Vector2 {
        let (row, column) = (cell as usize / self.count, cell as usize % self.count);
        self.low + Vector2::new(column as f64 + 0.5, row as f64 + 0.5) * self.side
    }

    /// The node of a pose; `None` if the pose is not free.
    pub fn node_at(&mut self, pose: &Pose2) -> Option<Node> {
        let at = (pose.position() - self.low) / self.side;
        let inside = at.min() >= 0.0 && at.max() < self.count as f64;
        let cell = inside.then(|| (at.y as usize * self.count + at.x as usize) as u32)?;
        let (first, many) = self.gaps_of(cell);
        (first..first + many)
            .map(|gap| Node { cell, gap })
            .find(|&node| overlaps(&self.gap(node), pose.theta, 0.0))
    }

    /// The node of a pose. If its own cell's centre is not free: the nearest surrounding cell with a free centre at its heading, or at a
    /// slightly different heading.
    pub fn node_near(&mut self, pose: &Pose2) -> Option<Node> {
        if let Some(node) = self.node_at(pose) {
            return Some(node);
        }
        let mut best: Option<(f64, Node)> = None;
        for (right, up) in
            (-1..=1).flat_map(|right| (-1..=1).map(move |up| (f64::from(right), f64::from(up))))
        {
            let place = pose.position() + Vector2::new(right, up) * self.side;
            for turn in [0.0, NEAR_HEADING_RAD, -NEAR_HEADING_RAD] {
                let Some(node) = self.node_at(&Pose2::new(place.x, place.y, pose.theta + turn)) else {
                    continue;
                };
                let distance = (self.center(node.cell) - pose.position()).norm() + self.side * turn.abs();
                if best.is_none_or(|(min, _)| distance < min) {
                    best = Some((distance, node));
                }
            }
        }
        best.map(|(_, node)| node)
    }

    /// Adds the nodes of the four neighbouring cells whose headings overlap with a node's.
    pub fn neighbours(&mut self, node: Node, found: &mut Vec<Node>) {
        found.clear();
        self.space.spend(NODE_COST);
        let (row, column) = (node.cell as usize / self.count, node.cell as usize % self.count);
        let (mine, last) = (self.gap(node), self.count - 1);
        let sides = [
            (row > 0, -(self.count as i64)),
            (row < last, self.count as i64),
            (column > 0, -1),
            (column < last, 1),
        ];
        for (_, step) in sides.into_iter().filter(|(inside, _)| *inside) {
            let cell = (i64::from(node.cell) + step) as u32;
            let (first, many) = self.gaps_of(cell);
            let nodes = (first..first + many).map(|gap| Node { cell, gap });
            found.extend(nodes.filter(|&other| {
                let gap = self.gap(other);
                overlaps(&mine, gap.start, gap.length)
            }));
        }
    }

    fn gaps_of(&mut self, cell: u32) -> (u32, u32) {
        let known = self.ranges[cell as usize];
        if known.0 != u32::MAX {
            return known;
        }
        self.blocked.clear();
        let center = self.center(cell);
        self.space.blocked_headings(center, &mut self.blocked);
        let first = self.gaps.len();
        for (i, arc) in self.blocked.iter().enumerate() {
            let next = if i + 1 < self.blocked.len() {
                self.blocked[i + 1].start
            } else {
                self.blocked[0].start + TAU
            };
            let start = arc.start + arc.length;
            if next - start > 1e-9 {
                self.gaps.push(HeadingArc { start: start.rem_euclid(TAU), length: next - start });
            }
        }
        if self.blocked.is_empty() {
            self.gaps.push(HeadingArc::FULL);
        }
        self.ranges[cell as usize] = (first as u32, (self.gaps.len() - first) as u32);
        self.ranges[cell as usize]
    }
}

/// Whether headings from `start` over `length` share one with `gap`.
fn overlaps(gap: &HeadingArc, start: f64, length: f64) -> bool {
    (start - gap.start).rem_euclid(TAU) <= gap.length || (gap.start - start).rem_euclid(TAU) <= length
}
