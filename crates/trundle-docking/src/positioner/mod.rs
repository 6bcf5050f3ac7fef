//! Closed loop: plan, carry out one motion, stand still and measure, decide again.
//!
//! Problem: poses are measured with noise and wheels lag, so that a manoeuvre carried out blindly ends beside its goal, and
//! one corrected without end hunts. Idea: after every motion the pose is averaged at rest and the rest is planned anew; where
//! one or two motions end within the tolerance, these are taken instead of an exact manoeuvre; what is settled stays settled
//! until an error exceeds the tolerance by far. A search in parts has a pose and obstacles of its beginning: who is pushed
//! meanwhile begins anew, and what came of it is looked at once more among what stands around at its end. By the paper's method the pair that it decided on is carried out, a turn and
//! a straight, before it decides again. Every step looks along the motion for the stopping way; when something is
//! there, the command is zero at once. Cost: one plan a motion, in parts of so much a step, one closed-form query a step.

mod average;
mod config;
mod follow;
mod nearly;
mod next;
mod search;

pub use config::PositionerConfig;

use crate::config::DockingConfig;
use crate::manoeuvre::{Manoeuvre, Motion};
use crate::plan::Refusal;
use crate::planner::Docker;
use crate::scene::{Blocker, Scene};
use crate::space::Space;
use average::PoseAverage;
use follow::{Command, Following};
use nalgebra::Matrix3;
use nearly::Tolerance;
use next::Next;
use search::Search;
use trundle_core::{Footprint, Invalid, Pose2, Stamp, Twist2};

/// What the positioner is told at every step.
#[derive(Debug, Clone, Copy)]
pub struct PositionerInput<'a> {
    /// Now.
    pub stamp: Stamp,
    /// The measured `map_from_base`.
    pub pose: Pose2,
    /// Its covariance, (x m, y m, heading rad), right perturbation: the margin follows from it.
    pub covariance: Matrix3<f64>,
    /// What stands around now, map frame.
    pub scene: &'a Scene,
}

/// Why the twist is what it is.
#[derive(Debug, Clone, PartialEq)]
pub enum Reason {
    /// At rest, averaging the pose.
    Measuring,
    /// At rest, planning: as much of it a step as [`PositionerConfig::step_work`] grants.
    Planning,
    /// Carrying out a motion.
    Moving(Motion),
    /// On the goal, within tolerance.
    Settled,
    /// Something is in the way of the motion, or of a plan that was ready: stopped, and planning anew from here.
    Obstacle(Blocker),
    /// There is no manoeuvre; trying again after a while.
    NoWay(Option<Blocker>),
    /// Nothing can be planned; trying again after a while.
    Refused(Refusal),
    /// The pose is not a number.
    BadPose,
}

/// What a step says.
#[derive(Debug, Clone, PartialEq)]
pub struct PositionerReport {
    /// For the base, now.
    pub twist: Twist2,
    /// Why.
    pub reason: Reason,
    /// `goal_from_base`: the error, of the averaged pose while at rest.
    pub error: Pose2,
}

#[derive(Debug)]
enum Phase {
    Measure { since: Stamp, average: PoseAverage },
    Plan { search: Search, pose: Pose2 },
    Follow(Following),
    Wait { until: Stamp, reason: Reason },
    Settled,
}

/// Brings a robot onto a goal and keeps it there.
#[derive(Debug)]
pub struct Positioner {
    docker: Docker,
    config: PositionerConfig,
    footprint: Footprint,
    goal: Pose2,
    phase: Option<Phase>,
    last: Option<Stamp>,
    attempts: u32,
    plan: Option<Manoeuvre>,
    /// The paper's method: the straight that follows the turn, and its recovery moves so far.
    pending: Option<Motion>,
    recoveries: usize,
}

