//! Decisions of the method of \[Hong24\].

use crate::contact_space::ContactSpace;
use crate::hong24::config::Hong24Config;
use crate::motion::limits::MotionLimits;
use crate::motion::manoeuvre::Motion;
use trundle_core::{Pose2, wrap_angle};

/// The next step of the method.
#[derive(Debug, Clone, PartialEq)]
pub enum Decision {
    /// All three deviations are below their thresholds.
    Settled,
    /// Carry out these motions.
    Move(Vec<Motion>),
    /// No motion was found: move away, and start again.
    Recover(Motion),
    /// No motion was found, and no recovery move is free.
    Stuck,
}

/// Difference of two costs that counts as a tie. Clockwise then precedes counter-clockwise, and forward precedes back. Source: ours.
const COST_TIE: f64 = 1e-9;

/// The method with its obstacles.
#[derive(Debug, Clone, Copy)]
pub struct Hong24Method<'a> {
    /// Footprint and obstacles.
    pub space: &'a ContactSpace<'a>,
    /// Limits for the times of candidates.
    pub limits: MotionLimits,
    /// Weights, steps and thresholds.
    pub config: &'a Hong24Config,
}

impl Hong24Method<'_> {
    /// The next motions for a base at `pose`: lateral deviation first, then longitudinal, then angular. `recoveries` is the number of
    /// recovery moves so far: they alternate between back and forward. The result is stuck as well once the plan's work is used up.
    pub async fn decide(&self, pose: &Pose2, goal: &Pose2, recoveries: usize) -> Decision {
        let error = goal.inverse() * *pose;
        let found = if error.y.abs() > self.config.lateral_threshold {
            self.lateral(pose, goal).await
        } else if error.x.abs() > self.config.longitudinal_threshold {
            self.longitudinal(pose, goal).await
        } else if error.theta.abs() > self.config.angle_threshold {
            self.turn_to(pose, goal.theta).await.map(|turn| vec![Motion::Turn(turn)])
        } else {
            return Decision::Settled;
        };
        match found {
            _ if self.space.is_spent() => Decision::Stuck,
            Some(motions) => Decision::Move(motions),
            None => self.recover(pose, recoveries).await,
        }
    }

    /// The turn and the straight move of minimum cost.
    async fn lateral(&self, pose: &Pose2, goal: &Pose2) -> Option<Vec<Motion>> {
        let deviation = (goal.inverse() * *pose).y.abs();
        let mut best: Option<(f64, f64, f64)> = None;
        for turn in self.turns(pose).await {
            let turned = Pose2::new(pose.x, pose.y, pose.theta + turn);
            for sign in [1.0, -1.0] {
                let (distance, left) = self.min_lateral(&turned, goal, sign).await;
                if left >= deviation - self.config.lateral_threshold / 2.0 {
                    continue;
                }
                let time = self.limits.turn_time(turn) + self.limits.drive_time(distance);
                let cost = self.config.time_weight * time + self.config.lateral_weight * left;
                if best.is_none_or(|(min, _, _)| cost < min - COST_TIE) {
                    best = Some((cost, turn, distance));
                }
            }
        }
        best.map(|(_, turn, distance)| vec![Motion::Turn(turn), Motion::Drive(distance)])
    }

    /// Every sampled free turn, in each direction up to the first contact.
    async fn turns(&self, pose: &Pose2) -> Vec<f64> {
        let step = self.config.angle_step;
        let max = (std::f64::consts::PI / step).floor() as usize;
        let mut turns = vec![0.0];
        for sign in [-1.0, 1.0] {
            let turn = |i: usize| sign * i as f64 * step;
            let free = self.free_samples(max, |i| Motion::Turn(turn(i)).after(*pose, turn(i))).await;
            turns.extend((1..=free).map(turn));
        }
        turns
    }

    /// Point D of the straight AC: its distance (negative backward, m) and the remaining lateral deviation, m.
    async fn min_lateral(&self, from: &Pose2, goal: &Pose2, sign: f64) -> (f64, f64) {
        let samples = (self.config.reach / self.config.distance_step).floor() as usize;
        let mut best = (0.0, f64::INFINITY);
        for i in 1..=samples {
            let distance = sign * i as f64 * self.config.distance_step;
            let pose = Motion::Drive(distance).after(*from, distance);
            let left = (goal.inverse() * pose).y.abs();
            if left >= best.1 || !self.is_free(&pose).await {
                break;
            }
            best = (distance, left);
        }
        best
    }

    /// Turns to the goal's heading and drives the remaining distance along it, as far as free.
    async fn longitudinal(&self, pose: &Pose2, goal: &Pose2) -> Option<Vec<Motion>> {
        let turn = self.turn_to(pose, goal.theta).await?;
        let turned = Pose2::new(pose.x, pose.y, goal.theta);
        let distance = -(goal.inverse() * *pose).x;
        let samples = (distance.abs() / self.config.distance_step).ceil().max(1.0);
        let at = |i: usize| distance * i as f64 / samples;
        let free =
            self.free_samples(samples as usize, |i| Motion::Drive(distance).after(turned, at(i))).await;
        (at(free).abs() > self.config.longitudinal_threshold / 2.0)
            .then(|| vec![Motion::Turn(turn), Motion::Drive(at(free))])
    }

    /// The shorter turn to a heading, if every sample of it is free.
    async fn turn_to(&self, pose: &Pose2, heading: f64) -> Option<f64> {
        let turn = wrap_angle(heading - pose.theta);
        let samples = (turn.abs() / self.config.angle_step).ceil().max(1.0) as usize;
        let at = |i: usize| Motion::Turn(turn).after(*pose, turn * i as f64 / samples as f64);
        (self.free_samples(samples, at).await == samples).then_some(turn)
    }

    /// Back and forward in alternation.
    async fn recover(&self, pose: &Pose2, recoveries: usize) -> Decision {
        let first = if recoveries.is_multiple_of(2) { -1.0 } else { 1.0 };
        for sign in [first, -first] {
            let samples = (self.config.recovery / self.config.distance_step).floor().max(1.0) as usize;
            let at = |i: usize| sign * self.config.recovery * i as f64 / samples as f64;
            let free = self.free_samples(samples, |i| Motion::Drive(at(i)).after(*pose, at(i))).await;
            if free > 0 {
                return Decision::Recover(Motion::Drive(at(free)));
            }
        }
        Decision::Stuck
    }

    /// Number of free samples, from the first to `count`, before one that is not free.
    async fn free_samples(&self, count: usize, at: impl Fn(usize) -> Pose2) -> usize {
        let mut free = 0;
        while free < count && self.is_free(&at(free + 1)).await {
            free += 1;
        }
        free
    }

    /// No pose is free once the plan's work is used up.
    async fn is_free(&self, pose: &Pose2) -> bool {
        self.space.yield_point().await;
        !self.space.is_spent() && self.space.contact(pose).is_none()
    }
}
