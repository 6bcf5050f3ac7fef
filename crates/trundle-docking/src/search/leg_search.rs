//! The search for legs onto the goal.

use crate::contact_space::ContactSpace;
use crate::legs::leg_sequence::Legs;
use crate::legs::query::DockingQuery;
use crate::motion::manoeuvre::Motion;
use crate::search::rays::{Ray, rays};
use trundle_core::{Pose2, Vector2, wrap_angle};

/// The state of a search for legs.
#[derive(Debug)]
pub struct LegSearch<'s, 'a> {
    /// Start, goal and limits.
    pub query: DockingQuery,
    /// Footprint and obstacles.
    pub space: &'s mut ContactSpace<'a>,
    /// Headings from which the goal's own is a free turn away.
    pub goal_rays: Vec<Ray>,
    /// The best legs so far and their time, s.
    pub best: Option<(f64, Legs)>,
    /// Value of [`ContactSpace::work`] at which the search ends.
    pub limit: u64,
    tails: Vec<Tail>,
}

/// One or two legs from a node to the goal.
#[derive(Debug, Clone, Copy)]
struct Tail {
    /// Time of the legs before, with all pauses, s.
    spent: f64,
    time: f64,
    first: (f64, f64),
    second: Option<(f64, f64)>,
}

/// Largest number of tails of one node that are tested for contact. Source: ours.
const MAX_TESTED_TAILS: usize = 40;
/// Largest number of tails tested at the start, the origin of all manoeuvres of two legs. Source: ours.
const MAX_TESTED_TAILS_AT_START: usize = 2000;

impl<'s, 'a> LegSearch<'s, 'a> {
    /// A search that samples the goal's headings `count` times, not finer than `finest` (rad), until [`ContactSpace::work`] reaches `limit`.
    pub async fn new(
        query: DockingQuery,
        space: &'s mut ContactSpace<'a>,
        (count, finest): (usize, f64),
        limit: u64,
    ) -> Self {
        let mut goal_rays = Vec::new();
        rays(&query, space, &query.goal, count, finest, &mut goal_rays).await;
        Self { query, space, goal_rays, best: None, limit, tails: Vec::new() }
    }

    /// Whether the work has reached the limit.
    pub fn is_spent(&self) -> bool {
        self.space.work() >= self.limit
    }

