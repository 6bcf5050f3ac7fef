//! The baselines in the same small world as the positioner: noise on the pose, wheels that lag.

use crate::dynamic_window::{DT as WINDOW_DT, DynamicWindow, is_near, kept};
use crate::hybrid::{PathPiece, plan, roll};
use crate::world::{DT, Run, World};
use trundle_core::{Pose2, Twist2, wrap_angle};
use trundle_docking::corridor::Problem;
use trundle_docking::{MotionLimits, ObstacleScene};

/// The dynamic window gives up after this, s. Source: ours.
const PATIENCE: f64 = 60.0;
/// The dynamic window also gives up when it has come no nearer for this time, s. Source: ours.
const STUCK: f64 = 10.0;
/// The path planner plans again so often, when the end is beside the goal. Source: ours.
const PLANS: usize = 6;

/// A world, and what is noted in it.
struct Race<'a> {
    problem: &'a Problem,
    scene: &'a ObstacleScene,
    world: World,
    time: f64,
    contact: bool,
}

impl<'a> Race<'a> {
    fn new(problem: &'a Problem, scene: &'a ObstacleScene, seed: u64) -> Self {
        Self { problem, scene, world: World::new(problem.start, seed), time: 0.0, contact: false }
    }

    fn advance(&mut self, twist: Twist2) {
        self.world.advance(twist);
        self.time += DT;
        self.contact |= is_near(&self.problem.footprint, self.scene, &self.world.pose, 0.0);
    }

    /// Stands for `seconds` and averages the pose.
    fn measure(&mut self, seconds: f64) -> Pose2 {
        let (mut sum, mut count, first) = ((0.0, 0.0, 0.0), 0.0, self.world.measured());
        for i in 0..(seconds / DT) as usize {
            self.advance(Twist2::ZERO);
            if i as f64 * DT >= 0.2 * seconds {
                let pose = self.world.measured();
                sum = (sum.0 + pose.x, sum.1 + pose.y, sum.2 + wrap_angle(pose.theta - first.theta));
                count += 1.0;
            }
        }
        Pose2::new(sum.0 / count, sum.1 / count, first.theta + sum.2 / count)
    }

    fn is_there(&self, pose: &Pose2) -> bool {
        let error = self.problem.goal.inverse() * *pose;
        error.position().norm() <= 0.009 && error.theta.abs() <= 0.9_f64.to_radians()
    }

    fn end(self, settled: bool) -> Run {
        let error = self.problem.goal.inverse() * self.world.pose;
        let within = error.position().norm() <= 0.01 && error.theta.abs() <= 1_f64.to_radians();
        Run { settled, within, contact: self.contact, motions: 0, time: self.time }
    }
}

/// The dynamic window, ten times per second.
pub fn by_window(problem: &Problem, scene: &ObstacleScene, seed: u64) -> Run {
    let mut race = Race::new(problem, scene, seed);
    let limits = MotionLimits::default();
    let mut window = DynamicWindow { problem, scene, limits, last: Twist2::ZERO, turning: false, kept: 0.0 };
    let (mut best, mut since) = (f64::INFINITY, 0.0);
    while race.time < PATIENCE && race.time - since < STUCK {
        let pose = race.world.measured();
        let error = problem.goal.inverse() * pose;
        let left = error.position().norm() + 0.1 * error.theta.abs();
        if left < best - 0.005 {
            (best, since) = (left, race.time);
        }
        if race.is_there(&pose) && window.last.v.abs() + window.last.omega.abs() < 0.05 {
            window.last = Twist2::ZERO;
            let pose = race.measure(0.4);
            if race.is_there(&pose) {
                return race.end(true);
            }
        }
        let twist = window.command(&pose);
        for _ in 0..(WINDOW_DT / DT).round() as usize {
            race.advance(twist);
        }
    }
    race.end(false)
}

/// Hybrid A* with Reeds-Shepp words, followed by a plain tracking law, planned again when the end is beside the goal.
pub fn by_hybrid(problem: &Problem, scene: &ObstacleScene, seed: u64) -> Run {
    let mut race = Race::new(problem, scene, seed);
    for _ in 0..PLANS {
        let start = race.measure(0.4);
        if race.is_there(&start) {
            return race.end(true);
        }
        let from_here = Problem { start, ..problem.clone() };
        let room =
            kept(&problem.footprint, scene, &start).min(kept(&problem.footprint, scene, &problem.goal));
        let Some(pieces) = plan(&from_here, scene, &MotionLimits::default(), room) else {
            return race.end(false);
        };
        follow(&mut race, start, &pieces);
    }
    let pose = race.measure(0.4);
    let there = race.is_there(&pose);
    race.end(there)
}

/// Every piece from rest to rest.
fn follow(race: &mut Race<'_>, mut from: Pose2, pieces: &[PathPiece]) {
    let limits = MotionLimits::default();
    let mut last = 0.0;
    for &(curvature, distance) in pieces {
        if last * distance < 0.0 {
            for _ in 0..(limits.switch_time / DT) as usize {
                race.advance(Twist2::ZERO);
            }
        }
        last = distance;
        let total = limits.drive_time(distance);
        for i in 0..=(total / DT) as usize {
            let (done, speed) = limits.drive_at(distance, i as f64 * DT);
            let error = race.world.measured().inverse() * roll(&from, curvature, done);
            // Kanayama's law, gently: the pose is noisy.
            let omega = speed * curvature + 8.0 * speed * error.y + 1.5 * error.theta;
            race.advance(Twist2::new(speed + error.x, omega));
        }
        from = roll(&from, curvature, distance);
    }
}
