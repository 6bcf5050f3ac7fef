//! The one active goal of the robot, of any action.

use super::goal_outcome::NavigationOutcome;
use crate::clock::RosClock;
use crate::node::{Diagnostics, GoalEnd};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use trundle_app::operator::{HandId, Operator, OperatorError, RunView};
use trundle_core::Twist2;
use trundle_runtime::{Mission, OperatorCommand, Reason, Task, TaskEnd};

/// Period of feedback. Source: ours; Nav2's is 10 ms to 1 s by action.
const FEEDBACK_PERIOD: Duration = Duration::from_millis(100);
/// Longest wait for standstill after a cancel. Source: ours; from 0.7 m/s at 0.5 m/s^2 it takes 1.4 s.
const STANDSTILL_TIMEOUT: Duration = Duration::from_secs(3);
/// Speed below which the robot counts as at rest \[m/s, rad/s\]. Source: ours.
const STANDSTILL_SPEED: f64 = 0.02;
/// Wait for the run to take a mission up. Source: ours; it takes one request a step.
const START_TIMEOUT: Duration = Duration::from_secs(5);

/// The time that a goal allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TimeLimit {
    /// The time.
    pub time: Duration,
    /// Whether it is for the first task alone.
    pub is_of_first_task: bool,
}

impl TimeLimit {
    /// The longest time. Source: ours, 31 years, as of options of the command line.
    const MAX_S: f64 = 1e9;

    /// A limit of the whole goal; none for 0 s and below, as in Nav2. `name` is the field, for the error.
    ///
    /// # Errors
    /// When the time is not a number, or too long.
    pub fn of_seconds(name: &str, seconds: f64) -> Result<Option<Self>, String> {
        if seconds <= 0.0 {
            return Ok(None);
        }
        let time = Duration::try_from_secs_f64(seconds).ok().filter(|time| time.as_secs_f64() <= Self::MAX_S);
        let Some(time) = time else {
            return Err(format!(
                "{name} is {seconds} s, expected at most {} s, or 0 for no limit",
                Self::MAX_S
            ));
        };
        Ok(Some(Self { time, is_of_first_task: false }))
    }

    /// Whether the time is over after `passed`; `ended`: the tasks that have ended.
    fn is_over(&self, passed: Duration, ended: &[(usize, TaskEnd)]) -> bool {
        passed > self.time && (!self.is_of_first_task || ended.is_empty())
    }
}

/// A goal of an action that is being worked on.
pub trait RunningGoal: Send {
    /// Sends feedback.
    fn feedback(&mut self, view: &RunView, progress: &GoalProgress);

    /// Whether the client requested its cancellation.
    fn is_canceling(&self) -> bool;

    /// The reason why the goal fails although tasks are left; `ended`: the tasks that have ended.
    fn failure(&self, ended: &[(usize, TaskEnd)]) -> Option<Reason>;

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
    time_limit: Option<TimeLimit>,
    /// Time of the final stop request, and the end and result of the goal after the stop.
    stopping: Option<(Instant, GoalEnd, NavigationOutcome)>,
    feedback_due: Instant,
}