    /// The time to beat, s.
    pub fn time_to_beat(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |(time, _)| *time)
    }

    /// Searches the best completion to the goal by one or two legs from a base at `pose` with these `rays`. `prefix` are the preceding
    /// legs, `spent` their time with all pauses, s. Returns whether a better one was found.
    pub async fn complete(&mut self, pose: &Pose2, rays: &[Ray], prefix: &[(f64, f64)], spent: f64) -> bool {
        self.tails.clear();
        self.collect_straight(pose, spent);
        self.collect_pairs(pose, rays, spent);
        self.tails.sort_unstable_by(|a, b| a.time.total_cmp(&b.time));
        let before = self.time_to_beat();
        let max = if prefix.is_empty() { MAX_TESTED_TAILS_AT_START } else { MAX_TESTED_TAILS };
        for i in 0..self.tails.len().min(max) {
            self.space.yield_point().await;
            let tail = self.tails[i];
            if tail.time >= self.time_to_beat() || self.is_spent() {
                break;
            }
            if self.tested(pose, &tail).is_none_or(|time| time >= self.time_to_beat()) {
                continue;
            }
            let legs = Legs(prefix.iter().copied().chain([tail.first]).chain(tail.second).collect());
            if let Some((time, _)) = legs.motions(&self.query, self.space)
                && time < self.time_to_beat()
            {
                self.best = Some((time, legs));
            }
        }
        self.time_to_beat() < before
    }

    /// The true time of a tail, if the tail is free. For a pair, only the turn in between is untested.
    fn tested(&mut self, pose: &Pose2, tail: &Tail) -> Option<f64> {
        let (heading, distance) = tail.first;
        let Some((next, _)) = tail.second else {
            let query = DockingQuery { start: *pose, ..self.query };
            let (time, _) = Legs(vec![tail.first]).motions(&query, self.space)?;
            return Some(time + tail.spent);
        };
        let corner = Motion::Drive(distance).after(Pose2 { theta: heading, ..*pose }, distance);
        let turn = wrap_angle(next - heading);
        let taken = self.space.turn(&corner).turn_by(turn)?;
        Some(tail.time + self.query.turn_cost(taken) - self.query.turn_cost(turn))
    }

    /// Straight to the goal, forward or backward.
    fn collect_straight(&mut self, pose: &Pose2, spent: f64) {
        let rest = self.query.goal.position() - pose.position();
        let distance = rest.norm();
        let toward = if distance > 1e-9 { rest.y.atan2(rest.x) } else { pose.theta };
        for (heading, distance) in
            [(toward, distance), (wrap_angle(toward + std::f64::consts::PI), -distance)]
        {
            let turns = self.query.turn_cost(wrap_angle(heading - pose.theta))
                + self.query.turn_cost(wrap_angle(self.query.goal.theta - heading));
            let time = spent + turns + self.query.drive_cost(distance) - self.query.limits.switch_time;
            self.tails.push(Tail { spent, time, first: (heading, distance), second: None });
        }
    }

    /// Every pair of a heading here and a heading at the goal whose legs meet, when both legs are free.
    fn collect_pairs(&mut self, pose: &Pose2, rays: &[Ray], spent: f64) {
        self.space.spend(rays.len() as u64 * self.goal_rays.len() as u64);
        let rest = self.query.goal.position() - pose.position();
        let to_beat = self.time_to_beat();
        let query = self.query;
        for ray in rays {
            for goal_ray in &self.goal_rays {
                let cheap = spent + ray.cost + goal_ray.cost + query.limits.switch_time;
                let cross = ray.direction.perp(&goal_ray.direction);
                if cheap >= to_beat || cross.abs() < 1e-3 {
                    continue;
                }
                let first = rest.perp(&goal_ray.direction) / cross;
                let second = ray.direction.perp(&rest) / cross;
                let free = first <= ray.ahead
                    && -first <= ray.behind
                    && -second <= goal_ray.ahead
                    && second <= goal_ray.behind;
                if !free || first.abs() < 1e-4 || second.abs() < 1e-4 {
                    continue;
                }
                let turn = wrap_angle(goal_ray.heading - ray.heading);
                let time = cheap
                    + query.turn_cost(turn)
                    + query.limits.drive_time(first)
                    + query.limits.drive_time(second);
                let corner = pose.position() + ray.direction * first;
                if time < to_beat && query.in_region(corner) {
                    let second = Some((goal_ray.heading, second));
                    self.tails.push(Tail { spent, time, first: (ray.heading, first), second });
                }
            }
        }
    }

    /// Estimated time from rest at `pose` to the goal, s: the best of a few pairs of legs, with contacts of the last leg only.
    pub fn estimate(&self, pose: &Pose2) -> f64 {
        let rest = self.query.goal.position() - pose.position();
        let query = &self.query;
        let step = (self.goal_rays.len() / 8).max(1);
        let mut min = f64::INFINITY;
        let lean = 0.35;
        for turn in [0.0, wrap_angle(query.goal.theta - pose.theta), lean, -lean] {
            let heading = pose.theta + turn;
            let direction = Vector2::new(heading.cos(), heading.sin());
            let before = query.turn_cost(turn);
            for goal_ray in self.goal_rays.iter().step_by(step) {
                let cross = direction.perp(&goal_ray.direction);
                if cross.abs() < 1e-3 {
                    continue;
                }
                let first = rest.perp(&goal_ray.direction) / cross;
                let second = direction.perp(&rest) / cross;
                if second > goal_ray.behind || -second > goal_ray.ahead {
                    continue;
                }
                let between = query.turn_cost(wrap_angle(goal_ray.heading - heading));
                let distances = query.drive_cost(first) + query.drive_cost(second);
                min = min.min(before + between + goal_ray.cost + distances);
            }
        }
        if min.is_finite() { min } else { 20.0 + rest.norm() }
    }
}
