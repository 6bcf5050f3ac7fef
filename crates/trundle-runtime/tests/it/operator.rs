//! Commands of an operator to the whole robot: effect, report, and refusal without effect.

use crate::robot::{Base, robot, wall};
use trundle_core::{Beam, MapAnnotations, Pose2, Scan, SensorEvent, Stamp, Twist2, Vector2, WheelTicks};
use trundle_runtime::{
    DriveState, Mission, MotionHold, OperatorCommand, PoseGuess, RangeSource, Robot, RobotConfig, RunSetting,
    Task,
};

const GOAL: Pose2 = Pose2 { x: 1.5, y: 0.0, theta: 0.0 };

fn guess(pose: Pose2, position_sigma: f64, heading_sigma: f64) -> OperatorCommand {
    OperatorCommand::SetPose(PoseGuess { pose, position_sigma, heading_sigma })
}

/// Readings of wheels at rest from `from` to `to` s; the twists of the reports.
fn stand(robot: &mut Robot, (from, to): (f64, f64)) -> Vec<Twist2> {
    let stamps = ((from * 50.0) as i64..(to * 50.0) as i64).map(|i| Stamp::from_nanos(i * 20_000_000));
    let wheels = stamps.map(|stamp| SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 }));
    wheels.filter_map(|event| robot.step(&event).twist).collect()
}

#[test]
fn a_pause_stops_at_once_and_the_mission_goes_on_after_it() {
    let (mut robot, mut base) = (robot(GOAL), Base::default());
    let mut drive = |robot: &mut Robot, from: i64, to: i64| {
        let mut twists = Vec::new();
        for i in from * 50..to * 50 {
            let stamp = Stamp::from_nanos(i * 20_000_000);
            let [gyro, wheels] = base.on_wheels(stamp);
            robot.step(&gyro);
            let report = robot.step(&wheels);
            base.command(report.twist);
            twists.extend(report.twist);
            if i % 5 == 0 {
                robot.step(&wall(stamp, base.to_wall()));
            }
        }
        twists
    };
    assert!(drive(&mut robot, 0, 3).last().unwrap().v > 0.1);
    let tasks = robot.tasks_left();
    let report = robot.execute(OperatorCommand::Pause).unwrap();
    assert_eq!(report.twist, Some(Twist2::ZERO), "the stop waits for no reading");
    assert!(drive(&mut robot, 3, 4).iter().all(|twist| *twist == Twist2::ZERO));
    assert_eq!((robot.hold(), robot.tasks_left()), (Some(MotionHold::Paused), tasks));
    assert!(robot.execute(OperatorCommand::Pause).unwrap().twist.is_none(), "a second pause changes nothing");
    robot.execute(OperatorCommand::Continue).unwrap();
    assert_eq!(robot.hold(), None);
    drive(&mut robot, 4, 14);
    assert!(robot.estimate().pose.distance(&GOAL) < 0.05, "{:?}", robot.estimate().pose);
    assert_eq!(robot.tasks_ended().len(), 1);
}

#[test]
fn a_refused_command_names_the_number_and_changes_nothing() {
    let mut robot = robot(GOAL);
    stand(&mut robot, (0.0, 1.0));
    let state = |robot: &Robot| (robot.estimate(), robot.run_settings(), robot.hold(), robot.tasks_left());
    let before = state(&robot);
    for (command, field) in [
        (guess(Pose2 { x: f64::NAN, ..GOAL }, 0.1, 0.1), "x of the given pose"),
        (guess(GOAL, 0.0, 0.1), "standard deviation of the given position"),
        (guess(GOAL, 0.1, 4.0), "standard deviation of the given heading"),
        (OperatorCommand::Change(RunSetting::Speed(-0.1)), "speed limit"),
        (OperatorCommand::Change(RunSetting::Patience(f64::INFINITY)), "patience"),
        (OperatorCommand::Drive(Twist2::new(f64::NAN, 0.0)), "speed of the operator's twist"),
        (OperatorCommand::Drive(Twist2::new(0.0, f64::NAN)), "turn rate of the operator's twist"),
    ] {
        let refused = robot.execute(command.clone()).unwrap_err();
        assert_eq!(refused.field, field, "{command:?}");
        assert_eq!(state(&robot), before, "{command:?}");
    }
}

#[test]
fn a_given_pose_replaces_the_estimate_with_its_uncertainty() {
    let mut robot = robot(GOAL);
    stand(&mut robot, (0.0, 1.0));
    for (pose, position_sigma, heading_sigma) in
        [(Pose2::new(4.0, -2.0, 1.0), 0.2, 0.1), (Pose2::new(-7.0, 3.0, -3.0), 0.05, 0.02)]
    {
        let report = robot.execute(guess(pose, position_sigma, heading_sigma)).unwrap();
        let estimate = report.estimate.unwrap();
        assert!(
            estimate.pose.distance(&pose) < 0.01 && (estimate.pose.theta - pose.theta).abs() < 0.01,
            "{estimate:?}"
        );
        let (position, heading) = (estimate.position_sigma(), estimate.heading_sigma());
        assert!((0.5..2.0).contains(&(position / position_sigma)), "{position} m for {position_sigma} m");
        assert!((0.5..2.0).contains(&(heading / heading_sigma)), "{heading} rad for {heading_sigma} rad");
        assert!(!report.mission_replaced && !report.map_replaced);
    }
}

