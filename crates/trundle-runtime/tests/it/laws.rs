//! Laws of the whole robot: what holds for any goal, any input and any moment.

use crate::robot::{Base, robot, wall};
use proptest::prelude::*;
use trundle_core::{
    Beam, BodyEvent, BodyEventKind, Button, Cliff, Device, DifferentialDrive, DriveLimits, GyroRate, Link,
    OccupancyGrid, PerWheel, Pose2, RgbdImage, Scan, SensorEvent, Stamp, Touch, Twist2, Vector2, WheelTicks,
};
use trundle_runtime::{
    Checkpoint, DriveState, LazyImage, Mission, RangeSource, Robot, RobotConfig, StepReport, Task, TaskEnd,
    Worker,
};

/// Period of the control loop \[s\].
const STEP_S: f64 = 0.02;
/// Largest change of the speed between two commands \[m/s\].
const MAX_SPEED_CHANGE_M_S: f64 = DriveLimits::KOBUKI.acceleration * STEP_S + 1e-9;

/// Drives from `from` to `to` s with images at 10 Hz; every job is done immediately, except decisions from `away` s on.
fn drive(robot: &mut Robot, base: &mut Base, (from, to): (f64, f64), away: f64) -> Vec<StepReport> {
    let mut kept = Vec::new();
    let step = |i: i64| {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        let [gyro, wheels] = base.on_wheels(stamp);
        robot.step(&gyro);
        let mut report = robot.step(&wheels);
        if i % 5 == 0 {
            robot.step(&wall(stamp, base.to_wall()));
        }
        while let Some(job) = robot.next_job() {
            if job.worker() == Worker::Decision && stamp.as_secs() >= away {
                kept.push(job);
            } else {
                let twist = report.twist;
                report = robot.apply_answer(job.run());
                report.twist = report.twist.or(twist);
            }
        }
        base.command(report.twist);
        report
    };
    let reports = ((from / STEP_S) as i64..(to / STEP_S) as i64).map(step).collect();
    drop(kept);
    reports
}

fn speeds(reports: &[StepReport]) -> Vec<f64> {
    reports.iter().map(|report| report.twist.unwrap().v).collect()
}

#[test]
fn an_empty_mission_brakes_at_the_limit_of_acceleration_wherever_the_decision_is_made() {
    let goal = Pose2::new(1.8, 0.0, 0.0);
    let within: fn(Robot) -> Robot = |robot| robot;
    let beside: fn(Robot) -> Robot = Robot::with_background_jobs;
    for (made, away) in [(within, f64::INFINITY), (beside, f64::INFINITY), (beside, 2.9)] {
        let (mut robot, mut base) = (made(robot(goal)), Base::default());
        let before = speeds(&drive(&mut robot, &mut base, (0.0, 3.0), away));
        let mut last = *before.last().unwrap();
        assert!(last > 0.4, "{last} m/s");
        let seconds = last / DriveLimits::KOBUKI.acceleration;
        robot.begin(&Mission::default());
        let after = speeds(&drive(&mut robot, &mut base, (3.0, 3.2 + seconds), away));
        for speed in &after {
            let brakes = *speed < last || last == 0.0;
            assert!(brakes && last - speed <= MAX_SPEED_CHANGE_M_S, "{away}: {last} to {speed} m/s");
            last = *speed;
        }
        assert_eq!(after.last(), Some(&0.0), "it stands");
    }
}

#[test]
fn a_decision_for_a_mission_that_was_taken_back_is_not_sent() {
    let (mut robot, mut base) = (robot(Pose2::new(1.8, 0.0, 0.0)).with_background_jobs(), Base::default());
    drive(&mut robot, &mut base, (0.0, 3.0), f64::INFINITY);
    let mut i = 150;
    let job = loop {
        let [gyro, wheels] = base.on_wheels(Stamp::from_nanos(i * 20_000_000));
        robot.step(&gyro);
        base.command(robot.step(&wheels).twist);
        match robot.next_job() {
            Some(job) => break job,
            None => i += 1,
        }
    };
    assert_eq!(job.worker(), Worker::Decision);
    robot.begin(&Mission::default());
    let report = robot.apply_answer(job.run());
    assert_eq!((report.twist, report.state), (None, DriveState::Idle));
}