impl Positioner {
    /// For one goal (`map_from_base`).
    ///
    /// # Errors
    /// When a setting is outside its range.
    pub fn new(
        docking: DockingConfig,
        config: PositionerConfig,
        footprint: Footprint,
        goal: Pose2,
    ) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let docker = Docker::new(config.planner(docking))?;
        Ok(Self {
            docker,
            config,
            footprint,
            goal,
            phase: None,
            last: None,
            attempts: 0,
            plan: None,
            pending: None,
            recoveries: 0,
        })
    }

    /// The goal, `map_from_base`.
    pub fn goal(&self) -> Pose2 {
        self.goal
    }

    /// What was planned last.
    pub fn manoeuvre(&self) -> Option<&Manoeuvre> {
        self.plan.as_ref()
    }

    /// Whether it stands on its goal.
    pub fn is_settled(&self) -> bool {
        matches!(self.phase, Some(Phase::Settled))
    }

    /// Whether it waits because nothing can be planned.
    pub fn is_waiting(&self) -> bool {
        matches!(self.phase, Some(Phase::Wait { .. }))
    }

    /// Says that the last command was not carried out (a safety stop, say): it measures and decides again from where it
    /// stands.
    pub fn interrupted(&mut self, now: Stamp) {
        self.pending = None;
        self.phase = Some(measure(now));
    }

    /// One control step, at 10 Hz or more.
    pub fn step(&mut self, input: &PositionerInput<'_>) -> PositionerReport {
        if !input.pose.is_finite() {
            return PositionerReport { twist: Twist2::ZERO, reason: Reason::BadPose, error: Pose2::IDENTITY };
        }
        let dt = self.last.map_or(0.0, |last| (input.stamp - last).clamp(0.0, 0.2));
        self.last = Some(input.stamp);
        let phase = self.phase.take().unwrap_or_else(|| measure(input.stamp));
        let (phase, twist, reason, pose) = match phase {
            Phase::Measure { since, average } => self.measure(input, since, average),
            Phase::Plan { search, pose } => {
                let (phase, reason) = self.plan_on(input, search, pose);
                (phase, Twist2::ZERO, reason, input.pose)
            }
            Phase::Follow(following) => self.follow(input, following, dt),
            Phase::Wait { until, reason } if input.stamp < until => {
                (Phase::Wait { until, reason: reason.clone() }, Twist2::ZERO, reason, input.pose)
            }
            Phase::Wait { .. } => (measure(input.stamp), Twist2::ZERO, Reason::Measuring, input.pose),
            Phase::Settled => self.settled(input),
        };
        self.phase = Some(phase);
        PositionerReport { twist, reason, error: self.goal.inverse() * pose }
    }

    fn tolerance(&self) -> Tolerance {
        let config = self.docker.config();
        Tolerance { position: config.position_tolerance, heading: config.heading_tolerance }
    }

    fn measure(
        &mut self,
        input: &PositionerInput<'_>,
        since: Stamp,
        mut average: PoseAverage,
    ) -> (Phase, Twist2, Reason, Pose2) {
        // The first fifth is for coming to rest.
        if input.stamp - since >= 0.2 * self.config.measure_time {
            average.add(&input.pose);
        }
        if input.stamp - since < self.config.measure_time {
            return (Phase::Measure { since, average }, Twist2::ZERO, Reason::Measuring, input.pose);
        }
        let pose = average.mean();
        let (phase, reason) = self.decide(input, &pose);
        (phase, Twist2::ZERO, reason, pose)
    }

    /// What to do from a pose measured at rest.
    fn decide(&mut self, input: &PositionerInput<'_>, pose: &Pose2) -> (Phase, Reason) {
        let error = self.goal.inverse() * *pose;
        let accepted = if self.attempts > self.config.attempts { self.config.release } else { 1.0 };
        if self.tolerance().holds(&error, accepted * 0.9) {
            return self.arrived();
        }
        self.attempts += u32::from(self.tolerance().holds(&error, self.config.release));
        match self.next_motion(input, pose) {
            Ok(Next::Motion(motion)) => follow(motion, *pose),
            Ok(Next::Search(search)) => self.plan_on(input, search, *pose),
            Err(reason) => self.wait(input, reason),
        }
    }

    /// A part of the search for motions from `pose`, and what follows when that was the last.
    fn plan_on(&mut self, input: &PositionerInput<'_>, mut search: Search, pose: Pose2) -> (Phase, Reason) {
        if self.is_pushed(input, &pose) {
            return (measure(input.stamp), Reason::Measuring);
        }
        match self.search_on(&mut search, input, &pose) {
            None => (Phase::Plan { search, pose }, Reason::Planning),
            Some(Ok(Some(motion))) => follow(motion, pose),
            Some(Ok(None)) => self.arrived(),
            Some(Err(reason @ Reason::Obstacle(_))) => (measure(input.stamp), reason),
            Some(Err(reason)) => self.wait(input, reason),
        }
    }

    fn wait(&self, input: &PositionerInput<'_>, reason: Reason) -> (Phase, Reason) {
        let until = input.stamp.after(self.config.patience);
        (Phase::Wait { until, reason: reason.clone() }, reason)
    }

    /// On the goal: what was still to follow is not, and the next approach has all its recovery moves.
    fn arrived(&mut self) -> (Phase, Reason) {
        (self.pending, self.recoveries) = (None, 0);
        (Phase::Settled, Reason::Settled)
    }

    fn follow(
        &mut self,
        input: &PositionerInput<'_>,
        mut following: Following,
        dt: f64,
    ) -> (Phase, Twist2, Reason, Pose2) {
        let mut space = Space::new(&self.footprint, -self.config.overlap, input.scene);
        let limits = self.docker.config().limits;
        let (phase, twist, reason) = match following.step(&input.pose, dt, &mut space, &limits, &self.config)
        {
            Command::Go(twist) => (Phase::Follow(following), twist, Reason::Moving(following.motion())),
            Command::Done => (measure(input.stamp), Twist2::ZERO, Reason::Measuring),
            Command::Blocked(by) => {
                self.pending = None;
                (measure(input.stamp), Twist2::ZERO, Reason::Obstacle(input.scene.named(by)))
            }
        };
        (phase, twist, reason, input.pose)
    }

    fn settled(&mut self, input: &PositionerInput<'_>) -> (Phase, Twist2, Reason, Pose2) {
        let error = self.goal.inverse() * input.pose;
        if self.tolerance().holds(&error, self.config.release) {
            return (Phase::Settled, Twist2::ZERO, Reason::Settled, input.pose);
        }
        self.attempts = 0;
        (measure(input.stamp), Twist2::ZERO, Reason::Measuring, input.pose)
    }
}