#[test]
fn a_mission_is_replaced_and_cancelled_and_the_report_says_so() {
    let mut robot = robot(GOAL);
    stand(&mut robot, (0.0, 0.5));
    let other = Mission::new(vec![Task::Explore, Task::Return]).unwrap();
    let report = robot.execute(OperatorCommand::Begin(other.clone())).unwrap();
    assert!(report.mission_replaced && !report.map_replaced);
    stand(&mut robot, (0.5, 0.6));
    assert_eq!(robot.tasks_left().unwrap(), other.tasks());
    assert!(robot.execute(OperatorCommand::cancel()).unwrap().mission_replaced);
    assert!(stand(&mut robot, (0.6, 1.5)).iter().all(|twist| *twist == Twist2::ZERO));
    assert_eq!(robot.tasks_left().unwrap(), []);
    let pause = robot.execute(OperatorCommand::Pause).unwrap();
    assert!(!pause.mission_replaced, "a pause keeps the mission");
}

#[test]
fn a_changed_setting_replaces_the_one_with_its_key() {
    let mut robot = robot(GOAL);
    let file = RobotConfig::default();
    let [_, turn_rate, _, ..] = RunSetting::all_of(&file);
    assert_eq!(robot.run_settings(), RunSetting::all_of(&file));
    robot.execute(OperatorCommand::Change(RunSetting::Patience(20.0))).unwrap();
    let first = |robot: &Robot| {
        let [speed, turn_rate, patience, ..] = robot.run_settings();
        [speed, turn_rate, patience]
    };
    assert_eq!(first(&robot), [RunSetting::Speed(file.limits.v), turn_rate, RunSetting::Patience(20.0)]);
    robot.execute(OperatorCommand::Change(RunSetting::Speed(0.3))).unwrap();
    robot.execute(OperatorCommand::Change(RunSetting::Speed(0.2))).unwrap();
    assert_eq!(first(&robot), [RunSetting::Speed(0.2), turn_rate, RunSetting::Patience(20.0)]);
}

#[test]
fn an_operators_twist_pauses_the_mission_until_it_is_continued() {
    let mut robot = robot(GOAL);
    stand(&mut robot, (0.0, 2.0));
    let tasks = robot.tasks_left();
    robot.execute(OperatorCommand::Drive(Twist2::new(0.1, 0.0))).unwrap();
    assert_eq!((robot.hold(), robot.tasks_left()), (Some(MotionHold::Paused), tasks.clone()));
    // Without an image the safety monitor stops the operator's twist too.
    assert!(stand(&mut robot, (2.0, 3.0)).iter().all(|twist| *twist == Twist2::ZERO));
    robot.execute(OperatorCommand::Continue).unwrap();
    assert_eq!((robot.hold(), robot.tasks_left()), (None, tasks));
}

#[test]
fn a_lost_link_for_goals_holds_the_robot_with_its_cause_until_the_program_is_started_anew() {
    let mut robot = robot(GOAL);
    stand(&mut robot, (0.0, 0.5));
    robot.execute(OperatorCommand::GoalLinkLost).unwrap();
    assert_eq!(robot.hold(), Some(MotionHold::GoalLinkLost));
    robot.execute(OperatorCommand::Pause).unwrap();
    robot.execute(OperatorCommand::Continue).unwrap();
    assert_eq!(robot.hold(), Some(MotionHold::GoalLinkLost), "a continuation does not bring the link back");
    assert!(stand(&mut robot, (0.5, 1.5)).iter().all(|twist| *twist == Twist2::ZERO));
}

#[test]
fn annotations_are_replaced_whole() {
    let mut robot = robot(GOAL);
    let named: MapAnnotations = serde_json::from_str(
        r#"{"places": [{"id": 1, "name": "desk", "pose": {"x": 1.0, "y": 0.0, "theta": 0.0}}]}"#,
    )
    .unwrap();
    robot.execute(OperatorCommand::Annotate(named.clone())).unwrap();
    assert_eq!(**robot.annotations(), named);
    robot.execute(OperatorCommand::Annotate(MapAnnotations::default())).unwrap();
    assert_eq!(**robot.annotations(), MapAnnotations::default());
    assert_eq!(
        robot.step(&SensorEvent::Wheels(WheelTicks { stamp: Stamp::default(), left: 0, right: 0 })).state,
        DriveState::Initializing
    );
}

/// The safety monitor cannot use a scan from before the first odometry: an operator's twist waits for the next scan.
#[test]
fn a_scan_before_the_first_odometry_lets_nobody_drive() {
    let mut config = RobotConfig::default();
    config.sight = RangeSource::Laser;
    let mut robot = Robot::new(config).unwrap();
    let scan = |seconds: f64, range: f64| {
        let stamp = Stamp::default().after(seconds);
        let beams = vec![Beam::Hit { range }; 180];
        SensorEvent::Scan(Scan::new(stamp, Vector2::zeros(), -1.57, 0.0174, beams).unwrap())
    };
    robot.step(&scan(0.01, 0.2));
    stand(&mut robot, (0.02, 0.1));
    let drive = |robot: &mut Robot, from: f64| {
        robot.execute(OperatorCommand::Drive(Twist2::new(0.2, 0.0))).unwrap();
        stand(robot, (from, from + 0.2)).last().unwrap().v
    };
    assert_eq!(drive(&mut robot, 0.1), 0.0, "an obstacle is 2 cm before the robot");
    robot.step(&scan(0.29, 2.0));
    assert!(drive(&mut robot, 0.3) > 0.0, "with odometry the scan shows free floor");
    robot.step(&scan(0.49, 0.2));
    assert_eq!(drive(&mut robot, 0.5), 0.0);
}