impl Active {
    fn new(goal: Box<dyn RunningGoal>, request: u64, view: &RunView, time_limit: Option<TimeLimit>) -> Self {
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

    /// The end of a goal whose last request the run does not take up, after a wait.
    fn untaken(&self, now: Instant) -> Option<(GoalEnd, NavigationOutcome)> {
        let (since, end, outcome) = self.stopping.clone().unwrap_or_else(|| {
            (self.since, GoalEnd::Aborted, NavigationOutcome::failed("the run did not take the goal up"))
        });
        (now - since > START_TIMEOUT).then_some((end, outcome))
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
        time_limit: Option<TimeLimit>,
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

    /// Sends a twist of a person to the run.
    ///
    /// # Errors
    /// When the twist cannot be carried out, the person has driven without release since a stop, too many requests wait, or the run is over.
    pub fn drive(&self, twist: Twist2) -> Result<u64, OperatorError> {
        self.operator.drive(HandId::Topic, twist)
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
            return active.untaken(now);
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

    /// Cancels the mission if the client requested it, the goal has failed, or the time is over.
    fn stop_where_asked(&self, active: &mut Active, now: Instant) {
        let passed = now - active.since;
        let is_late = active.time_limit.is_some_and(|limit| limit.is_over(passed, &active.ended));
        let (end, outcome) = if active.goal.is_canceling() {
            (GoalEnd::Canceled, NavigationOutcome::default())
        } else if let Some(reason) = active.goal.failure(&active.ended) {
            (GoalEnd::Aborted, NavigationOutcome::of_reason(reason))
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};
    use trundle_app::operator::{Activity, OperatorLink, operator_link};
    use trundle_core::{Pose2, Stamp};
    use trundle_runtime::TaskRecord;

    /// What a goal was called with.
    #[derive(Default)]
    struct Reported {
        is_canceling: AtomicBool,
        feedbacks: Mutex<usize>,
        end: Mutex<Option<(GoalEnd, NavigationOutcome)>>,
    }

    impl Reported {
        fn end(&self) -> Option<(GoalEnd, NavigationOutcome)> {
            self.end.lock().unwrap().clone()
        }
    }

    /// A goal that fails if its first task is put off.
    struct TestGoal(Arc<Reported>);

    impl RunningGoal for TestGoal {
        fn feedback(&mut self, _view: &RunView, _progress: &GoalProgress) {
            *self.0.feedbacks.lock().unwrap() += 1;
        }

        fn is_canceling(&self) -> bool {
            self.0.is_canceling.load(Ordering::Relaxed)
        }

        fn failure(&self, ended: &[(usize, TaskEnd)]) -> Option<Reason> {
            match ended.first()? {
                (0, TaskEnd::PutOff { reason }) => Some(reason.clone()),
                _ => None,
            }
        }

        fn end(self: Box<Self>, end: GoalEnd, outcome: &NavigationOutcome) {
            *self.0.end.lock().unwrap() = Some((end, outcome.clone()));
        }
    }

    /// A run that takes requests up when a test does so, and the goal of a client.
    struct Rig {
        link: OperatorLink,
        active: ActiveGoal,
        reported: Arc<Reported>,
        since: Instant,
    }

    impl Rig {
        /// A goal of two tasks whose first may take `limit`.
        fn begin(limit: Option<TimeLimit>) -> Self {
            let (operator, mut link) = operator_link();
            let active = ActiveGoal::new(operator, RosClock::system(), Diagnostics::default());
            link.publish_view(view(0, &[]));
            let reported = Arc::<Reported>::default();
            let tasks = vec![Task::go(Pose2::new(1.0, 0.0, 0.0)), Task::Dock];
            active.begin(tasks, Box::new(TestGoal(Arc::clone(&reported))), limit).unwrap();
            let request = link.next_request().unwrap();
            link.publish_view(view(request.id, &[]));
            Self { link, active, reported, since: Instant::now() }
        }

        fn tick(&self, after_s: f64) {
            self.active.tick(self.since + Duration::from_secs_f64(after_s));
        }

        /// The run takes the waiting request up, which ends the mission.
        fn take_cancel(&mut self) {
            let request = self.link.next_request().expect("a request to cancel");
            assert_eq!(request.command, OperatorCommand::cancel());
            self.link.publish_view(view(request.id, &[]));
        }

        fn show_ended(&mut self, ends: &[TaskEnd]) {
            let id = self.active.view().unwrap().mission.id;
            self.link.publish_view(view(id, ends));
        }
    }

    fn view(mission: u64, ends: &[TaskEnd]) -> RunView {
        let activity = Activity { name: "driving", reason: None };
        let mut view = RunView::of_activity(Stamp::default(), Pose2::IDENTITY, Twist2::ZERO, activity);
        view.mission.id = mission;
        let record = |(index, end): (usize, &TaskEnd)| TaskRecord {
            index,
            task: Task::Dock,
            end: end.clone(),
            from: Stamp::default(),
            to: Stamp::default(),
            pose: Pose2::IDENTITY,
            bound: None,
            before_restart: false,
        };
        view.mission.ended = Arc::new(ends.iter().enumerate().map(record).collect());
        view
    }

    #[test]
    fn a_late_cancel_waits_for_the_run_and_ends_as_canceled() {
        let mut rig = Rig::begin(None);
        rig.tick(10.0);
        assert!(*rig.reported.feedbacks.lock().unwrap() > 0 && rig.reported.end().is_none());
        rig.reported.is_canceling.store(true, Ordering::Relaxed);
        rig.tick(10.1);
        rig.tick(10.12);
        assert_eq!(rig.reported.end(), None, "the run has not taken the request up");
        rig.take_cancel();
        rig.tick(10.14);
        assert_eq!(rig.reported.end(), Some((GoalEnd::Canceled, NavigationOutcome::default())));
    }

    #[test]
    fn a_run_that_does_not_answer_ends_the_goal_as_asked() {
        let rig = Rig::begin(None);
        rig.reported.is_canceling.store(true, Ordering::Relaxed);
        rig.tick(10.0);
        rig.tick(15.1);
        assert_eq!(rig.reported.end().unwrap().0, GoalEnd::Canceled);
    }

    #[test]
    fn a_goal_that_fails_before_its_last_task_cancels_the_rest() {
        let mut rig = Rig::begin(None);
        let put_off = TaskEnd::PutOff { reason: Reason::MovingObstacle };
        rig.show_ended(std::slice::from_ref(&put_off));
        rig.tick(1.0);
        rig.take_cancel();
        rig.tick(1.1);
        let (end, outcome) = rig.reported.end().unwrap();
        assert_eq!((end, outcome.reason), (GoalEnd::Aborted, Some(Reason::MovingObstacle)));
        assert_eq!(outcome.ended, [(0, put_off)]);
    }

    #[test]
    fn a_limit_of_the_first_task_is_over_with_it() {
        let limit = TimeLimit { time: Duration::from_secs(5), is_of_first_task: true };
        let mut rig = Rig::begin(Some(limit));
        rig.show_ended(&[TaskEnd::Done]);
        rig.tick(1.0);
        rig.tick(100.0);
        assert!(rig.link.next_request().is_none() && rig.reported.end().is_none(), "docking has no limit");
        let mut late = Rig::begin(Some(limit));
        late.tick(5.1);
        late.take_cancel();
        late.tick(5.2);
        assert!(late.reported.end().unwrap().1.is_timeout);
    }
}
