//! The states that a robot comes to, and their typed reasons.

use crate::robot::{Base, robot, wall};
use trundle_core::{Cliff, Pose2, SensorEvent, Stamp, Touch, Twist2, WheelTicks};
use trundle_runtime::{
    DriveState, Mission, Reason, ReasonKind, Robot, RobotConfig, StepReport, Task, TaskEnd,
};

/// Drives with images at 10 Hz from `from` to `to`, s.
fn drive(robot: &mut Robot, base: &mut Base, from: f64, to: f64) -> Vec<StepReport> {
    let step = |i: i64| {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        let [gyro, wheels] = base.on_wheels(stamp);
        robot.step(&gyro);
        let report = robot.step(&wheels);
        base.command(report.twist);
        if i % 5 == 0 {
            robot.step(&wall(stamp, base.to_wall()));
        }
        report
    };
    ((from * 50.0) as i64..(to * 50.0) as i64).map(step).collect()
}

/// The names of the states in order, without repetitions.
fn names(reports: &[StepReport]) -> Vec<&'static str> {
    let mut names: Vec<_> = reports.iter().map(|report| report.state.name()).collect();
    names.dedup();
    names
}

fn wheels(ms: i64) -> SensorEvent {
    SensorEvent::Wheels(WheelTicks { stamp: Stamp::from_nanos(ms * 1_000_000), left: 0, right: 0 })
}

#[test]
fn a_goal_ahead_is_reached_by_way_of_the_documented_states() {
    let reports = drive(&mut robot(Pose2::new(0.4, 0.0, 0.0)), &mut Base::default(), 0.0, 9.0);
    let names = names(&reports);
    assert_eq!(names[0], "initializing");
    assert!(names.contains(&"driving"), "{names:?}");
    assert_eq!(*names.last().unwrap(), "arrived", "{names:?}");
    let last = reports.last().unwrap();
    assert!(last.finished && last.twist == Some(Twist2::ZERO));
    assert!(last.state.reason().is_none() && last.state.is_over());
    let pose = last.estimate.unwrap().pose;
    assert!(pose.distance(&Pose2::new(0.4, 0.0, 0.0)) < 0.05, "{pose:?}");
}

#[test]
fn a_robot_without_a_mission_idles_and_an_empty_mission_stops_it() {
    let mut idle = Robot::new(RobotConfig::default()).unwrap();
    let report = idle.step(&wheels(0));
    assert_eq!((report.state, report.twist, report.finished), (DriveState::Idle, Some(Twist2::ZERO), false));

    let (mut robot, mut base) = (robot(Pose2::new(1.5, 0.0, 0.0)), Base::default());
    let reports = drive(&mut robot, &mut base, 0.0, 3.0);
    assert_eq!(reports.last().unwrap().state, DriveState::Driving);
    robot.begin(&Mission::default());
    let reports = drive(&mut robot, &mut base, 3.0, 6.0);
    assert!(reports.iter().all(|report| report.state == DriveState::Idle));
    let speeds: Vec<f64> = reports.iter().map(|report| report.twist.unwrap().v).collect();
    assert!(speeds[speeds.len() - 1] < speeds[0], "it brakes: {speeds:?}");
}

#[test]
fn an_edge_ahead_holds_the_robot_with_the_kind_cliff() {
    let (mut robot, mut base) = (robot(Pose2::new(1.5, 0.0, 0.0)), Base::default());
    drive(&mut robot, &mut base, 0.0, 3.0);
    robot.step(&SensorEvent::Cliff(Cliff { stamp: Stamp::from_nanos(3_000_000_000), over_edge: true }));
    let reports = drive(&mut robot, &mut base, 3.0, 3.5);
    let DriveState::Waiting { reason } = &reports.last().unwrap().state else {
        panic!("{:?}", names(&reports))
    };
    assert_eq!(reason.kind(), ReasonKind::Cliff);
    robot.step(&SensorEvent::Cliff(Cliff { stamp: Stamp::from_nanos(3_500_000_000), over_edge: false }));
    let reports = drive(&mut robot, &mut base, 3.5, 6.0);
    assert!(names(&reports).contains(&"driving"), "it goes on: {:?}", names(&reports));
}

