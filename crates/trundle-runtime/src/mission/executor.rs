//! The mission executor: one goal at a time from the tasks of a mission.

use crate::world_state::WorldState;
use crate::{
    behaviour::drive_state::DriveState,
    behaviour::goal::Goal,
    behaviour::relative_motion::RelativeMotion,
    behaviour::station_drive::StationGoal,
    mission::dock_task::{DockStep, DockTask},
    mission::executor_config::MissionExecutorConfig,
    mission::{GoalOptions, Mission, MissionState, Task, TaskEnd, TaskRecord},
    reason::{Reason, TaskFailure},
    schedule::Ticker,
};
use std::collections::VecDeque;
use trundle_core::{Invalid, Pose2, Stamp};
use trundle_planning::{Exploration, Explorer, Frontier};

/// Executes a mission: gives the navigator its goals, and records the results.
///
/// | task | goals for the navigator | ends when |
/// |---|---|---|
/// | go, return | the goal | it has arrived, passed a goal to pass through, or given up |
/// | turn, straight | the motion | it is done, or safety stops it for 5 s |
/// | explore | a turn on the spot, then viewpoint after viewpoint | no frontier is left |
/// | dock | a search for light, a survey of the station's axis, a straight move onto its contacts | the battery charges, or given up |
///
/// A robot on its charging station first backs off the station, before any task except docking.
#[derive(Debug)]
pub(crate) struct MissionExecutor {
    explore: trundle_planning::ExploreConfig,
    radius: f64,
    queue: VecDeque<Entry>,
    current: Option<Current>,
    records: Vec<TaskRecord>,
    by_operator: bool,
    frontier_check_due: Ticker,
}

/// A waiting task.
#[derive(Debug, Clone, Copy)]
struct Entry {
    index: usize,
    task: Task,
    is_second_try: bool,
}

/// The present task.
#[derive(Debug)]
struct Current {
    entry: Entry,
    from: Stamp,
    work: Work,
}

/// Progress of the task.
#[derive(Debug)]
enum Work {
    /// Backing off the charging station before the task.
    Undocking,
    /// Driving onto the charging station.
    Docking(Box<DockTask>),
    /// The robot drives to the goal.
    Going,
    /// Turns on the spot, or drives to a viewpoint.
    Exploring {
        explorer: Box<Explorer>,
        /// The frontier of the present viewpoint.
        frontier: Option<Frontier>,
        /// Number of reached viewpoints.
        views: usize,
        /// Reason for the last missed viewpoint.
        failure: Option<Reason>,
    },
}

/// Distance of backing off the charging station before a task \[m\]: the robot can then turn. Source: ours.
const UNDOCK_DISTANCE_M: f64 = 0.4;
/// The goal of backing off the charging station.
const UNDOCK: Goal = Goal::Station(StationGoal::BackOff(UNDOCK_DISTANCE_M));
/// Rate of the check whether the target of the exploration is still unknown \[1/s\]. Source: ours.
const FRONTIER_CHECK_RATE_HZ: f64 = 1.0;

impl MissionExecutor {
    /// An executor without a mission; exploration keeps `radius` m from obstacles.
    pub(crate) fn new(config: &MissionExecutorConfig, radius: f64) -> Result<Self, Invalid> {
        // This call checks the settings once.
        Explorer::new(config.explore, radius)?;
        Ok(Self {
            explore: config.explore,
            radius,
            queue: VecDeque::new(),
            current: None,
            records: Vec::new(),
            by_operator: false,
            frontier_check_due: Ticker::new(FRONTIER_CHECK_RATE_HZ),
        })
    }

    /// Starts a mission at its recorded task and replaces the present mission.
    pub(crate) fn begin(&mut self, mission: &MissionState) {
        let was_put_off = |index: usize| {
            mission.ended.iter().any(|r| r.index == index && matches!(r.end, TaskEnd::PutOff { .. }))
        };
        let entry = |(&index, &task)| Entry { index, task, is_second_try: was_put_off(index) };
        self.queue = mission.places.iter().zip(mission.left.tasks()).map(entry).collect();
        self.current = None;
        self.records.clone_from(&mission.ended);
        self.by_operator = mission.by_operator;
    }

    /// The tasks that have ended.
    pub(crate) fn records(&self) -> &[TaskRecord] {
        &self.records
    }

    /// The present task.
    pub(crate) fn task(&self) -> Option<Task> {
        self.current.as_ref().map(|current| current.entry.task)
    }

    /// The options of the present task's goal.
    pub(crate) fn goal_options(&self) -> GoalOptions {
        match self.task() {
            Some(Task::Go(goal)) => goal.options,
            _ => GoalOptions::default(),
        }
    }

    /// The tasks that have not ended, the present one first.
    pub(crate) fn tasks_left(&self) -> impl Iterator<Item = Task> {
        self.entries_left().map(|entry| entry.task)
    }

