//! From a request of a page to commands of the robot.

mod goal_check;
mod refusal;

pub use refusal::CommandRefusal;

use crate::run_facts::RunFacts;
use crate::wire::{Goal, Request};
use goal_check::require_free;
use std::sync::atomic::{AtomicBool, Ordering};
use trundle_app::operator::Operator;
use trundle_collision::RoundedHull;
use trundle_core::{DriveLimits, Pose2, Twist2};
use trundle_runtime::{Mission, OperatorCommand, PoseGuess, Task};

/// Most goals of one request.
const MAX_GOALS: usize = 50;
/// Standard deviation of a position that a person points at \[m\]. Source: ours; a finger on a map of 10 m.
const POINTED_POSITION_SIGMA_M: f64 = 0.3;
/// Standard deviation of a heading that a person points at \[rad\]: 15 deg. Source: ours.
const POINTED_HEADING_SIGMA_RAD: f64 = 0.26;
/// Part of the highest speeds at which a person drives by hand. Source: ours.
const HAND_SPEED: f64 = 0.6;

/// Sends commands to the robot.
#[derive(Debug)]
pub struct RunSteering {
    operator: Operator,
    hull: RoundedHull,
    limits: DriveLimits,
    /// Whether a stop or a drive by hand of this page paused the robot: the next task of the page ends that pause.
    is_paused_here: AtomicBool,
}

impl RunSteering {
    /// The steering of a run.
    pub fn new(operator: Operator, facts: &RunFacts) -> Self {
        let hull = RoundedHull::exact(&facts.footprint);
        Self { operator, hull, limits: facts.limits, is_paused_here: AtomicBool::new(false) }
    }

    /// Obeys a request; requests that are not for the robot do nothing.
    ///
    /// # Errors
    /// When the robot cannot obey: a goal in a wall, a number out of range, a run that is over.
    pub fn obey(&self, request: &Request) -> Result<(), CommandRefusal> {
        match request {
            Request::Go { goals, append, .. } => self.go(goals, *append),
            Request::Explore { .. } => self.begin(vec![Task::Explore]),
            Request::Return { .. } => self.begin(vec![Task::Return]),
            Request::Dock { .. } => self.begin(vec![Task::Dock]),
            Request::Stop { .. } => self.stop(),
            Request::Pause { .. } => {
                self.is_paused_here.store(false, Ordering::Relaxed);
                self.send(OperatorCommand::Pause)
            }
            Request::Continue { .. } => {
                self.is_paused_here.store(false, Ordering::Relaxed);
                self.send(OperatorCommand::Continue)
            }
            Request::Drive { v, omega } => self.drive(*v, *omega),
            Request::SetPose { pose, .. } => self.send(OperatorCommand::SetPose(PoseGuess {
                pose: pose.pose(),
                position_sigma: POINTED_POSITION_SIGMA_M,
                heading_sigma: POINTED_HEADING_SIGMA_RAD,
            })),
            _ => Ok(()),
        }
    }

    /// The robot stops at once, and the mission is dropped.
    ///
    /// # Errors
    /// When the run is over.
    pub fn stop(&self) -> Result<(), CommandRefusal> {
        self.send(OperatorCommand::Pause)?;
        self.is_paused_here.store(true, Ordering::Relaxed);
        self.send(OperatorCommand::cancel())
    }

    /// The one who drove by hand is gone: the robot stops.
    pub fn end_of_hand(&self) {
        if self.is_paused_here.load(Ordering::Relaxed) && self.send(OperatorCommand::Pause).is_err() {
            tracing::debug!("live page: the run is over");
        }
    }

    fn go(&self, goals: &[Goal], append: bool) -> Result<(), CommandRefusal> {
        if goals.is_empty() || goals.len() > MAX_GOALS {
            return Err(CommandRefusal::of(format!("{} goals: expected 1 to {MAX_GOALS}", goals.len())));
        }
        let view = self.operator.glance();
        let map = view.as_ref().and_then(|view| view.map.as_deref());
        for (number, goal) in goals.iter().enumerate() {
            let checked = Mission::new(vec![Task::Go(goal.pose())]).map_err(CommandRefusal::from);
            let checked = checked
                .and_then(|_| map.map_or(Ok(()), |map| require_free(&map.grid, &self.hull, goal.pose())));
            checked.map_err(|refusal| CommandRefusal { goal: Some(number), ..refusal })?;
        }
        let left = view.filter(|_| append).map(|view| view.mission.left.to_vec()).unwrap_or_default();
        self.begin(left.into_iter().chain(goals.iter().map(|goal| Task::Go(goal.pose()))).collect())
    }

    fn begin(&self, tasks: Vec<Task>) -> Result<(), CommandRefusal> {
        self.send(OperatorCommand::Begin(Mission::new(tasks)?))?;
        if self.is_paused_here.swap(false, Ordering::Relaxed) {
            self.send(OperatorCommand::Continue)?;
        }
        Ok(())
    }

    fn drive(&self, v: f64, omega: f64) -> Result<(), CommandRefusal> {
        let part = |part: f64, max: f64| HAND_SPEED * max * part.clamp(-1.0, 1.0);
        self.is_paused_here.store(true, Ordering::Relaxed);
        self.send(OperatorCommand::Drive(Twist2::new(part(v, self.limits.v), part(omega, self.limits.omega))))
    }

    fn send(&self, command: OperatorCommand) -> Result<(), CommandRefusal> {
        Ok(self.operator.send(command).map(drop)?)
    }
}

impl Goal {
    fn pose(&self) -> Pose2 {
        Pose2::new(self.x, self.y, self.theta)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_app::operator::operator_link;
    use trundle_core::Footprint;

    fn steering() -> (RunSteering, trundle_app::operator::OperatorLink) {
        let (operator, link) = operator_link();
        let limits = DriveLimits::KOBUKI;
        let facts = RunFacts { title: String::new(), footprint: Footprint::KOBUKI, limits };
        (RunSteering::new(operator, &facts), link)
    }

    fn go(x: f64) -> Request {
        Request::Go { id: 1, goals: vec![Goal { x, y: 0.0, theta: 0.0 }], append: false }
    }

    #[test]
    fn goals_are_checked_before_the_robot_sees_them() {
        let (steering, _link) = steering();
        assert_eq!(steering.obey(&go(1.0)), Ok(()));
        let refusal = steering.obey(&go(1e9)).unwrap_err();
        assert_eq!(refusal.goal, Some(0));
        assert!(steering.obey(&Request::Go { id: 1, goals: vec![], append: false }).is_err());
        let many = vec![Goal { x: 0.0, y: 0.0, theta: 0.0 }; 1000];
        assert!(steering.obey(&Request::Go { id: 1, goals: many, append: true }).is_err());
    }

    #[test]
    fn a_run_that_is_over_is_named() {
        let (steering, link) = steering();
        drop(link);
        assert_eq!(steering.obey(&Request::Stop { id: 1 }).unwrap_err().text, "the run is over");
        steering.end_of_hand();
    }
}
