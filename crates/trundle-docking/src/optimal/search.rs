use super::legs::Legs;
use super::rays::{Ray, rays};
use super::task::Task;
use crate::manoeuvre::Motion;
use crate::space::Space;
use trundle_core::{Pose2, Vector2, wrap_angle};

/// The search for legs: what it knows while it runs.
#[derive(Debug)]
pub struct Search<'s, 'a> {
    /// From where to where.
    pub task: Task,
    /// Footprint and obstacles.
    pub space: &'s mut Space<'a>,
    /// Headings from which the goal's own is a free turn away.
    pub goal_rays: Vec<Ray>,
    /// The best legs so far and their time, s.
    pub best: Option<(f64, Legs)>,
    /// It ends when [`Space::work`] comes to this.
    pub limit: u64,
    tails: Vec<Tail>,
}

/// One or two legs from a node to the goal.
#[derive(Debug, Clone, Copy)]
struct Tail {
    /// Of the legs before, with all pauses, s.
    spent: f64,
    time: f64,
    first: (f64, f64),
    second: Option<(f64, f64)>,
}

/// Tails of one node that are tested for contact at most.
const MOST_TESTS: usize = 40;
/// The same for the start, where all manoeuvres of two legs come from.
const MOST_TESTS_AT_START: usize = 2000;

impl<'s, 'a> Search<'s, 'a> {
    /// A search that samples the goal's headings `count` times, not finer than `finest` (rad), until [`Space::work`] comes to
    /// `limit`.
    pub async fn new(
        task: Task,
        space: &'s mut Space<'a>,
        (count, finest): (usize, f64),
        limit: u64,
    ) -> Self {
        let mut goal_rays = Vec::new();
        rays(&task, space, &task.goal, count, finest, &mut goal_rays).await;
        Self { task, space, goal_rays, best: None, limit, tails: Vec::new() }
    }

    /// Whether it has cost as much as it may.
    pub fn is_spent(&self) -> bool {
        self.space.work() >= self.limit
    }

    /// The time to beat, s.
    pub fn time_to_beat(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |(time, _)| *time)
    }

    /// Looks for the best way to the goal by one or two legs from a base at `pose`, whose `rays` are given. `prefix` are the
    /// legs that led there, `spent` their time with all pauses, s. Whether one was found that is better than all before.
    pub async fn complete(&mut self, pose: &Pose2, rays: &[Ray], prefix: &[(f64, f64)], spent: f64) -> bool {
        self.tails.clear();
        self.collect_straight(pose, spent);
        self.collect_pairs(pose, rays, spent);
        self.tails.sort_unstable_by(|a, b| a.time.total_cmp(&b.time));
        let before = self.time_to_beat();
        let most = if prefix.is_empty() { MOST_TESTS_AT_START } else { MOST_TESTS };
        for i in 0..self.tails.len().min(most) {
            self.space.rest().await;
            let tail = self.tails[i];
            if tail.time >= self.time_to_beat() || self.is_spent() {
                break;
            }
            if self.tested(pose, &tail).is_none_or(|time| time >= self.time_to_beat()) {
                continue;
            }
            let legs = Legs(prefix.iter().copied().chain([tail.first]).chain(tail.second).collect());
            if let Some((time, _)) = legs.motions(&self.task, self.space)
                && time < self.time_to_beat()
            {
                self.best = Some((time, legs));
            }
        }
        self.time_to_beat() < before
    }

    /// The true time of a tail, when it is free. Of a pair only the turn between is still unknown.
    fn tested(&mut self, pose: &Pose2, tail: &Tail) -> Option<f64> {
        let (heading, way) = tail.first;
        let Some((next, _)) = tail.second else {
            let task = Task { start: *pose, ..self.task };
            let (time, _) = Legs(vec![tail.first]).motions(&task, self.space)?;
            return Some(time + tail.spent);
        };
        let corner = Motion::Drive(way).after(Pose2 { theta: heading, ..*pose }, way);
        let turn = wrap_angle(next - heading);
        let taken = self.space.turn(&corner).way(turn)?;
        Some(tail.time + self.task.turn_cost(taken) - self.task.turn_cost(turn))
    }

    /// Straight to the goal, forward or backward.
    fn collect_straight(&mut self, pose: &Pose2, spent: f64) {
        let rest = self.task.goal.position() - pose.position();
        let way = rest.norm();
        let toward = if way > 1e-9 { rest.y.atan2(rest.x) } else { pose.theta };
        for (heading, way) in [(toward, way), (wrap_angle(toward + std::f64::consts::PI), -way)] {
            let turns = self.task.turn_cost(wrap_angle(heading - pose.theta))
                + self.task.turn_cost(wrap_angle(self.task.goal.theta - heading));
            let time = spent + turns + self.task.drive_cost(way) - self.task.limits.switch_time;
            self.tails.push(Tail { spent, time, first: (heading, way), second: None });
        }
    }

    /// Every pair of a heading here and a heading at the goal whose legs meet, when both legs are free.
    fn collect_pairs(&mut self, pose: &Pose2, rays: &[Ray], spent: f64) {
        self.space.spend(rays.len() as u64 * self.goal_rays.len() as u64);
        let rest = self.task.goal.position() - pose.position();
        let to_beat = self.time_to_beat();
        let task = self.task;
        for ray in rays {
            for goal_ray in &self.goal_rays {
                let cheap = spent + ray.cost + goal_ray.cost + task.limits.switch_time;
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
                    + task.turn_cost(turn)
                    + task.limits.drive_time(first)
                    + task.limits.drive_time(second);
                let corner = pose.position() + ray.direction * first;
                if time < to_beat && task.in_region(corner) {
                    let second = Some((goal_ray.heading, second));
                    self.tails.push(Tail { spent, time, first: (ray.heading, first), second });
                }
            }
        }
    }

    /// An estimate of the time from a base at rest at `pose` to the goal, s: the best of a few pairs of legs, no contact
    /// considered but of the last leg.
    pub fn estimate(&self, pose: &Pose2) -> f64 {
        let rest = self.task.goal.position() - pose.position();
        let task = &self.task;
        let step = (self.goal_rays.len() / 8).max(1);
        let mut least = f64::INFINITY;
        let lean = 0.35;
        for turn in [0.0, wrap_angle(task.goal.theta - pose.theta), lean, -lean] {
            let heading = pose.theta + turn;
            let direction = Vector2::new(heading.cos(), heading.sin());
            let before = task.turn_cost(turn);
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
                let between = task.turn_cost(wrap_angle(goal_ray.heading - heading));
                let ways = task.drive_cost(first) + task.drive_cost(second);
                least = least.min(before + between + goal_ray.cost + ways);
            }
        }
        if least.is_finite() { least } else { 20.0 + rest.norm() }
    }
}