    fn entries_left(&self) -> impl Iterator<Item = &Entry> {
        self.current.iter().map(|current| &current.entry).chain(&self.queue)
    }

    /// Progress of the mission.
    pub(crate) fn mission(&self) -> MissionState {
        let (places, tasks) = self.entries_left().map(|entry| (entry.index, entry.task)).unzip();
        let left = Mission::new(tasks).expect("invariant: these tasks are of a mission");
        MissionState { left, places, ended: self.records.clone(), by_operator: self.by_operator }
    }

    /// Whether no task is left.
    pub(crate) fn is_idle(&self) -> bool {
        self.current.is_none() && self.queue.is_empty()
    }

    /// Reason for an incomplete mission after its end.
    pub(crate) fn failure(&self) -> Option<Reason> {
        let failures: Vec<TaskFailure> = self.records.iter().filter_map(failure_of).collect();
        (!failures.is_empty()).then_some(Reason::TasksFailed(failures))
    }

    /// Whether the next step may search frontiers, or give a goal that is planned for at once.
    pub(crate) fn may_take_long(&self, s: &WorldState<'_>, state: &DriveState) -> bool {
        let explores = matches!(&self.current, Some(Current { work: Work::Exploring { .. }, .. }));
        let explores = explores || matches!(&self.current, Some(Current { work: Work::Docking(_), .. }));
        let driving = matches!(state, DriveState::Driving | DriveState::Waiting { .. });
        state.is_over() && !self.is_idle()
            || self.passes(s, state)
            || explores && driving && self.frontier_check_due.will_be_due(s.now)
    }

    /// Returns the next goal for the navigator in `state`; `None` keeps the present goal.
    pub(crate) fn step(&mut self, s: &WorldState<'_>, state: &DriveState) -> Option<Goal> {
        if let Some(Current { work: Work::Docking(task), .. }) = &mut self.current {
            let step = task.step(s, state);
            return self.on_dock_step(step, s);
        }
        if let Some(undock) = self.undock_first(s) {
            return Some(undock);
        }
        match state {
            DriveState::Arrived if self.is_undocking() => return self.begin_current_task(s),
            DriveState::Arrived => self.on_arrived(s),
            DriveState::Stopped { reason } => self.on_stopped(reason, s),
            _ => {}
        }
        if self.passes(s, state) {
            self.end(TaskEnd::Done, s);
        }
        if self.current.is_none() {
            return self.start_next_task(s);
        }
        self.explore_further(s, state)
    }

    /// Whether the robot drives on from the present goal to the next one.
    fn passes(&self, s: &WorldState<'_>, state: &DriveState) -> bool {
        let Some(Current { entry: Entry { task: Task::Go(goal), .. }, work: Work::Going, .. }) =
            &self.current
        else {
            return false;
        };
        let is_under_way = matches!(state, DriveState::Driving | DriveState::Waiting { .. });
        let is_near = goal.options.is_arrival(&s.estimate.pose, &goal.pose);
        goal.options.pass_through && is_under_way && is_near && !self.queue.is_empty()
    }

    /// Begins the next task.
    fn start_next_task(&mut self, s: &WorldState<'_>) -> Option<Goal> {
        let entry = self.queue.pop_front()?;
        self.current = Some(Current { entry, from: s.now, work: Work::Undocking });
        if s.station.is_docked && entry.task != Task::Dock {
            return Some(UNDOCK);
        }
        self.begin_current_task(s)
    }

    /// Defers the present task until the robot is off its charging station. The base may report the station after the start of the task.
    fn undock_first(&mut self, s: &WorldState<'_>) -> Option<Goal> {
        let current = self.current.as_mut().filter(|_| s.station.is_docked)?;
        let is_on_its_way = matches!(current.work, Work::Going | Work::Exploring { .. });
        is_on_its_way.then(|| {
            current.work = Work::Undocking;
            UNDOCK
        })
    }

    /// Begins the work of the present task.
    fn begin_current_task(&mut self, s: &WorldState<'_>) -> Option<Goal> {
        let explorer = self.explorer();
        let current = self.current.as_mut()?;
        let (work, goal) = match current.entry.task {
            Task::Go(goal) => (Work::Going, Goal::Exact(goal.pose)),
            Task::Return => (Work::Going, Goal::Exact(Pose2::IDENTITY)),
            Task::Turn { angle } => (Work::Going, Goal::Relative(RelativeMotion::Turn { angle })),
            Task::Straight { distance, speed } => {
                (Work::Going, Goal::Relative(RelativeMotion::Straight { distance, speed }))
            }
            Task::Explore => {
                (Work::Exploring { explorer, frontier: None, views: 0, failure: None }, Goal::Spin)
            }
            Task::Dock => {
                let mut task = Box::new(DockTask::new(explorer));
                let step = task.step(s, &DriveState::Idle);
                current.work = Work::Docking(task);
                return self.on_dock_step(step, s);
            }
        };
        current.work = work;
        Some(goal)
    }

