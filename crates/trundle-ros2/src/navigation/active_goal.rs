//! The one active goal of the robot, of any action.

use super::goal_outcome::NavigationOutcome;
use crate::clock::RosClock;
use crate::node::{Diagnostics, GoalEnd};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use trundle_app::operator::{Operator, OperatorError, RunView};
use trundle_core::Twist2;
use trundle_runtime::{Mission, OperatorCommand, Task, TaskEnd};

/// Period of feedback. Source: ours; Nav2's is 10 ms to 1 s by action.
const FEEDBACK_PERIOD: Duration = Duration::from_millis(100);
/// Longest wait for standstill after a cancel. Source: ours; from 0.7 m/s at 0.5 m/s^2 it takes 1.4 s.
const STANDSTILL_TIMEOUT: Duration = Duration::from_secs(3);
/// Speed below which the robot counts as at rest \[m/s, rad/s\]. Source: ours.
const STANDSTILL_SPEED: f64 = 0.02;
/// Wait for the run to take a mission up. Source: ours; it takes one request a step.
const START_TIMEOUT: Duration = Duration::from_secs(5);

/// A goal of an action that is being worked on.
pub trait RunningGoal: Send {
    /// Sends feedback.
    fn feedback(&mut self, view: &RunView, progress: &GoalProgress);

    /// Whether the client requested its cancellation.
    fn is_canceling(&self) -> bool;

    /// Ends the goal.
    fn end(self: Box<Self>, end: GoalEnd, outcome: &NavigationOutcome);
}

/// Progress of a goal.
#[derive(Debug, Clone, Copy)]
pub struct GoalProgress {
    /// Time since the start \[s\].
    pub time_s: f64,
    /// `map_from_base` at the start.
    pub start: trundle_core::Pose2,
}

struct Active {
    goal: Box<dyn RunningGoal>,
    /// Number of the goal's mission.
    request: u64,
    since: Instant,
    start: trundle_core::Pose2,
    /// The goal's tasks that have ended.
    ended: Vec<(usize, TaskEnd)>,
    /// Time after which the goal fails.
    time_limit: Option<Duration>,
    /// Time of the final stop request, and the end and result of the goal after the stop.
    stopping: Option<(Instant, GoalEnd, NavigationOutcome)>,
    feedback_due: Instant,
}

impl Active {
    fn new(goal: Box<dyn RunningGoal>, request: u64, view: &RunView, time_limit: Option<Duration>) -> Self {
        let (now, start) = (Instant::now(), view.estimate.pose);
        let ended = Vec::new();
        Self { goal, request, since: now, start, ended, time_limit, stopping: None, feedback_due: now }
    }

    /// Notes the tasks that have ended.
    fn note_tasks(&mut self, view: &RunView) {
        let records = &view.mission.ended;
        if records.len() != self.ended.len() {
            self.ended = records.iter().map(|record| (record.index, record.end.clone())).collect();
        }
    }

    fn end(self, end: GoalEnd, outcome: NavigationOutcome) {
        self.goal.end(end, &NavigationOutcome { ended: self.ended, ..outcome });
    }
}

/// The goal in progress, at most one. Clones share it.
#[derive(Clone)]
pub struct ActiveGoal {
    operator: Operator,
    clock: RosClock,
    diagnostics: Diagnostics,
    active: Arc<Mutex<Option<Active>>>,
}

impl ActiveGoal {
    /// No goal yet.
    #[must_use]
    pub fn new(operator: Operator, clock: RosClock, diagnostics: Diagnostics) -> Self {
        Self { operator, clock, diagnostics, active: Arc::default() }
    }

    /// The newest view of the run.
    #[must_use]
    pub fn view(&self) -> Option<Arc<RunView>> {
        self.operator.view()
    }

    /// The ROS clock.
    #[must_use]
    pub fn clock(&self) -> RosClock {
        self.clock.clone()
    }

    /// Starts a mission for a goal. The previous goal ends as aborted, as in Nav2's servers.
    ///
    /// # Errors
    /// Reason why the goal is refused.
    pub fn begin(
        &self,
        tasks: Vec<Task>,
        goal: Box<dyn RunningGoal>,
        time_limit: Option<Duration>,
    ) -> Result<(), String> {
        let Some(view) = self.view() else {
            return Err("the robot has not begun: wait for its first images".to_owned());
        };
        let mission = Mission::new(tasks).map_err(|error| error.to_string())?;
        let request =
            self.operator.send(OperatorCommand::Begin(mission)).map_err(|error| error.to_string())?;
        let active = Active::new(goal, request, &view, time_limit);
        if let Some(old) = self.lock().replace(active) {
            old.end(GoalEnd::Aborted, NavigationOutcome::replaced());
        }
        Ok(())
    }

