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
/// | go, return | the goal | it has arrived, or given up |
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
        if self.current.is_none() {
            return self.start_next_task(s);
        }
        self.explore_further(s, state)
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
        if entry.is_second_try || self.queue.is_empty() {
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
mod tests {
    use super::*;
    use crate::reason::ReasonKind;
    use proptest::prelude::*;
    use trundle_core::{OccupancyGrid, PoseEstimate, Twist2};

    fn world(grid: &OccupancyGrid) -> WorldState<'_> {
        let (stamp, covariance) = (Stamp::default(), nalgebra::Matrix3::zeros());
        let estimate =
            PoseEstimate { stamp, pose: Pose2::new(0.35, 0.35, 0.0), twist: Twist2::ZERO, covariance };
        WorldState {
            now: stamp,
            estimate,
            grid,
            scan: None,
            seen: None,
            wheels: Some(stamp),
            hold: None,
            motion: trundle_control::MotionSense::Wheels,
            dynamic_obstacles: crate::world_state::DynamicObstacles::default(),
            station: crate::world_state::StationState::default(),
            zones: crate::zones::ZoneView::default(),
        }
    }

    fn room() -> OccupancyGrid {
        OccupancyGrid::from_ascii(
            0.1,
            "########\n#......#\n#......#\n#......#\n#......#\n#......#\n########\n",
        )
        .unwrap()
    }

    fn executor(tasks: &[Task]) -> MissionExecutor {
        let mut executor = MissionExecutor::new(&MissionExecutorConfig::default(), 0.17).unwrap();
        executor.begin(&MissionState::new(Mission::new(tasks.to_vec()).unwrap()));
        executor
    }

    #[test]
    fn goals_come_one_after_the_other_and_what_fails_comes_again_before_the_return() {
        let (grid, [a, b]) = (room(), [1.0, 2.0].map(|x| Pose2::new(x, 0.0, 0.0)));
        let mut executor = executor(&[Task::go(a), Task::go(b), Task::Return]);
        let s = world(&grid);
        let stopped = DriveState::Stopped { reason: Reason::MovingObstacle };
        assert!(executor.may_take_long(&s, &DriveState::Idle), "a goal is planned for at once");
        assert_eq!(executor.step(&s, &DriveState::Idle), Some(Goal::Exact(a)));
        assert!(!executor.may_take_long(&s, &DriveState::Driving));
        assert_eq!(executor.step(&s, &DriveState::Driving), None);
        assert_eq!(executor.step(&s, &stopped), Some(Goal::Exact(b)));
        assert_eq!(executor.step(&s, &DriveState::Arrived), Some(Goal::Exact(a)), "once more");
        assert_eq!(executor.step(&s, &stopped), Some(Goal::Exact(Pose2::IDENTITY)));
        assert_eq!(executor.step(&s, &DriveState::Arrived), None);
        assert!(executor.is_idle());
        assert_eq!(executor.records().len(), 4);
        assert!(
            executor.failure().unwrap().to_string()
                == "task 1 (go to (1.00 m, 0.00 m, 0 deg)): a moving obstacle blocks the path"
        );
    }

    #[test]
    fn after_a_restart_the_mission_continues_and_done_tasks_stay_done() {
        let (grid, [a, b]) = (room(), [1.0, 2.0].map(|x| Pose2::new(x, 0.0, 0.0)));
        let mut first = executor(&[Task::go(a), Task::go(b), Task::Return]);
        let s = world(&grid);
        first.step(&s, &DriveState::Idle);
        assert_eq!(first.step(&s, &DriveState::Arrived), Some(Goal::Exact(b)));
        let mut second = executor(&[]);
        second.begin(&first.mission().after_restart());
        assert_eq!(second.step(&s, &DriveState::Idle), Some(Goal::Exact(b)));
        assert_eq!(second.step(&s, &DriveState::Arrived), Some(Goal::Exact(Pose2::IDENTITY)));
        let ended: Vec<_> = second.records().iter().map(|r| (r.index, r.before_restart)).collect();
        assert_eq!(ended, [(0, true), (1, false)]);
    }

    #[test]
    fn where_no_view_can_be_driven_to_nothing_was_explored() {
        let mut grid = room();
        for row in 1..6 {
            grid.set(trundle_core::CellIndex { col: 7, row }, trundle_core::Cell::Unknown);
        }
        let mut executor = executor(&[Task::Explore]);
        let s = world(&grid);
        assert_eq!(executor.step(&s, &DriveState::Idle), Some(Goal::Spin));
        let mut next = executor.step(&s, &DriveState::Arrived);
        let stopped = DriveState::Stopped { reason: Reason::PathOutOfView };
        while let Some(Goal::Viewpoint(_)) = next {
            next = executor.step(&s, &stopped);
        }
        assert!(executor.is_idle());
        assert!(executor.failure().unwrap().is_due_to(ReasonKind::PathOutOfView));
    }

    #[test]
    fn a_room_that_is_all_known_is_explored_with_one_turn() {
        let grid = room();
        let mut executor = executor(&[Task::Explore]);
        let s = world(&grid);
        assert_eq!(executor.step(&s, &DriveState::Idle), Some(Goal::Spin));
        assert_eq!(executor.step(&s, &DriveState::Initializing), None);
        assert_eq!(executor.step(&s, &DriveState::Arrived), Some(Goal::Stay));
        assert!(executor.is_idle() && executor.failure().is_none());
    }

    /// The same world on the contacts of a charging station.
    fn docked(grid: &OccupancyGrid) -> WorldState<'_> {
        let station = crate::world_state::StationState { is_docked: true, ..Default::default() };
        WorldState { station, ..world(grid) }
    }

    #[test]
    fn on_its_charging_station_a_robot_backs_off_before_any_task_and_a_dock_is_done() {
        let (grid, goal) = (room(), Pose2::new(1.0, 0.0, 0.0));
        let (on, off) = (docked(&grid), world(&grid));
        let mut early = executor(&[Task::go(goal), Task::Dock]);
        assert_eq!(early.step(&on, &DriveState::Idle), Some(UNDOCK));
        assert_eq!(early.step(&on, &DriveState::Maneuvering), None);
        assert_eq!(early.step(&off, &DriveState::Arrived), Some(Goal::Exact(goal)));
        assert_eq!(early.step(&on, &DriveState::Arrived), Some(UNDOCK), "still on the contacts");
        // The base reports its charger after the start of the task.
        let mut late = executor(&[Task::go(goal)]);
        assert_eq!(late.step(&off, &DriveState::Idle), Some(Goal::Exact(goal)));
        assert_eq!(late.step(&on, &DriveState::Initializing), Some(UNDOCK));
        let mut dock = executor(&[Task::Dock]);
        assert_eq!(dock.step(&on, &DriveState::Idle), Some(Goal::Stay));
        assert_eq!(dock.records()[0].end, TaskEnd::Done);
    }

    #[test]
    fn a_dock_without_light_turns_and_is_given_up_where_all_is_searched() {
        let grid = room();
        let (s, mut executor) = (world(&grid), executor(&[Task::Dock]));
        assert_eq!(executor.step(&s, &DriveState::Idle), Some(Goal::Spin));
        assert_eq!(executor.step(&s, &DriveState::Arrived), Some(Goal::Stay), "the room is small");
        assert!(executor.failure().unwrap().is_due_to(ReasonKind::NoStationLight));
    }

    /// One task per letter: `g` to a separate place, `r` back to the start.
    fn tasks(letters: &str) -> Vec<Task> {
        let task = |(i, letter)| match letter {
            'r' => Task::Return,
            _ => Task::go(Pose2::new(1.0 + i as f64, 0.0, 0.0)),
        };
        letters.chars().enumerate().map(task).collect()
    }

    /// Runs `executor` until no task is left, with the outcome of each goal in `fails`. Returns the goals.
    fn work_off(executor: &mut MissionExecutor, fails: &[bool]) -> Vec<Goal> {
        let (grid, mut fails) = (room(), fails.iter().copied().cycle());
        let (s, mut goals, mut state) = (world(&grid), Vec::new(), DriveState::Idle);
        while let Some(goal) = executor.step(&s, &state) {
            goals.push(goal);
            let is_failure = fails.next().unwrap_or_default();
            state = if is_failure {
                DriveState::Stopped { reason: Reason::PoseUnknown }
            } else {
                DriveState::Arrived
            };
        }
        goals
    }

    proptest! {
        #[test]
        fn each_task_ends_once_for_good_and_is_put_off_at_most_once(
            letters in "[gr]{1,7}", fails in prop::collection::vec(any::<bool>(), 1..12),
        ) {
            let tasks = tasks(&letters);
            let is_put_off = |record: &TaskRecord| matches!(record.end, TaskEnd::PutOff { .. });
            let mut executor = executor(&tasks);
            let goals = work_off(&mut executor, &fails);
            prop_assert!(executor.is_idle() && executor.mission().left.tasks().is_empty());
            prop_assert_eq!(goals.len(), executor.records().len(), "each goal ends with a record");
            for (index, task) in tasks.iter().enumerate() {
                let ends: Vec<_> = executor.records().iter().filter(|record| record.index == index).collect();
                let (last, before) = ends.split_last().unwrap();
                prop_assert!(before.len() <= 1 && before.iter().all(|record| is_put_off(record)));
                prop_assert!(!is_put_off(last), "{}", last.end);
                prop_assert!(ends.iter().all(|record| record.task == *task));
            }
            let undone = executor.records().iter().filter(|r| matches!(r.end, TaskEnd::GivenUp { .. })).count();
            prop_assert_eq!(executor.failure().is_some(), undone > 0);
        }

        #[test]
        fn a_return_at_the_end_stays_at_the_end(
            letters in "g{1,5}r", fails in prop::collection::vec(any::<bool>(), 1..12),
        ) {
            let mut executor = executor(&tasks(&letters));
            let goals = work_off(&mut executor, &fails);
            let returns = goals.iter().position(|goal| *goal == Goal::Exact(Pose2::IDENTITY));
            prop_assert_eq!(returns, Some(goals.len() - 1));
        }

        #[test]
        fn a_mission_that_is_restored_at_any_moment_gives_the_same_goals(
            letters in "[gr]{1,6}", fails in prop::collection::vec(any::<bool>(), 1..9), moment in 0..9_usize,
        ) {
            let (grid, tasks) = (room(), tasks(&letters));
            let s = world(&grid);
            let expected = work_off(&mut executor(&tasks), &fails);
            let mut first = executor(&tasks);
            let (mut state, moment) = (DriveState::Idle, moment % expected.len());
            for k in 0..=moment {
                prop_assert_eq!(first.step(&s, &state), Some(expected[k]));
                let reason = Reason::PoseUnknown;
                state = if fails[k % fails.len()] { DriveState::Stopped { reason } } else { DriveState::Arrived };
            }
            let mut second = executor(&[]);
            second.begin(&first.mission().after_restart());
            let rest: Vec<bool> = fails.iter().copied().cycle().skip(moment).take(20).collect();
            prop_assert_eq!(work_off(&mut second, &rest), &expected[moment..]);
            let is_old = |record: &&TaskRecord| record.before_restart;
            prop_assert_eq!(second.records().iter().filter(is_old).count(), moment);
        }
    }

    #[test]
    fn a_goal_that_fails_alone_is_given_up_without_a_second_try() {
        let mut executor = executor(&tasks("g"));
        assert_eq!(work_off(&mut executor, &[true]).len(), 1);
        assert!(matches!(executor.records()[0].end, TaskEnd::GivenUp { .. }));
    }

    #[test]
    fn a_restored_mission_is_still_that_of_the_operator() {
        let mut first = executor(&[]);
        first.begin(&MissionState::new(Mission::new(tasks("gg")).unwrap()).of_operator());
        let saved = serde_json::to_value(first.mission()).unwrap();
        assert_eq!(saved["by_operator"], true);
        let mut second = executor(&[]);
        second.begin(&serde_json::from_value(saved).unwrap());
        assert!(second.mission().by_operator);
        second.begin(&MissionState::default());
        assert!(serde_json::to_value(second.mission()).unwrap().get("by_operator").is_none());
    }

    #[test]
    fn a_new_mission_forgets_the_old_one_and_an_empty_one_leaves_nothing_to_do() {
        let (grid, mut executor) = (room(), executor(&tasks("gg")));
        let s = world(&grid);
        executor.step(&s, &DriveState::Idle);
        executor.step(&s, &DriveState::Arrived);
        assert_eq!((executor.records().len(), executor.task()), (1, Some(tasks("gg")[1])));
        executor.begin(&MissionState::new(Mission::new(vec![Task::Return]).unwrap()));
        assert!(executor.records().is_empty() && executor.task().is_none() && !executor.is_idle());
        executor.begin(&MissionState::default());
        assert!(executor.is_idle() && executor.failure().is_none());
        assert_eq!(executor.step(&s, &DriveState::Arrived), None);
        assert!(!executor.may_take_long(&s, &DriveState::Arrived));
    }
}
