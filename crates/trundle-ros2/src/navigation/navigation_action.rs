//! An action that the robot performs as a mission, and its server.

use super::active_goal::{ActiveGoal, GoalProgress, RunningGoal, TimeLimit};
use super::goal_outcome::NavigationOutcome;
use super::goal_pose::GoalPoseError;
use crate::Ros2Error;
use crate::interface::ActionType;
use crate::node::{ActionHandle, GoalEnd, GoalHandler, GoalId, RosNode};
use crate::outputs::RunFrames;
use std::time::Instant;
use trundle_app::operator::RunView;
use trundle_runtime::{Reason, Task, TaskEnd};

/// Facts of the run for an action.
pub struct GoalContext<'c> {
    /// The frames.
    pub frames: &'c RunFrames,
    /// The newest view of the run.
    pub view: Option<&'c RunView>,
}

/// Reason why a goal is not carried out.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum NavigationRefusal<R> {
    /// The goal is refused.
    Refused(String),
    /// The goal is accepted and fails with this result.
    Failed(R),
}

/// An action that the robot performs as a mission.
pub trait NavigationAction: ActionType<Result: Default> + 'static {
    /// The tasks of a goal.
    ///
    /// # Errors
    /// Reason why the goal is not performed.
    fn tasks(
        goal: &Self::Goal,
        context: &GoalContext<'_>,
    ) -> Result<Vec<Task>, NavigationRefusal<Self::Result>>;

    /// The time that the goal allows.
    ///
    /// # Errors
    /// Reason why the goal is refused: its time is no time.
    fn time_limit(_goal: &Self::Goal) -> Result<Option<TimeLimit>, String> {
        Ok(None)
    }

    /// The reason why the goal fails although tasks are left; `ended`: the tasks that have ended. Default: never.
    fn failure(_goal: &Self::Goal, _ended: &[(usize, TaskEnd)]) -> Option<Reason> {
        None
    }

    /// Feedback.
    fn feedback(
        goal: &Self::Goal,
        view: &RunView,
        progress: &GoalProgress,
        frames: &RunFrames,
    ) -> Self::Feedback;

    /// The result, after `time_s` seconds.
    fn result(goal: &Self::Goal, outcome: &NavigationOutcome, time_s: f64) -> Self::Result;
}

/// Offers an action.
///
/// # Errors
/// When the action cannot be created.
pub fn offer<A: NavigationAction>(
    node: &mut RosNode,
    name: &str,
    active: &ActiveGoal,
    frames: &RunFrames,
) -> Result<(), Ros2Error> {
    let (active, frames) = (active.clone(), frames.clone());
    let clock = active.clock();
    ActionHandle::<A>::offer(node, name, clock, |handle| Box::new(Handler { handle, active, frames }))
        .map(drop)
}

/// The result of a goal with an invalid pose; `failed` makes the result from the message.
pub fn pose_error<R>(error: GoalPoseError, failed: impl FnOnce(String) -> R) -> NavigationRefusal<R> {
    match error {
        GoalPoseError::Invalid(error) => NavigationRefusal::Refused(error.to_string()),
        GoalPoseError::Frame(message) => NavigationRefusal::Failed(failed(message)),
    }
}

struct Handler<A: ActionType> {
    handle: ActionHandle<A>,
    active: ActiveGoal,
    frames: RunFrames,
}

impl<A: NavigationAction> GoalHandler<A> for Handler<A> {
    fn on_goal(&mut self, id: GoalId, goal: A::Goal) -> Result<(), String> {
        let view = self.active.view();
        let context = GoalContext { frames: &self.frames, view: view.as_deref() };
        match A::tasks(&goal, &context) {
            Err(NavigationRefusal::Refused(why)) => Err(why),
            Err(NavigationRefusal::Failed(result)) => {
                self.handle.end(&id, GoalEnd::Aborted, result);
                Ok(())
            }
            Ok(tasks) => {
                let limit = A::time_limit(&goal)?;
                let (handle, frames) = (self.handle.clone(), self.frames.clone());
                let running = Running::<A> { handle, id, goal, since: Instant::now(), frames };
                self.active.begin(tasks, Box::new(running), limit)
            }
        }
    }

    fn on_cancel(&mut self, _id: GoalId) {
        // The tick calls `is_canceling`.
    }
}

struct Running<A: ActionType> {
    handle: ActionHandle<A>,
    id: GoalId,
    goal: A::Goal,
    since: Instant,
    frames: RunFrames,
}

impl<A: NavigationAction> RunningGoal for Running<A> {
    fn feedback(&mut self, view: &RunView, progress: &GoalProgress) {
        self.handle.feedback(&self.id, A::feedback(&self.goal, view, progress, &self.frames));
    }

    fn is_canceling(&self) -> bool {
        self.handle.is_canceling(&self.id)
    }

    fn failure(&self, ended: &[(usize, TaskEnd)]) -> Option<Reason> {
        A::failure(&self.goal, ended)
    }

    fn end(self: Box<Self>, end: GoalEnd, outcome: &NavigationOutcome) {
        let result = A::result(&self.goal, outcome, self.since.elapsed().as_secs_f64());
        self.handle.end(&self.id, end, result);
    }
}
