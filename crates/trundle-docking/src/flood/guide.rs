use super::columns::{Columns, Node};
use crate::space::Space;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::TAU;
use trundle_collision::HeadingArc;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// How far each reachable pose is from the goal, by a rough count of seconds: a guide for a search, not a bound.
#[derive(Debug)]
pub struct Guide<'s, 'a> {
    columns: Columns<'s, 'a>,
    seconds: Vec<f32>,
}

/// Metres along the heading that a metre across it costs: there and back, at the angles a corridor leaves.
const ACROSS: f64 = 8.0;
/// Headings of a path keep this from the ends of what is free, rad.
const INSET: f64 = 0.05;

impl<'s, 'a> Guide<'s, 'a> {
    /// Floods from the goal over cells of `side` (m) within a square, at `speed` (m/s), farther than to `start` by `beyond` (s)
    /// and as many sixths of the way there as that is half seconds; no farther than [`Space::work`] comes to `limit`.
    pub async fn new(
        space: &'s mut Space<'a>,
        goal: &Pose2,
        center: Vector2,
        half: f64,
        side: f64,
        speed: f64,
        (start, beyond, limit): (&Pose2, f64, u64),
    ) -> Self {
        let mut guide = Self { columns: Columns::new(space, center, half, side), seconds: Vec::new() };
        let Some(from) = guide.columns.node_near(goal) else { return guide };
        let mut queue = BinaryHeap::from([Reverse((0_u64, from))]);
        guide.offer(from, 0.0);
        let mut found = Vec::new();
        let (end, mut far) = (guide.columns.node_near(start), u64::MAX);
        while let Some(Reverse((key, node))) = queue.pop() {
            if key > far || guide.columns.space().work() >= limit {
                break;
            }
            if Some(node) == end {
                far = key + (beyond * (key as f64 / 6.0 + 1e6)) as u64;
            }
            let so_far = f64::from(guide.seconds[node.gap as usize]);
            if (so_far * 1e6) as u64 != key {
                continue;
            }
            guide.columns.space().rest().await;
            guide.columns.neighbours(node, &mut found);
            for &next in &found {
                let total = so_far + guide.step(node, next) / speed;
                if guide.offer(next, total) {
                    let stored = f64::from(guide.seconds[next.gap as usize]);
                    queue.push(Reverse(((stored * 1e6) as u64, next)));
                }
            }
        }
        guide
    }

    /// Seconds from a pose; infinite when it is not known to hang together with the goal.
    pub fn seconds(&mut self, pose: &Pose2) -> f64 {
        let node = self.columns.node_near(pose);
        node.and_then(|n| self.seconds.get(n.gap as usize)).map_or(f64::INFINITY, |&s| f64::from(s))
    }

    /// Poses from `start` to the goal's cell, from cell to cell: turned first, then moved, sideways too; empty when they do
    /// not hang together.
    pub fn path(&mut self, start: &Pose2) -> Vec<Pose2> {
        let Some(mut node) = self.columns.node_near(start).filter(|_| self.seconds(start).is_finite()) else {
            return Vec::new();
        };
        let (mut poses, mut found) = (vec![*start], Vec::new());
        loop {
            self.columns.neighbours(node, &mut found);
            let known = |node: &Node| self.seconds.get(node.gap as usize).copied().unwrap_or(f32::INFINITY);
            let next = found.iter().min_by(|a, b| known(a).total_cmp(&known(b)));
            let Some(&next) = next.filter(|next| known(next) < known(&node)) else { return poses };
            let last = poses[poses.len() - 1];
            let heading = shared(self.columns.gap(node), self.columns.gap(next), last.theta);
            let (here, there) = (self.columns.center(node.cell), self.columns.center(next.cell));
            poses.extend([here, there].map(|p| Pose2::new(p.x, p.y, heading)));
            node = next;
        }
    }

    fn offer(&mut self, node: Node, seconds: f64) -> bool {
        let needed = self.columns.gaps_found().max(node.gap as usize + 1);
        if self.seconds.len() < needed {
            self.seconds.resize(needed, f32::INFINITY);
        }
        let better = (seconds as f32) < self.seconds[node.gap as usize];
        if better {
            self.seconds[node.gap as usize] = seconds as f32;
        }
        better
    }

    /// Metres along a heading that a step between two cells is worth.
    fn step(&self, from: Node, to: Node) -> f64 {
        let along = self.columns.center(to.cell) - self.columns.center(from.cell);
        let bearing = along.y.atan2(along.x);
        let gap = self.columns.gap(to);
        let middle = gap.start + gap.length / 2.0;
        // Forward or backward: the bearing counts modulo half a turn.
        let off = wrap_angle(2.0 * (bearing - middle)).abs() / 2.0 - gap.length / 2.0;
        self.columns.side * (1.0 + ACROSS * off.clamp(0.0, std::f64::consts::FRAC_PI_2).sin())
    }
}

/// The heading nearest to `heading` that lies in both gaps, and well within where there is room.
fn shared(a: HeadingArc, b: HeadingArc, heading: f64) -> f64 {
    let mut best = (f64::INFINITY, heading);
    let offset = (b.start - a.start).rem_euclid(TAU);
    // b may begin within a, or before it and reach over its beginning.
    for from in [offset, offset - TAU] {
        let (low, high) = (from.max(0.0), (from + b.length).min(a.length));
        if low > high {
            continue;
        }
        let inset = ((high - low) / 2.0).min(INSET);
        let (low, high) = (a.start + low + inset, a.start + high - inset);
        let middle = (low + high) / 2.0;
        let off = wrap_angle(heading - middle);
        let half = (high - low).max(0.0) / 2.0;
        let nearest = middle + off.clamp(-half, half);
        let turn = wrap_angle(nearest - heading).abs();
        if turn < best.0 {
            best = (turn, nearest);
        }
    }
    best.1
}