    fn explorer(&self) -> Box<Explorer> {
        let explorer = Explorer::new(self.explore, self.radius)
            .expect("invariant: the same settings were checked when the executor was made");
        Box::new(explorer)
    }

    fn is_undocking(&self) -> bool {
        matches!(&self.current, Some(Current { work: Work::Undocking, .. }))
    }

    /// Executes the request of the dock task.
    fn on_dock_step(&mut self, step: DockStep, s: &WorldState<'_>) -> Option<Goal> {
        match step {
            DockStep::Keep => return None,
            DockStep::Goal(goal) => return Some(goal),
            DockStep::Done => self.end(TaskEnd::Done, s),
            DockStep::GivenUp(reason) => self.end(TaskEnd::GivenUp { reason }, s),
        }
        self.start_next_task(s).or(Some(Goal::Stay))
    }

    /// Returns the next viewpoint of the exploration after the present one was observed or given up.
    fn explore_further(&mut self, s: &WorldState<'_>, state: &DriveState) -> Option<Goal> {
        let over = matches!(state, DriveState::Arrived | DriveState::Stopped { .. });
        let driving = matches!(state, DriveState::Driving | DriveState::Waiting { .. });
        let Some(Current { work: Work::Exploring { explorer, frontier, views, failure }, .. }) =
            &mut self.current
        else {
            return None;
        };
        if !(over || driving && self.frontier_check_due.due(s.now)) {
            return None;
        }
        match explorer.next(s.permitted_grid(), s.estimate.pose) {
            Exploration::Next(view) => {
                let is_old = |old: &Frontier| view.frontier.is_that_at(old.middle);
                if !over && frontier.as_ref().is_some_and(is_old) {
                    return None;
                }
                *frontier = Some(view.frontier);
                Some(Goal::Viewpoint(view.pose))
            }
            Exploration::Complete { .. } => {
                // Without a reached viewpoint, nothing was explored.
                let reason = failure.take().filter(|_| *views == 0);
                self.end(reason.map_or(TaskEnd::Done, |reason| TaskEnd::GivenUp { reason }), s);
                self.start_next_task(s).or(Some(Goal::Stay))
            }
        }
    }

    /// Handles the arrival at a goal.
    fn on_arrived(&mut self, s: &WorldState<'_>) {
        match &mut self.current {
            Some(Current { work: Work::Exploring { explorer, frontier, views, .. }, .. }) => {
                if let Some(frontier) = frontier.take() {
                    explorer.mark_viewed(&frontier);
                    *views += 1;
                }
            }
            Some(_) => self.end(TaskEnd::Done, s),
            None => {}
        }
    }

    /// Handles a goal that the navigator has given up.
    fn on_stopped(&mut self, reason: &Reason, s: &WorldState<'_>) {
        let Some(current) = &mut self.current else { return };
        if let Work::Exploring { explorer, frontier, failure, .. } = &mut current.work {
            *failure = Some(reason.clone());
            // An unreachable viewpoint may be reachable later; the number of attempts is limited.
            if let Some(frontier) = frontier.take() {
                explorer.mark_viewed(&frontier);
            }
            return;
        }
        let (entry, reason) = (current.entry, reason.clone());
        if entry.is_second_try || self.queue.is_empty() || is_passed_through(entry.task) {
            return self.end(TaskEnd::GivenUp { reason }, s);
        }
        let returns = matches!(self.queue.back(), Some(Entry { task: Task::Return, .. }));
        let place = self.queue.len() - usize::from(returns);
        self.queue.insert(place, Entry { is_second_try: true, ..entry });
        self.end(TaskEnd::PutOff { reason }, s);
    }

    fn end(&mut self, end: TaskEnd, s: &WorldState<'_>) {
        if let Some(Current { entry, from, .. }) = self.current.take() {
            let Entry { index, task, .. } = entry;
            let (to, pose, bound) = (s.now, s.estimate.pose, Some(s.estimate.bound_95()));
            self.records.push(TaskRecord { index, task, end, from, to, pose, bound, before_restart: false });
        }
    }
}

/// Whether a task is a goal that the robot drives through: it is not tried again at the end of the mission.
fn is_passed_through(task: Task) -> bool {
    matches!(task, Task::Go(goal) if goal.options.pass_through)
}

/// Returns the failure of a task that was given up.
fn failure_of(record: &TaskRecord) -> Option<TaskFailure> {
    match &record.end {
        TaskEnd::GivenUp { reason } => {
            Some(TaskFailure { index: record.index, task: record.task, reason: reason.clone() })
        }
        TaskEnd::Done | TaskEnd::PutOff { .. } => None,
    }
}

#[cfg(test)]
mod tests;