#[test]
fn the_third_contact_gives_the_goal_up_and_a_new_goal_counts_anew() {
    let mut robot = robot(Pose2::new(1.0, 0.0, 0.0));
    robot.step(&wheels(0));
    let press = |robot: &mut Robot, times: usize| {
        for pressed in [true, false].repeat(times) {
            robot.step(&SensorEvent::Touch(Touch { stamp: Stamp::default(), pressed }));
        }
    };
    press(&mut robot, 2);
    assert_eq!(robot.step(&wheels(20)).state, DriveState::Initializing);
    press(&mut robot, 1);
    let report = robot.step(&wheels(40));
    assert!(report.finished);
    let [record] = robot.tasks_ended() else { panic!("{:?}", robot.tasks_ended()) };
    assert_eq!(record.end, TaskEnd::GivenUp { reason: Reason::RepeatedContact { contacts: 3 } });
    robot.drive_to(Pose2::new(2.0, 0.0, 0.0)).unwrap();
    robot.step(&wheels(60));
    press(&mut robot, 2);
    assert_eq!(robot.step(&wheels(80)).state, DriveState::Initializing);
}

#[test]
fn patience_ends_with_the_reason_behind_it() {
    let mut config = RobotConfig::default();
    config.mission_executor.patience = 2.0;
    let mut robot = Robot::new(config).unwrap();
    robot.begin(&Mission::new(vec![Task::go(Pose2::new(1.0, 0.0, 0.0)), Task::Return]).unwrap());
    let reports: Vec<_> = (0..300).map(|i| robot.step(&wheels(20 * i))).collect();
    let [first, ..] = robot.tasks_ended() else { panic!("nothing ended: {:?}", names(&reports)) };
    let TaskEnd::PutOff { reason } = &first.end else { panic!("{}", first.end) };
    assert_eq!(reason.to_string(), "no progress for 2 s: initializing");
    assert_eq!(reason.kinds(), [ReasonKind::NoProgress]);
}

#[test]
fn a_mission_is_over_when_all_tasks_are_and_names_each_undone_one() {
    let mut config = RobotConfig::default();
    config.mission_executor.patience = 1.0;
    let mut robot = Robot::new(config).unwrap();
    let far = |x| Task::go(Pose2::new(x, 0.0, 0.0));
    robot.begin(&Mission::new(vec![far(1.0), far(2.0)]).unwrap());
    let last = (0..500).map(|i| robot.step(&wheels(20 * i))).find(|report| report.finished).unwrap();
    let ends: Vec<_> =
        robot.tasks_ended().iter().map(|record| (record.index, record.end.to_string())).collect();
    assert_eq!(ends.iter().map(|(index, _)| *index).collect::<Vec<_>>(), [0, 1, 0, 1], "{ends:?}");
    assert!(ends[0].1.starts_with("put off") && ends[2].1.starts_with("given up"), "{ends:?}");
    let DriveState::Stopped { reason: Reason::TasksFailed(failures) } = &last.state else {
        panic!("{}", last.state)
    };
    let mut undone: Vec<_> = failures.iter().map(|failure| failure.index).collect();
    undone.sort_unstable();
    assert_eq!(undone, [0, 1]);
}

#[test]
fn goals_that_are_not_numbers_are_refused() {
    let mut robot = Robot::new(RobotConfig::default()).unwrap();
    for (goal, field) in [(Pose2::new(f64::NAN, 0.0, 0.0), "x"), (Pose2::new(0.0, f64::INFINITY, 0.0), "y")] {
        let refusal = robot.drive_to(goal).unwrap_err();
        assert_eq!(refusal.field, format!("{field} of the goal of task 1"));
    }
    assert_eq!(robot.step(&wheels(0)).state, DriveState::Idle, "a refused goal changes nothing");
}
