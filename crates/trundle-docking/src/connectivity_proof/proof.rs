//! Connectivity that two poses are not connected.

use crate::connectivity_proof::free_headings::{FreeHeadings, Node};
use crate::contact_space::ContactSpace;
use crate::scene::blocker::Blocker;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// Result of the connectivity test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Connectivity {
    /// Start and goal are not connected: no motion of any kind leads from one to the other.
    Disconnected {
        /// The obstacle at which the reachable poses come nearest to the other end.
        by: Option<Blocker>,
    },
    /// Start and goal are connected, as far as cells of this side, or the work allowed, can show.
    Connected,
}

/// The grid of the connectivity test.
#[derive(Debug, Clone, Copy)]
pub struct ProofGrid {
    /// Centre of the square.
    pub center: Vector2,
    /// Half the side of the region, m.
    pub half: f64,
    /// Side of a cell, m.
    pub side: f64,
    /// Whether the hull is shrunk by a cell's half diagonal, for a proof; otherwise the true hull at the cells' centres gives reachability
    /// at this resolution.
    pub shrunk: bool,
    /// Value of [`ContactSpace::work`] at which the test ends without a proof.
    pub limit: u64,
}

/// Searches from both ends; the smaller region is extended.
pub async fn test_connectivity(
    space: &ContactSpace<'_>,
    start: &Pose2,
    goal: &Pose2,
    grid: ProofGrid,
) -> Connectivity {
    let ProofGrid { center, half, side, .. } = grid;
    let depth = if grid.shrunk { side * std::f64::consts::FRAC_1_SQRT_2 } else { 0.0 };
    let Some(shrunk) = space.hull().shrunk(depth) else { return Connectivity::Connected };
    let mut shrunk = space.with_hull(shrunk);
    let mut headings = FreeHeadings::new(&mut shrunk, center, half, side);
    // A proof needs the cells of the ends themselves; the shrunk hull is free there because the true hull is.
    let mut node = |pose| if grid.shrunk { headings.node_at(pose) } else { headings.node_near(pose) };
    let (Some(first), Some(last)) = (node(start), node(goal)) else {
        return Connectivity::Connected;
    };
    let mut floods =
        [Flood::new(first, headings.center(last.cell)), Flood::new(last, headings.center(first.cell))];
    let mut seen: Vec<u8> = Vec::new();
    let mut found = Vec::new();
    mark(&mut seen, first, 1);
    if mark(&mut seen, last, 2) {
        return Connectivity::Connected;
    }
    loop {
        let side = usize::from(floods[1].visited.len() < floods[0].visited.len());
        let Some(node) = floods[side].next() else {
            let (reached, to) = (&floods[side], if side == 0 { goal } else { start });
            return Connectivity::Disconnected { by: nearest_blocker(&mut headings, &reached.visited, to) };
        };
        if headings.space().work() >= grid.limit {
            return Connectivity::Connected;
        }
        headings.space().yield_point().await;
        headings.neighbours(node, &mut found);
        for &neighbour in &found {
            let mine = 1 + side as u8;
            match seen.get(neighbour.gap as usize).copied().unwrap_or(0) {
                0 => {
                    mark(&mut seen, neighbour, mine);
                    floods[side].add(neighbour, headings.center(neighbour.cell));
                }
                other if other != mine => return Connectivity::Connected,
                _ => {}
            }
        }
    }
}

/// Reached nodes in order, and nodes to expand: the nearest to the other end first, which connects regions early.
struct Flood {
    visited: Vec<Node>,
    open: BinaryHeap<Reverse<(u64, Node)>>,
    to: Vector2,
}

impl Flood {
    fn new(from: Node, to: Vector2) -> Self {
        Self { visited: vec![from], open: BinaryHeap::from([Reverse((0, from))]), to }
    }

    fn add(&mut self, node: Node, center: Vector2) {
        let micrometres = (center - self.to).norm() * 1e6;
        self.visited.push(node);
        self.open.push(Reverse((micrometres as u64, node)));
    }

    fn next(&mut self) -> Option<Node> {
        self.open.pop().map(|Reverse((_, node))| node)
    }
}

/// Marks a node; returns whether it was already marked.
fn mark(seen: &mut Vec<u8>, node: Node, by: u8) -> bool {
    if seen.len() <= node.gap as usize {
        seen.resize(node.gap as usize + 1, 0);
    }
    std::mem::replace(&mut seen[node.gap as usize], by) != 0
}

/// The obstacle that stops the reachable pose nearest to `to` from coming nearer.
fn nearest_blocker(headings: &mut FreeHeadings<'_, '_>, visited: &[Node], to: &Pose2) -> Option<Blocker> {
    let arm = headings.space().hull().outer_radius();
    let mut best: Option<(f64, Pose2)> = None;
    for &node in visited {
        let gap = headings.gap(node);
        let middle = gap.start + gap.length / 2.0;
        let ahead = wrap_angle(to.theta - middle).clamp(-gap.length / 2.0, gap.length / 2.0);
        let pose = Pose2::new(headings.center(node.cell).x, headings.center(node.cell).y, middle + ahead);
        let distance = pose.distance(to) + arm * wrap_angle(to.theta - pose.theta).abs();
        if best.is_none_or(|(min, _)| distance < min) {
            best = Some((distance, pose));
        }
    }
    let (_, pose) = best?;
    let step =
        (to.position() - pose.position()).try_normalize(1e-9).unwrap_or_default() * (1.5 * headings.side);
    let nearer = Pose2::new(pose.x + step.x, pose.y + step.y, pose.theta);
    let turn = headings.space().turn(&pose);
    let turned_by = if wrap_angle(to.theta - pose.theta) > 0.0 { turn.left_by } else { turn.right_by };
    headings.space().contact(&nearer).or(turned_by).or(turn.left_by).or(turn.right_by)
}
