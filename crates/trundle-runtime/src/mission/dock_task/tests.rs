//! The task of docking: the order of its motions, its repetitions, and each of its ends.

use super::*;
use crate::behaviour::navigator::testing::{at_rest, floor};
use crate::config::RobotConfig;
use crate::world_state::StationState;
use trundle_core::{Cell, CellIndex, OccupancyGrid, Stamp};

/// A docking task with the world that it reads.
struct Course {
    task: DockTask,
    grid: OccupancyGrid,
    pose: Pose2,
    now: Stamp,
    station: Option<StationEstimate>,
    is_docked: bool,
}

const STATION: Pose2 = Pose2 { x: 5.5, y: 2.0, theta: PI };

/// An estimate of the station with these standard deviations, across the axis \[m\] and heading \[rad\].
fn estimate(pose: Pose2, lateral_sigma: f64, heading_sigma: f64) -> StationEstimate {
    let variances = [1e-4, lateral_sigma * lateral_sigma, heading_sigma * heading_sigma];
    let covariance =
        std::array::from_fn(|i| std::array::from_fn(|k| if i == k { variances[i] } else { 0.0 }));
    StationEstimate { pose, covariance }
}

fn precise(pose: Pose2) -> StationEstimate {
    estimate(pose, 0.005, 0.01)
}

fn vague(pose: Pose2) -> StationEstimate {
    estimate(pose, 0.05, 0.1)
}

impl Course {
    /// The beginning of a task in a closed room of 6 x 4 m, 2 m before the station.
    fn new(station: Option<StationEstimate>) -> Self {
        let explorer = Explorer::new(RobotConfig::default().mission_executor.explore, 0.17).unwrap();
        let (task, mut grid) = (DockTask::new(Box::new(explorer)), floor(|_| false));
        let sides = (0..80).flat_map(|row| [0, 119].map(|col| CellIndex { col, row }));
        let ends = (0..120).flat_map(|col| [0, 79].map(|row| CellIndex { col, row }));
        sides.chain(ends).for_each(|cell| grid.set(cell, Cell::Occupied));
        Self { task, grid, pose: Pose2::new(3.5, 2.0, 0.0), now: Stamp::default(), station, is_docked: false }
    }

    fn step(&mut self, state: &DriveState) -> DockStep {
        self.now = self.now.after(0.02);
        let station = StationState { estimate: self.station, is_docked: self.is_docked };
        let s = WorldState { station, ..at_rest(&self.grid, self.now, self.pose) };
        self.task.step(&s, state)
    }

    /// The goal after the end of the last one.
    fn next(&mut self) -> Goal {
        match self.step(&DriveState::Arrived) {
            DockStep::Goal(goal) => {
                self.pose = goal.pose().unwrap_or(self.pose);
                goal
            }
            other => panic!("{other:?}"),
        }
    }

    /// The goals up to the first straight move onto the contacts.
    fn goals_up_to_contacts(&mut self) -> Vec<Goal> {
        let mut goals = vec![self.next()];
        while !matches!(goals.last(), Some(Goal::Station(StationGoal::Approach(_)))) {
            goals.push(self.next());
        }
        goals
    }
}

fn stopped(reason: Reason) -> DriveState {
    DriveState::Stopped { reason }
}

