//! The outcome of each task that has a goal.

use crate::{FinishedRun, RunSetup};
use serde::{Deserialize, Serialize};
use trundle_core::{Pose2, PoseBound};
use trundle_eval::{GoalError, goal_error};
use trundle_runtime::{TaskEnd, TaskRecord};

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
}

impl GoalOutcome {
    /// The outcomes of a run, in the order of their ends.
    pub fn all(run: &FinishedRun) -> Vec<Self> {
        run.tasks().filter_map(|record| Self::of(record, run)).collect()
    }

    fn of(record: &TaskRecord, run: &FinishedRun) -> Option<Self> {
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
        })
    }

    /// Whether the robot came within these distances of the goal, m and rad; by the true pose if known, else by the estimate. Before a
    /// restart only the estimate is recorded.
    pub fn is_reached(&self, distance: f64, turn: f64) -> bool {
        let near = |error: GoalError| error.distance < distance && error.dtheta.abs() < turn;
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