#[test]
fn another_goal_on_the_way_is_driven_to_without_a_stop() {
    let (mut robot, mut base) = (robot(Pose2::new(1.8, 0.0, 0.0)), Base::default());
    drive(&mut robot, &mut base, (0.0, 3.0), f64::INFINITY);
    let goal = Pose2::new(1.5, 0.0, 0.0);
    robot.drive_to(goal).unwrap();
    let reports = drive(&mut robot, &mut base, (3.0, 3.5), f64::INFINITY);
    assert!(speeds(&reports).iter().all(|speed| *speed > 0.2), "{:?}", speeds(&reports));
    assert!(reports.iter().all(|report| report.state == DriveState::Driving));
    let reports = drive(&mut robot, &mut base, (3.5, 12.0), f64::INFINITY);
    let last = reports.last().unwrap();
    assert!(last.finished && last.state == DriveState::Arrived, "{}", last.state);
    let [record] = robot.tasks_ended() else { panic!("{:?}", robot.tasks_ended()) };
    assert_eq!((&record.end, record.task), (&TaskEnd::Done, Task::go(goal)));
}

#[test]
fn a_checkpoint_made_during_a_task_keeps_this_task_and_the_following_ones() {
    let tasks = vec![Task::go(Pose2::new(1.8, 0.0, 0.0)), Task::Explore, Task::Return];
    let mut robot = Robot::new(RobotConfig::default()).unwrap();
    robot.begin(&Mission::new(tasks.clone()).unwrap());
    drive(&mut robot, &mut Base::default(), (0.0, 2.5), f64::INFINITY);
    assert_eq!(robot.task(), Some(tasks[0]));
    let checkpoint = Checkpoint::from_bytes(&robot.checkpoint().unwrap().to_bytes()).unwrap();
    assert_eq!((checkpoint.mission.left.tasks(), checkpoint.mission.places), (&tasks[..], vec![0, 1, 2]));
    assert_eq!(&checkpoint.grid, robot.grid());
}

#[test]
fn a_robot_on_a_given_map_knows_it_from_the_first_step_and_a_map_of_other_cells_is_refused() {
    let resolution = RobotConfig::default().mapping.resolution;
    let row = ".".repeat(40) + "#\n";
    let map = OccupancyGrid::from_ascii(resolution, &row.repeat(40)).unwrap();
    let robot = Robot::on_map(RobotConfig::default(), &map).unwrap();
    let at = |x: f64| robot.grid().at(Vector2::new(x * resolution, 0.5));
    assert_eq!(at(40.5), trundle_core::Cell::Occupied);
    assert_eq!(at(20.5), trundle_core::Cell::Free);
    let coarse = OccupancyGrid::from_ascii(2.0 * resolution, &row).unwrap();
    let error = Robot::on_map(RobotConfig::default(), &coarse).unwrap_err();
    assert!(error.to_string().contains("resolution"), "{error}");
}

#[test]
fn an_image_that_cannot_be_decoded_is_reported_and_shows_nothing() {
    let mut robot = robot(Pose2::new(1.0, 0.0, 0.0));
    robot.step(&SensorEvent::Wheels(WheelTicks { stamp: Stamp::default(), left: 0, right: 0 }));
    let report = robot.queue_image(LazyImage::new(Stamp::default(), || Err("no JPEG".to_owned())));
    assert_eq!((report.broken_image.as_deref(), report.image), (Some("no JPEG"), None));
    assert!(report.track.is_none() && robot.scan().is_none());
}

#[test]
fn a_camera_that_repeats_one_image_is_noticed_and_the_robot_stops() {
    let (mut robot, mut base) = (robot(Pose2::new(1.8, 0.0, 0.0)), Base::default());
    drive(&mut robot, &mut base, (0.0, 2.5), f64::INFINITY);
    assert_eq!(robot.frozen_images(), 0);
    let SensorEvent::Rgbd(image) = wall(Stamp::default(), base.to_wall()) else { unreachable!("an image") };
    let mut twist = None;
    for i in 125..200 {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        let [gyro, wheels] = base.on_wheels(stamp);
        robot.step(&gyro);
        twist = robot.step(&wheels).twist;
        base.command(twist);
        if i % 5 == 0 {
            let again = RgbdImage::new(stamp, image.color().clone(), image.depth().clone()).unwrap();
            robot.step(&SensorEvent::Rgbd(again));
        }
    }
    assert!(robot.frozen_images() >= 10, "{}", robot.frozen_images());
    assert_eq!(twist, Some(Twist2::ZERO));
}