fn given_up(step: DockStep) -> ReasonKind {
    match step {
        DockStep::GivenUp(reason) => reason.kind(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_known_axis_is_staged_swept_aligned_and_driven_along_to_the_contacts() {
    let station = precise(STATION);
    let mut course = Course::new(Some(station));
    let staging = Goal::Exact(Pose2::new(4.8, 2.0, 0.0));
    let goals = course.goals_up_to_contacts();
    assert!(goals[0].pose().unwrap().distance(&staging.pose().unwrap()) < 1e-9, "{:?}", goals[0]);
    let sweep = Goal::Station(StationGoal::Sweep(STATION));
    let aligned = goals[2].pose().unwrap();
    assert_eq!(goals[1], sweep);
    assert!(matches!(goals[2], Goal::Align(_)) && aligned.distance(&staging.pose().unwrap()) < 1e-9);
    assert_eq!(goals[3], Goal::Station(StationGoal::Advance(station, NEAR_DISTANCE_M)));
    assert_eq!(goals[4..], [sweep, Goal::Station(StationGoal::Approach(station))]);
    course.is_docked = true;
    assert_eq!(course.step(&DriveState::Maneuvering), DockStep::Keep, "the motion ends first");
    assert_eq!(course.step(&DriveState::Arrived), DockStep::Done);
}

#[test]
fn each_attempt_without_charging_backs_off_and_the_third_one_is_the_last() {
    let mut course = Course::new(Some(precise(STATION)));
    for _ in 1..MAX_ATTEMPTS {
        course.goals_up_to_contacts();
        assert_eq!(course.next(), Goal::Station(StationGoal::BackOff(BACK_OFF_M)));
    }
    course.goals_up_to_contacts();
    assert_eq!(
        course.step(&DriveState::Arrived),
        DockStep::GivenUp(Reason::Docking(DockFailure::NoCharging { attempts: 3 }))
    );
}

#[test]
fn a_vague_axis_is_surveyed_from_both_sides_and_given_up_after_three_sweeps() {
    let mut course = Course::new(Some(vague(STATION)));
    for round in 1..=MAX_SURVEYS {
        let sides: Vec<f64> = (0..SURVEY_POSES.len())
            .map(|_| match course.next() {
                Goal::Viewpoint(pose) => (STATION.inverse() * pose).y,
                other => panic!("round {round}: {other:?}"),
            })
            .collect();
        assert!(sides.windows(2).all(|pair| pair[0] * pair[1] < 0.0), "the axis is crossed: {sides:?}");
        assert!(matches!(course.next(), Goal::Exact(_)));
        assert!(matches!(course.next(), Goal::Station(StationGoal::Sweep(_))));
        if round == MAX_SURVEYS {
            assert_eq!(given_up(course.step(&DriveState::Arrived)), ReasonKind::StationUncertain);
        }
    }
}

#[test]
fn a_survey_ends_as_soon_as_the_axis_is_known() {
    let mut course = Course::new(Some(vague(STATION)));
    assert!(matches!(course.next(), Goal::Viewpoint(_)));
    course.station = Some(precise(STATION));
    assert!(matches!(course.next(), Goal::Exact(_)), "the staging pose follows at once");
    // After the sweep the axis is elsewhere: the robot drives to the new staging pose.
    course.next();
    course.station = Some(precise(STATION * Pose2::new(0.0, 0.8, 0.0)));
    assert!(matches!(course.next(), Goal::Exact(pose) if (pose.y - 1.2).abs() < 1e-9));
}

#[test]
fn during_the_drive_a_moved_station_replaces_the_goal_at_most_once_a_second() {
    let mut course = Course::new(Some(precise(STATION)));
    course.next();
    let moved = |by: f64| Some(precise(STATION * Pose2::new(0.0, by, 0.0)));
    course.station = moved(0.9 * MOVED_GOAL_M);
    assert!((0..100).all(|_| course.step(&DriveState::Driving) == DockStep::Keep), "a small change");
    course.station = moved(1.1 * MOVED_GOAL_M);
    assert!(
        (0..60).all(|_| course.step(&DriveState::Maneuvering) == DockStep::Keep),
        "only a drive is changed"
    );
    let steps: Vec<DockStep> = (0..60).map(|_| course.step(&DriveState::Driving)).collect();
    let goals: Vec<&DockStep> = steps.iter().filter(|step| **step != DockStep::Keep).collect();
    let [DockStep::Goal(Goal::Exact(pose))] = goals[..] else { panic!("{goals:?}") };
    assert!((pose.y - (2.0 - 1.1 * MOVED_GOAL_M)).abs() < 1e-9, "{pose:?}");
    let drifting = (0..200).filter(|k| {
        course.station = moved(f64::from(*k) * 2.0 * MOVED_GOAL_M);
        course.step(&DriveState::Driving) != DockStep::Keep
    });
    let count = drifting.count();
    assert!((3..=5).contains(&count), "{count} goals in 4 s");
}

#[test]
fn light_on_the_way_ends_the_search() {
    let mut course = Course::new(None);
    assert_eq!(course.next(), Goal::Spin);
    let Goal::Viewpoint(_) = course.next() else { panic!("the room has places beyond the light's range") };
    assert!((0..100).all(|_| course.step(&DriveState::Driving) == DockStep::Keep));
    course.station = Some(precise(STATION));
    let found = (0..60).map(|_| course.step(&DriveState::Driving)).find(|step| *step != DockStep::Keep);
    assert!(matches!(found, Some(DockStep::Goal(Goal::Exact(_)))), "{found:?}");
}

/// Every place is searched by a turn, none twice, until the whole floor is searched.
#[test]
fn a_search_without_light_turns_at_each_place_once_and_ends() {
    let mut course = Course::new(None);
    let mut places = vec![course.pose];
    assert_eq!(course.next(), Goal::Spin);
    let end = loop {
        match course.step(&DriveState::Arrived) {
            DockStep::Goal(Goal::Viewpoint(place)) => {
                course.pose = place;
                assert_eq!(course.next(), Goal::Spin);
                places.push(place);
            }
            other => break other,
        }
        assert!(places.len() < 60, "{places:?}");
    };
    assert_eq!(given_up(end), ReasonKind::NoStationLight);
    let apart = |(i, a): (usize, &Pose2)| places[..i].iter().all(|b| a.distance(b) > 0.2);
    assert!(places.len() > 4 && places.iter().enumerate().all(apart), "{places:?}");
}

#[test]
fn light_that_is_lost_again_and_again_ends_the_task() {
    let mut course = Course::new(Some(precise(STATION)));
    for _ in 0..MAX_LOSSES {
        assert!(matches!(course.next(), Goal::Exact(_)));
        course.station = None;
        assert_eq!(course.next(), Goal::Spin, "the search begins anew");
        course.station = Some(precise(STATION));
    }
    course.next();
    course.station = None;
    assert_eq!(given_up(course.step(&DriveState::Arrived)), ReasonKind::StationLightLost);
}

#[test]
fn an_uncertain_arrival_at_the_staging_pose_goes_on_and_another_stop_ends_the_task() {
    let mut course = Course::new(Some(precise(STATION)));
    course.next();
    let step = course.step(&stopped(Reason::ArrivalContradicted));
    assert_eq!(
        step,
        DockStep::Goal(Goal::Station(StationGoal::Sweep(STATION))),
        "the rest is relative to the light"
    );
    let mut course = Course::new(Some(precise(STATION)));
    course.next();
    assert_eq!(given_up(course.step(&stopped(Reason::MovingObstacle))), ReasonKind::MovingObstacle);
}

#[test]
fn a_robot_on_the_contacts_is_done_without_a_motion() {
    let mut course = Course::new(None);
    course.is_docked = true;
    assert_eq!(course.step(&DriveState::Driving), DockStep::Done, "before its first goal");
}
