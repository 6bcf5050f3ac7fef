//! Tasks in order: their goals, their ends, and second attempts.

use super::*;
use crate::mission::TaskGoal;
use crate::reason::ReasonKind;
use proptest::prelude::*;
use trundle_core::{OccupancyGrid, PoseEstimate, Twist2};

fn world(grid: &OccupancyGrid) -> WorldState<'_> {
    let (stamp, covariance) = (Stamp::default(), nalgebra::Matrix3::zeros());
    let estimate = PoseEstimate { stamp, pose: Pose2::new(0.35, 0.35, 0.0), twist: Twist2::ZERO, covariance };
    WorldState {
        now: stamp,
        pose_status: crate::behaviour::navigator::testing::KNOWN_POSE,
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
    OccupancyGrid::from_ascii(0.1, "########\n#......#\n#......#\n#......#\n#......#\n#......#\n########\n")
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

#[test]
fn a_goal_to_pass_through_ends_within_its_tolerance_while_the_robot_drives() {
    let grid = room();
    let options = GoalOptions { tolerance: Some(0.3), pass_through: true, ..GoalOptions::default() };
    let via = |x: f64| Task::Go(TaskGoal::new(Pose2::new(x, 0.35, 0.0), options));
    let end = Pose2::new(2.0, 0.0, 0.0);
    let mut executor = executor(&[via(0.7), via(1.2), Task::go(end)]);
    let mut s = world(&grid);
    assert_eq!(executor.step(&s, &DriveState::Idle), Some(Goal::Exact(Pose2::new(0.7, 0.35, 0.0))));
    assert_eq!(executor.step(&s, &DriveState::Driving), None, "0.35 m off");
    s.estimate.pose.x = 0.45;
    assert!(executor.may_take_long(&s, &DriveState::Driving), "the next goal is planned for at once");
    assert_eq!(executor.step(&s, &DriveState::Driving), Some(Goal::Exact(Pose2::new(1.2, 0.35, 0.0))));
    let stopped = DriveState::Stopped { reason: Reason::MovingObstacle };
    assert_eq!(executor.step(&s, &stopped), Some(Goal::Exact(end)), "not tried again");
    assert_eq!(executor.step(&s, &DriveState::Arrived), None);
    let ends: Vec<_> = executor.records().iter().map(|record| record.end == TaskEnd::Done).collect();
    assert_eq!(ends, [true, false, true]);
}

#[test]
fn the_last_goal_is_driven_to() {
    let grid = room();
    let options = GoalOptions { tolerance: Some(0.5), pass_through: true, ..GoalOptions::default() };
    let mut executor = executor(&[Task::Go(TaskGoal::new(Pose2::new(0.5, 0.35, 0.0), options))]);
    let s = world(&grid);
    assert!(executor.step(&s, &DriveState::Idle).is_some());
    assert_eq!(executor.step(&s, &DriveState::Driving), None);
    assert!(!executor.is_idle());
}