/// Any reading of any sensor but the camera, with numbers that no sensor should give.
fn any_event() -> impl Strategy<Value = SensorEvent> {
    let stamp = || (-2_000_000_000..9_000_000_000_i64).prop_map(Stamp::from_nanos);
    let number = || prop_oneof![-9.0..9.0_f64, Just(f64::NAN), Just(f64::INFINITY), Just(1e300)];
    let wheels = (stamp(), any::<u16>(), any::<u16>());
    let scan = (stamp(), prop::collection::vec(0.1..9.0_f64, 3..40)).prop_map(|(stamp, ranges)| {
        let beams = ranges.iter().map(|range| Beam::Hit { range: *range }).collect();
        SensorEvent::Scan(Scan::new(stamp, Vector2::zeros(), -0.5, 0.05, beams).unwrap())
    });
    prop_oneof![
        wheels.prop_map(|(stamp, left, right)| SensorEvent::Wheels(WheelTicks { stamp, left, right })),
        (stamp(), number()).prop_map(|(stamp, omega)| SensorEvent::Gyro(GyroRate { stamp, omega })),
        (stamp(), any::<bool>()).prop_map(|(stamp, pressed)| SensorEvent::Touch(Touch { stamp, pressed })),
        (stamp(), any::<bool>())
            .prop_map(|(stamp, over_edge)| SensorEvent::Cliff(Cliff { stamp, over_edge })),
        (stamp(), body_event()).prop_map(|(stamp, kind)| SensorEvent::Body(BodyEvent::new(stamp, kind))),
        scan,
    ]
}

fn body_event() -> impl Strategy<Value = BodyEventKind> {
    let wheels = (any::<bool>(), any::<bool>()).prop_map(|(left, right)| PerWheel { left, right });
    let device = prop_oneof![Just(Device::Base), Just(Device::Camera), Just(Device::Laser)];
    prop_oneof![
        wheels.prop_map(BodyEventKind::WheelDrop),
        (device, any::<bool>()).prop_map(|(device, is_up)| BodyEventKind::Link(Link { device, is_up })),
        (0..3_u8, any::<bool>())
            .prop_map(|(index, pressed)| BodyEventKind::Button(Button { index, pressed })),
        Just(BodyEventKind::Silence),
    ]
}

fn laser_robot() -> Robot {
    let mut config = RobotConfig::default();
    config.sight = RangeSource::Laser;
    config.mission_executor.opening = 0.0;
    let mut robot = Robot::new(config).unwrap();
    robot.begin(
        &Mission::new(vec![Task::Explore, Task::go(Pose2::new(1.0, 1.0, 0.0)), Task::Return]).unwrap(),
    );
    robot
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn for_any_sensor_events_commands_are_finite_and_within_the_limits(
        events in prop::collection::vec(any_event(), 1..120),
    ) {
        let mut robot = laser_robot();
        for event in &events {
            let report = robot.step(event);
            if !matches!(event, SensorEvent::Body(_)) {
                prop_assert_eq!(report.twist.is_some(), matches!(event, SensorEvent::Wheels(_)));
            }
            let twist = report.twist.unwrap_or_default();
            let within = DriveLimits::KOBUKI.saturate(twist, DifferentialDrive::KOBUKI.wheelbase);
            prop_assert!((within.v - twist.v).abs() + (within.omega - twist.omega).abs() < 1e-9, "{:?}", twist);
            prop_assert!(report.estimate.is_some_and(|estimate| estimate.pose.is_finite()), "{:?}", event);
        }
    }

    #[test]
    fn with_the_bumper_pressed_and_an_edge_ahead_no_command_goes_forward(
        events in prop::collection::vec(any_event(), 1..80), is_edge in any::<bool>(),
    ) {
        let (mut robot, stamp) = (laser_robot(), Stamp::default());
        let held = |event: &SensorEvent| matches!(event, SensorEvent::Touch(_) | SensorEvent::Cliff(_));
        robot.step(&if is_edge {
            SensorEvent::Cliff(Cliff { stamp, over_edge: true })
        } else {
            SensorEvent::Touch(Touch { stamp, pressed: true })
        });
        for event in events.iter().filter(|event| !held(event)) {
            let twist = robot.step(event).twist.unwrap_or_default();
            prop_assert!(twist.v <= 0.0, "{twist:?}");
        }
    }
}
