//! The outcome of each task that has a goal.

use crate::{FinishedRun, RunSetup};
use serde::{Deserialize, Serialize};
use trundle_core::{Pose2, PoseBound};
use trundle_eval::{GoalError, goal_error};
use trundle_runtime::{RobotConfig, Task, TaskEnd, TaskRecord};

/// Distance within which the goal counts as reached \[m\]. Source: ours.
const GOAL_TOLERANCE_M: f64 = 0.05;
/// Heading difference within which the goal counts as reached \[deg\]. Source: ours.
const ALIGNED_DEG: f64 = 3.0;

/// Outcome of a task with a goal.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct GoalOutcome {
    /// Index of the task in the mission, from 0.
    pub task: usize,
    /// Goal pose, map frame.
    pub goal: Pose2,
    /// End of the task.
    pub end: TaskEnd,
    /// Time of the end, s since the start.
    pub at_s: f64,
    /// Error of the robot's true pose at the end, against the goal; `None` without truth.
    pub error: Option<GoalError>,
    /// Error of the estimated pose at the end.
    pub believed: Option<GoalError>,
    /// Bound of the estimated pose's error with a probability of 95 %; `None` if it was not recorded.
    pub bound: Option<PoseBound>,
    /// Whether the robot was switched off and on again since: the time is of the run before.
    pub before_restart: bool,
    /// Errors below which the goal counts as reached: with a tolerance of the goal, that and those of an exact goal.
    #[serde(default = "GoalOutcome::exact")]
    pub allowed: PoseBound,
}

impl GoalOutcome {
    /// The outcomes of a run, in the order of their ends.
    pub fn all(run: &FinishedRun, robot: &RobotConfig) -> Vec<Self> {
        run.tasks().filter_map(|record| Self::of(record, run, robot)).collect()
    }

    /// The errors below which an exact goal counts as reached.
    #[must_use]
    pub fn exact() -> PoseBound {
        PoseBound { distance: GOAL_TOLERANCE_M, heading: ALIGNED_DEG.to_radians() }
    }

    fn of(record: &TaskRecord, run: &FinishedRun, robot: &RobotConfig) -> Option<Self> {
        let goal = RunSetup::goal_of(&record.task)?;
        let log = &run.log;
        // The truth of an earlier run is not known to this one.
        let truth = log.truth_at(record.to).filter(|_| !record.before_restart);
        Some(Self {
            task: record.index,
            goal,
            end: record.end.clone(),
            at_s: log.start.map_or(0.0, |start| record.to - start),
            error: truth.and_then(|truth| goal_error(goal, truth).ok()),
            believed: goal_error(goal, record.pose).ok(),
            bound: record.bound,
            before_restart: record.before_restart,
            allowed: allowed(&record.task, robot),
        })
    }

    /// Whether the robot came as near to the goal as is allowed; by the true pose if known, else by the estimate. Before a restart only the
    /// estimate is recorded.
    pub fn is_reached(&self) -> bool {
        let PoseBound { distance, heading } = self.allowed;
        let near = |error: GoalError| error.distance < distance && error.dtheta.abs() < heading;
        let error = self.error.filter(|_| !self.before_restart).or(self.believed);
        self.end == TaskEnd::Done && error.is_some_and(near)
    }

    /// A row for people.
    pub fn row(&self) -> Vec<String> {
        let Pose2 { x, y, theta } = self.goal;
        let error = |e: &Option<GoalError>| {
            e.map_or_else(String::new, |e| {
                format!("{:.1} cm, {:.2} deg", e.distance * 100.0, e.dtheta.to_degrees())
            })
        };
        vec![
            format!("goal {} at ({x:.2} m, {y:.2} m, {:.0} deg)", self.task + 1, theta.to_degrees()),
            if self.before_restart {
                format!("{}, before it was switched off; estimated error {}", self.end, error(&self.believed))
            } else {
                let (by, found) = if self.error.is_some() {
                    ("", &self.error)
                } else {
                    ("by its own estimate ", &self.believed)
                };
                format!("{:.1} s: {}, {by}{}", self.at_s, self.end, error(found))
            },
        ]
    }
}

/// The errors that a task allows: with a tolerance of the goal or of the robot file, that and those of an exact goal.
pub(super) fn allowed(task: &Task, robot: &RobotConfig) -> PoseBound {
    let (exact, file) = (GoalOutcome::exact(), robot.planning.goal_tolerance);
    let options = if let Task::Go(goal) = task { goal.options } else { Default::default() };
    let Some(tolerance) = options.tolerance.or((file > 0.0).then_some(file)) else { return exact };
    let heading =
        options.heading_tolerance.map_or(std::f64::consts::PI, |tolerance| tolerance + exact.heading);
    PoseBound { distance: tolerance + exact.distance, heading }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_runtime::{GoalOptions, TaskGoal};

    #[test]
    fn a_goal_with_a_tolerance_allows_that_and_any_heading() {
        let robot = RobotConfig::default();
        let goal = |tolerance, heading_tolerance| {
            let mut options = GoalOptions::default();
            (options.tolerance, options.heading_tolerance) = (tolerance, heading_tolerance);
            Task::Go(TaskGoal::new(Pose2::IDENTITY, options))
        };
        assert_eq!(allowed(&goal(None, None), &robot), GoalOutcome::exact());
        assert_eq!(allowed(&Task::Return, &robot), GoalOutcome::exact());
        let near = allowed(&goal(Some(0.3), None), &robot);
        assert!((near.distance - 0.35).abs() < 1e-12 && near.heading == std::f64::consts::PI);
        let turned = allowed(&goal(Some(0.3), Some(0.1)), &robot).heading;
        assert!((turned - 0.1 - GoalOutcome::exact().heading).abs() < 1e-12);
        let mut wide = robot.clone();
        wide.planning.goal_tolerance = 0.2;
        assert!((allowed(&Task::Return, &wide).distance - 0.25).abs() < 1e-12);
    }
}