fn follow(motion: Motion, from: Pose2) -> (Phase, Reason) {
    (Phase::Follow(Following::new(motion, from)), Reason::Moving(motion))
}

fn measure(since: Stamp) -> Phase {
    Phase::Measure { since, average: PoseAverage::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Method;

    /// Settled, it forgets the straight that was to follow; pushed off, it begins with a decision, not with that.
    #[test]
    fn what_was_to_follow_ends_on_the_goal() {
        let docking = DockingConfig { method: Method::Paper, ..DockingConfig::default() };
        let footprint = Footprint::Disc { radius: 0.2 };
        let goal = Pose2::IDENTITY;
        let mut positioner =
            Positioner::new(docking, PositionerConfig::default(), footprint, goal).expect("valid");
        (positioner.pending, positioner.recoveries) = (Some(Motion::Drive(0.3)), 3);
        let scene = Scene::new(&[]).expect("valid");
        let (mut time, covariance) = (0.0, Matrix3::zeros());
        let mut run = |positioner: &mut Positioner, pose: Pose2, steps: usize| {
            let mut last = Reason::BadPose;
            for _ in 0..steps {
                time += 0.1;
                let stamp = Stamp::default().after(time);
                last = positioner.step(&PositionerInput { stamp, pose, covariance, scene: &scene }).reason;
            }
            last
        };
        assert_eq!(run(&mut positioner, goal, 10), Reason::Settled);
        assert_eq!((positioner.pending, positioner.recoveries), (None, 0));
        let beside = Pose2::new(0.0, 0.1, 0.0);
        assert!(matches!(run(&mut positioner, beside, 6), Reason::Moving(Motion::Turn(_))));
    }
}
