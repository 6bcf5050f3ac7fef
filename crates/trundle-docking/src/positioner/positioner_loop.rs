//! The closed loop of the positioner.

use crate::contact_space::ContactSpace;
use crate::docking_config::DockingConfig;
use crate::motion::manoeuvre::{Manoeuvre, Motion};
use crate::planner::DockingPlanner;
use crate::positioner::config::PositionerConfig;
use crate::positioner::motion_execution::{Command, MotionExecution};
use crate::positioner::motion_planner::{MotionPlanner, MotionSearch, Next};
use crate::positioner::pose_average::PoseAverage;
use crate::positioner::report::{PositionerInput, PositionerReason, PositionerReport};
use trundle_core::{Footprint, Invalid, Pose2, Stamp, Twist2};

#[derive(Debug)]
enum Phase {
    Measure { since: Stamp, average: PoseAverage },
    DockingPlan { search: MotionSearch, pose: Pose2 },
    Follow(MotionExecution),
    Wait { until: Stamp, reason: PositionerReason },
    Settled,
}

/// Moves a robot onto a goal and corrects later deviations.
#[derive(Debug)]
pub struct Positioner {
    planner: MotionPlanner,
    phase: Option<Phase>,
    last: Option<Stamp>,
    attempts: u32,
}

impl Positioner {
    /// A positioner for one goal (`map_from_base`).
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
        let planner = DockingPlanner::new(config.planner(docking))?;
        let planner =
            MotionPlanner { planner, config, footprint, goal, plan: None, pending: None, recoveries: 0 };
        Ok(Self { planner, phase: None, last: None, attempts: 0 })
    }

    /// The goal, `map_from_base`.
    pub fn goal(&self) -> Pose2 {
        self.planner.goal
    }

    /// The last plan.
    pub fn manoeuvre(&self) -> Option<&Manoeuvre> {
        self.planner.plan.as_ref()
    }

    /// Whether the robot is at its goal.
    pub fn is_settled(&self) -> bool {
        matches!(self.phase, Some(Phase::Settled))
    }

    /// Whether the positioner waits because no manoeuvre exists.
    pub fn is_waiting(&self) -> bool {
        matches!(self.phase, Some(Phase::Wait { .. }))
    }

    /// Reports that the last command was not carried out (after a safety stop): it measures and decides again.
    pub fn interrupted(&mut self, now: Stamp) {
        self.planner.pending = None;
        self.phase = Some(measure(now));
    }

    /// One control step, at 10 Hz or more.
    pub fn step(&mut self, input: &PositionerInput<'_>) -> PositionerReport {
        if !input.pose.is_finite() {
            return PositionerReport {
                twist: Twist2::ZERO,
                reason: PositionerReason::BadPose,
                error: Pose2::IDENTITY,
            };
        }
        let dt = self.last.map_or(0.0, |last| (input.stamp - last).clamp(0.0, 0.2));
        self.last = Some(input.stamp);
        let phase = self.phase.take().unwrap_or_else(|| measure(input.stamp));
        let (phase, twist, reason, pose) = match phase {
            Phase::Measure { since, average } => self.measure(input, since, average),
            Phase::DockingPlan { search, pose } => {
                let (phase, reason) = self.plan_on(input, search, pose);
                (phase, Twist2::ZERO, reason, input.pose)
            }
            Phase::Follow(execution) => self.follow(input, execution, dt),
            Phase::Wait { until, reason } if input.stamp < until => {
                (Phase::Wait { until, reason: reason.clone() }, Twist2::ZERO, reason, input.pose)
            }
            Phase::Wait { .. } => {
                (measure(input.stamp), Twist2::ZERO, PositionerReason::Measuring, input.pose)
            }
            Phase::Settled => self.settled(input),
        };
        self.phase = Some(phase);
        PositionerReport { twist, reason, error: self.planner.goal.inverse() * pose }
    }

    fn measure(
        &mut self,
        input: &PositionerInput<'_>,
        since: Stamp,
        mut average: PoseAverage,
    ) -> (Phase, Twist2, PositionerReason, Pose2) {
        // The first fifth is for coming to rest.
        if input.stamp - since >= 0.2 * self.planner.config.measure_time {
            average.add(&input.pose);
        }
        if input.stamp - since < self.planner.config.measure_time {
            return (
                Phase::Measure { since, average },
                Twist2::ZERO,
                PositionerReason::Measuring,
                input.pose,
            );
        }
        let pose = average.mean();
        let (phase, reason) = self.decide(input, &pose);
        (phase, Twist2::ZERO, reason, pose)
    }

    /// The decision at a pose measured at rest.
    fn decide(&mut self, input: &PositionerInput<'_>, pose: &Pose2) -> (Phase, PositionerReason) {
        let error = self.planner.goal.inverse() * *pose;
        let accepted =
            if self.attempts > self.planner.config.attempts { self.planner.config.release } else { 1.0 };
        if self.planner.tolerance().holds(&error, accepted * 0.9) {
            return self.arrived();
        }
        self.attempts += u32::from(self.planner.tolerance().holds(&error, self.planner.config.release));
        match self.planner.next_motion(input, pose) {
            Ok(Next::Motion(motion)) => follow(motion, *pose),
            Ok(Next::Search(search)) => self.plan_on(input, search, *pose),
            Err(reason) => self.wait(input, reason),
        }
    }

    /// Continues the search for motions from `pose`, and acts on its result.
    fn plan_on(
        &mut self,
        input: &PositionerInput<'_>,
        mut search: MotionSearch,
        pose: Pose2,
    ) -> (Phase, PositionerReason) {
        if self.planner.is_pushed(input, &pose) {
            return (measure(input.stamp), PositionerReason::Measuring);
        }
        match self.planner.search_on(&mut search, input, &pose) {
            None => (Phase::DockingPlan { search, pose }, PositionerReason::Planning),
            Some(Ok(Some(motion))) => follow(motion, pose),
            Some(Ok(None)) => self.arrived(),
            Some(Err(reason @ PositionerReason::Obstacle(_))) => (measure(input.stamp), reason),
            Some(Err(reason)) => self.wait(input, reason),
        }
    }

    fn wait(&self, input: &PositionerInput<'_>, reason: PositionerReason) -> (Phase, PositionerReason) {
        let until = input.stamp.after(self.planner.config.patience);
        (Phase::Wait { until, reason: reason.clone() }, reason)
    }

    /// At the goal: pending motions are dropped, and the recovery moves start again.
    fn arrived(&mut self) -> (Phase, PositionerReason) {
        (self.planner.pending, self.planner.recoveries) = (None, 0);
        (Phase::Settled, PositionerReason::Settled)
    }

    fn follow(
        &mut self,
        input: &PositionerInput<'_>,
        mut execution: MotionExecution,
        dt: f64,
    ) -> (Phase, Twist2, PositionerReason, Pose2) {
        let mut space = ContactSpace::new(&self.planner.footprint, -self.planner.config.overlap, input.scene);
        let limits = self.planner.planner.config().limits;
        let (phase, twist, reason) =
            match execution.step(&input.pose, dt, &mut space, &limits, &self.planner.config) {
                Command::Go(twist) => {
                    (Phase::Follow(execution), twist, PositionerReason::Moving(execution.motion()))
                }
                Command::Done => (measure(input.stamp), Twist2::ZERO, PositionerReason::Measuring),
                Command::Blocked(by) => {
                    self.planner.pending = None;
                    (measure(input.stamp), Twist2::ZERO, PositionerReason::Obstacle(input.scene.named(by)))
                }
            };
        (phase, twist, reason, input.pose)
    }

    fn settled(&mut self, input: &PositionerInput<'_>) -> (Phase, Twist2, PositionerReason, Pose2) {
        let error = self.planner.goal.inverse() * input.pose;
        if self.planner.tolerance().holds(&error, self.planner.config.release) {
            return (Phase::Settled, Twist2::ZERO, PositionerReason::Settled, input.pose);
        }
        self.attempts = 0;
        (measure(input.stamp), Twist2::ZERO, PositionerReason::Measuring, input.pose)
    }
}

