use super::columns::{Columns, Node};
use crate::scene::Blocker;
use crate::space::Space;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// What a flood over cells shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Proof {
    /// Start and goal do not hang together: no motion of any kind leads from one to the other.
    Apart {
        /// What stands in the way where the reachable poses come nearest to the other end.
        by: Option<Blocker>,
    },
    /// They hang together, as far as cells of this side, or the work allowed, can tell.
    Together,
}

/// Where to flood.
#[derive(Debug, Clone, Copy)]
pub struct Ground {
    /// Middle of the square.
    pub center: Vector2,
    /// Half its side, m.
    pub half: f64,
    /// Side of a cell, m.
    pub side: f64,
    /// Whether the hull is shrunk by a cell's half diagonal, for a proof; or taken as it is at the cells' middles, for what
    /// can be done at this resolution.
    pub shrunk: bool,
    /// It ends without a proof when [`Space::work`] comes to this.
    pub limit: u64,
}

/// Floods from both ends; the smaller flood goes on.
pub async fn disprove(space: &Space<'_>, start: &Pose2, goal: &Pose2, ground: Ground) -> Proof {
    let Ground { center, half, side, .. } = ground;
    let depth = if ground.shrunk { side * std::f64::consts::FRAC_1_SQRT_2 } else { 0.0 };
    let Some(shrunk) = space.hull().shrunk(depth) else { return Proof::Together };
    let mut shrunk = space.with_hull(shrunk);
    let mut columns = Columns::new(&mut shrunk, center, half, side);
    // A proof needs the very cells of the ends; there the shrunk hull is free because the true one is.
    let mut node = |pose| if ground.shrunk { columns.node_at(pose) } else { columns.node_near(pose) };
    let (Some(first), Some(last)) = (node(start), node(goal)) else {
        return Proof::Together;
    };
    let mut floods =
        [Flood::new(first, columns.center(last.cell)), Flood::new(last, columns.center(first.cell))];
    let mut seen: Vec<u8> = Vec::new();
    let mut found = Vec::new();
    mark(&mut seen, first, 1);
    if mark(&mut seen, last, 2) {
        return Proof::Together;
    }
    loop {
        let side = usize::from(floods[1].visited.len() < floods[0].visited.len());
        let Some(node) = floods[side].next() else {
            let (flood, to) = (&floods[side], if side == 0 { goal } else { start });
            return Proof::Apart { by: nearest_blocker(&mut columns, &flood.visited, to) };
        };
        if columns.space().work() >= ground.limit {
            return Proof::Together;
        }
        columns.space().rest().await;
        columns.neighbours(node, &mut found);
        for &neighbour in &found {
            let mine = 1 + side as u8;
            match seen.get(neighbour.gap as usize).copied().unwrap_or(0) {
                0 => {
                    mark(&mut seen, neighbour, mine);
                    floods[side].add(neighbour, columns.center(neighbour.cell));
                }
                other if other != mine => return Proof::Together,
                _ => {}
            }
        }
    }
}

/// Nodes in the order they were met, and those to go on from: the nearest to the other end first, so that floods that meet
/// meet soon.
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

/// Marks a node; whether it was marked before.
fn mark(seen: &mut Vec<u8>, node: Node, by: u8) -> bool {
    if seen.len() <= node.gap as usize {
        seen.resize(node.gap as usize + 1, 0);
    }
    std::mem::replace(&mut seen[node.gap as usize], by) != 0
}

/// What stops the reachable pose that is nearest to `to` from coming nearer.
fn nearest_blocker(columns: &mut Columns<'_, '_>, visited: &[Node], to: &Pose2) -> Option<Blocker> {
    let arm = columns.space().hull().outer_radius();
    let mut best: Option<(f64, Pose2)> = None;
    for &node in visited {
        let gap = columns.gap(node);
        let middle = gap.start + gap.length / 2.0;
        let ahead = wrap_angle(to.theta - middle).clamp(-gap.length / 2.0, gap.length / 2.0);
        let pose = Pose2::new(columns.center(node.cell).x, columns.center(node.cell).y, middle + ahead);
        let distance = pose.distance(to) + arm * wrap_angle(to.theta - pose.theta).abs();
        if best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, pose));
        }
    }
    let (_, pose) = best?;
    let step =
        (to.position() - pose.position()).try_normalize(1e-9).unwrap_or_default() * (1.5 * columns.side);
    let nearer = Pose2::new(pose.x + step.x, pose.y + step.y, pose.theta);
    let turn = columns.space().turn(&pose);
    let turned_by = if wrap_angle(to.theta - pose.theta) > 0.0 { turn.left_by } else { turn.right_by };
    columns.space().contact(&nearer).or(turned_by).or(turn.left_by).or(turn.right_by)
}