    /// Begins a mission that no action follows: a click in RViz.
    ///
    /// # Errors
    /// Reason for the refusal.
    pub fn begin_without_action(&self, tasks: Vec<Task>) -> Result<(), String> {
        let mission = Mission::new(tasks).map_err(|error| error.to_string())?;
        self.send(OperatorCommand::Begin(mission)).map_err(|error| error.to_string())?;
        if let Some(old) = self.lock().take() {
            old.end(GoalEnd::Aborted, NavigationOutcome::replaced());
        }
        Ok(())
    }

    /// Sends a command to the run.
    ///
    /// # Errors
    /// When the command cannot be carried out, too many wait, or the run is over.
    pub fn send(&self, command: OperatorCommand) -> Result<u64, OperatorError> {
        self.operator.send(command)
    }

    /// Follows the goal: feedback, its end, cancel, time limit. Called in the node's thread.
    pub fn tick(&self, now: Instant) {
        let mut active = self.lock();
        let (Some(goal), Some(view)) = (active.as_mut(), self.operator.view()) else { return };
        if let Some((end, outcome)) = self.step(goal, &view, now)
            && let Some(goal) = active.take()
        {
            goal.end(end, outcome);
        }
    }

    /// One check of a goal; returns its end, if any.
    fn step(
        &self,
        active: &mut Active,
        view: &RunView,
        now: Instant,
    ) -> Option<(GoalEnd, NavigationOutcome)> {
        if view.mission.id > active.request {
            return Some((GoalEnd::Aborted, NavigationOutcome::replaced()));
        }
        if view.mission.id < active.request {
            let is_late = now - active.since > START_TIMEOUT;
            return is_late
                .then(|| (GoalEnd::Aborted, NavigationOutcome::failed("the run did not take the goal up")));
        }
        if let Some((since, end, outcome)) = &active.stopping {
            let is_over = is_standing(view) || now - *since > STANDSTILL_TIMEOUT;
            return is_over.then(|| (*end, outcome.clone()));
        }
        active.note_tasks(view);
        if view.mission.is_over {
            return Some(end_of(view, &active.ended));
        }
        self.stop_where_asked(active, now);
        if now >= active.feedback_due {
            active.feedback_due = now + FEEDBACK_PERIOD;
            let progress = GoalProgress { time_s: (now - active.since).as_secs_f64(), start: active.start };
            active.goal.feedback(view, &progress);
        }
        None
    }

    /// Cancels the mission if the client requested it or the time is over.
    fn stop_where_asked(&self, active: &mut Active, now: Instant) {
        let is_late = active.time_limit.is_some_and(|limit| now - active.since > limit);
        let (end, outcome) = if active.goal.is_canceling() {
            (GoalEnd::Canceled, NavigationOutcome::default())
        } else if is_late {
            (GoalEnd::Aborted, NavigationOutcome::timed_out())
        } else {
            return;
        };
        match self.operator.send(OperatorCommand::cancel()) {
            Ok(request) => {
                active.request = request;
                active.stopping = Some((now, end, outcome));
            }
            Err(error) => self.diagnostics.warn("cancel", error.to_string()),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Option<Active>> {
        self.active.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn is_standing(view: &RunView) -> bool {
    let Twist2 { v, omega, .. } = view.estimate.twist;
    v.abs() < STANDSTILL_SPEED && omega.abs() < STANDSTILL_SPEED
}

/// End of a goal whose mission is over, its tasks `ended`.
fn end_of(view: &RunView, ended: &[(usize, TaskEnd)]) -> (GoalEnd, NavigationOutcome) {
    let mut outcome = NavigationOutcome { ended: ended.to_vec(), ..NavigationOutcome::default() };
    let state = view.state.drive().and_then(|state| state.reason());
    let failure = outcome.missed().next_back().map(|(_, reason)| reason).or(state).cloned();
    outcome.reason = failure;
    let end = if outcome.reason.is_none() { GoalEnd::Succeeded } else { GoalEnd::Aborted };
    outcome.message = outcome.reason.as_ref().map(ToString::to_string).unwrap_or_default();
    (end, outcome)
}