fn follow(motion: Motion, from: Pose2) -> (Phase, PositionerReason) {
    (Phase::Follow(MotionExecution::new(motion, from)), PositionerReason::Moving(motion))
}

fn measure(since: Stamp) -> Phase {
    Phase::Measure { since, average: PoseAverage::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::docking_config::Method;
    use crate::scene::obstacle_scene::ObstacleScene;
    use nalgebra::Matrix3;

    /// At the goal, the pending straight move is dropped; pushed off, the positioner starts with a decision.
    #[test]
    fn a_pending_motion_is_dropped_at_the_goal() {
        let docking = DockingConfig { method: Method::Hong24, ..DockingConfig::default() };
        let footprint = Footprint::Disc { radius: 0.2 };
        let goal = Pose2::IDENTITY;
        let mut positioner =
            Positioner::new(docking, PositionerConfig::default(), footprint, goal).expect("valid");
        (positioner.planner.pending, positioner.planner.recoveries) = (Some(Motion::Drive(0.3)), 3);
        let scene = ObstacleScene::new(&[]).expect("valid");
        let (mut time, covariance) = (0.0, Matrix3::zeros());
        let mut run = |positioner: &mut Positioner, pose: Pose2, steps: usize| {
            let mut last = PositionerReason::BadPose;
            for _ in 0..steps {
                time += 0.1;
                let stamp = Stamp::default().after(time);
                last = positioner.step(&PositionerInput { stamp, pose, covariance, scene: &scene }).reason;
            }
            last
        };
        assert_eq!(run(&mut positioner, goal, 10), PositionerReason::Settled);
        assert_eq!((positioner.planner.pending, positioner.planner.recoveries), (None, 0));
        let beside = Pose2::new(0.0, 0.1, 0.0);
        assert!(matches!(run(&mut positioner, beside, 6), PositionerReason::Moving(Motion::Turn(_))));
    }
}
