//! Estimated time to the goal over connected poses.

use crate::connectivity_proof::free_headings::{FreeHeadings, Node};
use crate::contact_space::ContactSpace;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::TAU;
use trundle_collision::HeadingArc;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// Estimated time from each connected pose to the goal, s: a heuristic of the search, not a bound.
#[derive(Debug)]
pub struct TimeEstimate<'s, 'a> {
    headings: FreeHeadings<'s, 'a>,
    seconds: Vec<f32>,
}

/// Cost of a metre across the heading, in metres along it: back and forth, at the angles that a corridor leaves. Source: ours.
const SIDEWAYS_COST: f64 = 8.0;
/// Distance of a path's headings from the ends of the free headings, rad. Source: ours.
const HEADING_INSET_RAD: f64 = 0.05;

impl<'s, 'a> TimeEstimate<'s, 'a> {
    /// Searches from the goal over cells of `side` (m) within a square, at `speed` (m/s). The search covers the start and `beyond` (s)
    /// more, plus as many sixths of the time to the start as that is half seconds. It ends when [`ContactSpace::work`] reaches `limit`.
    pub async fn new(
        space: &'s mut ContactSpace<'a>,
        goal: &Pose2,
        center: Vector2,
        half: f64,
        side: f64,
        speed: f64,
        (start, beyond, limit): (&Pose2, f64, u64),
    ) -> Self {
        let mut estimate =
            Self { headings: FreeHeadings::new(space, center, half, side), seconds: Vec::new() };
        let Some(from) = estimate.headings.node_near(goal) else { return estimate };
        let mut queue = BinaryHeap::from([Reverse((0_u64, from))]);
        estimate.offer(from, 0.0);
        let mut found = Vec::new();
        let (end, mut far) = (estimate.headings.node_near(start), u64::MAX);
        while let Some(Reverse((key, node))) = queue.pop() {
            if key > far || estimate.headings.space().work() >= limit {
                break;
            }
            if Some(node) == end {
                far = key + (beyond * (key as f64 / 6.0 + 1e6)) as u64;
            }
            let so_far = f64::from(estimate.seconds[node.gap as usize]);
            if (so_far * 1e6) as u64 != key {
                continue;
            }
            estimate.headings.space().yield_point().await;
            estimate.headings.neighbours(node, &mut found);
            for &next in &found {
                let total = so_far + estimate.step(node, next) / speed;
                if estimate.offer(next, total) {
                    let stored = f64::from(estimate.seconds[next.gap as usize]);
                    queue.push(Reverse(((stored * 1e6) as u64, next)));
                }
            }
        }
        estimate
    }

    /// Estimated time from a pose, s; infinite without a known connection to the goal.
    pub fn seconds(&mut self, pose: &Pose2) -> f64 {
        let node = self.headings.node_near(pose);
        node.and_then(|n| self.seconds.get(n.gap as usize)).map_or(f64::INFINITY, |&s| f64::from(s))
    }

    /// Poses from `start` to the goal's cell, from cell to cell: turned first, then moved, sideways too; empty when they are not
    /// connected.
    pub fn path(&mut self, start: &Pose2) -> Vec<Pose2> {
        let Some(mut node) = self.headings.node_near(start).filter(|_| self.seconds(start).is_finite())
        else {
            return Vec::new();
        };
        let (mut poses, mut found) = (vec![*start], Vec::new());
        loop {
            self.headings.neighbours(node, &mut found);
            let known = |node: &Node| self.seconds.get(node.gap as usize).copied().unwrap_or(f32::INFINITY);
            let next = found.iter().min_by(|a, b| known(a).total_cmp(&known(b)));
            let Some(&next) = next.filter(|next| known(next) < known(&node)) else { return poses };
            let last = poses[poses.len() - 1];
            let heading = shared(self.headings.gap(node), self.headings.gap(next), last.theta);
            let (here, there) = (self.headings.center(node.cell), self.headings.center(next.cell));
            poses.extend([here, there].map(|p| Pose2::new(p.x, p.y, heading)));
            node = next;
        }
    }

    fn offer(&mut self, node: Node, seconds: f64) -> bool {
        let needed = self.headings.gaps_found().max(node.gap as usize + 1);
        if self.seconds.len() < needed {
            self.seconds.resize(needed, f32::INFINITY);
        }
        let better = (seconds as f32) < self.seconds[node.gap as usize];
        if better {
            self.seconds[node.gap as usize] = seconds as f32;
        }
        better
    }

    /// Cost of a step between two cells, in metres along a heading.
    fn step(&self, from: Node, to: Node) -> f64 {
        let along = self.headings.center(to.cell) - self.headings.center(from.cell);
        let bearing = along.y.atan2(along.x);
        let gap = self.headings.gap(to);
        let middle = gap.start + gap.length / 2.0;
        // Forward or backward: the bearing counts modulo half a turn.
        let off = wrap_angle(2.0 * (bearing - middle)).abs() / 2.0 - gap.length / 2.0;
        self.headings.side * (1.0 + SIDEWAYS_COST * off.clamp(0.0, std::f64::consts::FRAC_PI_2).sin())
    }
}

/// The heading nearest to `heading` inside both gaps, away from their ends if space allows.
fn shared(a: HeadingArc, b: HeadingArc, heading: f64) -> f64 {
    let mut best = (f64::INFINITY, heading);
    let offset = (b.start - a.start).rem_euclid(TAU);
    // b may begin within a, or before it and extend over its start.
    for from in [offset, offset - TAU] {
        let (low, high) = (from.max(0.0), (from + b.length).min(a.length));
        if low > high {
            continue;
        }
        let inset = ((high - low) / 2.0).min(HEADING_INSET_RAD);
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
