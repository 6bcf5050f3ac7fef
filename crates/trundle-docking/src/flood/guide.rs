use super::columns::{Columns, Node};
use crate::space::Space;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// How far each reachable pose is from the goal, by a rough count of seconds: a guide for a search, not a bound.
#[derive(Debug)]
pub struct Guide<'s, 'a> {
    columns: Columns<'s, 'a>,
    seconds: Vec<f32>,
}

/// Metres along the heading that a metre across it costs: there and back, at the angles a corridor leaves.
const ACROSS: f64 = 8.0;

impl<'s, 'a> Guide<'s, 'a> {
    /// Floods from the goal over cells of `side` (m) within a square, at `speed` (m/s).
    pub fn new(
        space: &'s mut Space<'a>,
        goal: &Pose2,
        center: Vector2,
        half: f64,
        side: f64,
        speed: f64,
    ) -> Self {
        let mut guide = Self { columns: Columns::new(space, center, half, side), seconds: Vec::new() };
        let Some(from) = guide.columns.node_at(goal) else { return guide };
        let mut queue = BinaryHeap::from([Reverse((0_u64, from))]);
        guide.offer(from, 0.0);
        let mut found = Vec::new();
        while let Some(Reverse((key, node))) = queue.pop() {
            let so_far = f64::from(guide.seconds[node.gap as usize]);
            if (so_far * 1e6) as u64 != key {
                continue;
            }
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
        let node = self.columns.node_at(pose);
        node.and_then(|n| self.seconds.get(n.gap as usize)).map_or(f64::INFINITY, |&s| f64::from(s))
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
