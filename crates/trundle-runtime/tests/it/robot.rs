//! The robot on made events: blind cameras, stuck wheels, blocked goals.

use trundle_core::{
    Beam, DepthImage, DifferentialDrive, GyroRate, Image, PinholeCamera, Pose2, RgbdImage, Scan, SensorEvent,
    Stamp, Touch, Twist2, Vector2, WheelTicks,
};
use trundle_runtime::{
    Checkpoint, CheckpointError, DriveState, GoalOptions, Mission, RangeSource, ReasonKind, Robot,
    RobotConfig, StepReport, Task, TaskEnd, TaskGoal,
};

/// A wall of one colour across the view, `distance` m ahead of the base, and the floor before it, as the default mount sees them.
pub fn wall(stamp: Stamp, distance: f64) -> SensorEvent {
    let camera = PinholeCamera::kinect_v2();
    let base_from_camera = RobotConfig::default().mount.base_from_camera();
    let (width, height) = (camera.width(), camera.height());
    // No two images of a real camera are equal.
    let color = Image::filled(width, height, [90, (stamp.nanos / 20_000_000 % 100) as u8, 90]);
    let depth = DepthImage::from_fn(width, height, |x, y| {
        let ray = base_from_camera.rotate(camera.unproject(Vector2::new(x as f64, y as f64), 1.0));
        let to_wall = (distance - base_from_camera.translation.x) / ray.x;
        let to_floor = if ray.z < 0.0 { -base_from_camera.translation.z / ray.z } else { f64::INFINITY };
        let depth = to_wall.min(to_floor);
        if depth > 0.5 && depth < 8.0 { depth as f32 } else { 0.0 }
    });
    SensorEvent::Rgbd(RgbdImage::new(stamp, color, depth).unwrap())
}

/// A base that follows each command immediately.
#[derive(Debug, Default)]
pub struct Base {
    command: Twist2,
    pose: Pose2,
    lengths: (f64, f64),
}

impl Base {
    /// A step of 20 ms on, to `stamp`: the readings of gyro and wheels.
    pub fn on_wheels(&mut self, stamp: Stamp) -> [SensorEvent; 2] {
        let drive = DifferentialDrive::KOBUKI;
        let (left, right) = drive.wheel_speeds(self.command);
        self.pose = self.pose.advance(self.command, 0.02);
        self.lengths = (self.lengths.0 + left * 0.02, self.lengths.1 + right * 0.02);
        let ticks = |length: f64| ((length / drive.metres_per_tick()) as i64).rem_euclid(65_536) as u16;
        let wheels = WheelTicks { stamp, left: ticks(self.lengths.0), right: ticks(self.lengths.1) };
        [SensorEvent::Gyro(GyroRate { stamp, omega: self.command.omega }), SensorEvent::Wheels(wheels)]
    }

    /// The command from now on.
    pub fn command(&mut self, twist: Option<Twist2>) {
        self.command = twist.unwrap_or(self.command);
    }

    /// Pose since the start.
    pub fn twist(&self) -> Twist2 {
        self.command
    }

    /// The true pose, relative to the start.
    pub fn pose(&self) -> Pose2 {
        self.pose
    }

    /// Distance of a wall that was 3 m ahead at the start, m.
    pub fn to_wall(&self) -> f64 {
        3.0 - self.pose.x
    }
}

/// Lets a robot drive straight towards a wall 3 m ahead from `from` to `to` s; images come at 10 Hz until `until`, s.
fn drive(robot: &mut Robot, base: &mut Base, (from, to): (f64, f64), until: f64) -> Vec<StepReport> {
    let steps = (from * 50.0) as i64..(to * 50.0) as i64;
    let step = |i: i64| {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        let [gyro, wheels] = base.on_wheels(stamp);
        robot.step(&gyro);
        let report = robot.step(&wheels);
        base.command(report.twist);
        if i % 5 == 0 && stamp.as_secs() < until {
            robot.step(&wall(stamp, base.to_wall()));
        }
        report
    };
    steps.map(step).collect()
}

/// Feeds a robot at rest for `seconds`: wheels and gyro at 50 Hz, and the result of `image` at 10 Hz.
fn stand(robot: &mut Robot, seconds: f64, image: impl Fn(Stamp) -> Option<SensorEvent>) -> Vec<StepReport> {
    let mut reports = Vec::new();
    for i in 0..(seconds * 50.0) as i64 {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        robot.step(&SensorEvent::Gyro(GyroRate { stamp, omega: 0.0 }));
        reports.push(robot.step(&SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 })));
        if i % 5 == 0
            && let Some(event) = image(stamp)
        {
            robot.step(&event);
        }
    }
    reports
}

/// A robot that shall drive to `goal`.
pub fn robot(goal: Pose2) -> Robot {
    let mut robot = Robot::new(RobotConfig::default()).unwrap();
    robot.drive_to(goal).unwrap();
    robot
}

#[test]
fn a_blind_robot_does_not_move() {
    let reports = stand(&mut robot(Pose2::new(1.0, 0.0, 0.0)), 5.0, |_| None);
    assert!(reports.iter().all(|report| report.twist == Some(Twist2::ZERO)));
    assert!(reports.iter().all(|report| report.state == DriveState::Initializing));
}

#[test]
fn it_starts_when_the_path_is_in_view_and_stops_when_images_stop() {
    let mut robot = robot(Pose2::new(1.5, 0.0, 0.0));
    let reports = drive(&mut robot, &mut Base::default(), (0.0, 5.0), 3.0);
    assert!(reports[120..150].iter().any(|report| report.twist.unwrap().v > 0.05));
    let last = reports.last().unwrap();
    assert_eq!(last.twist, Some(Twist2::ZERO));
    let DriveState::Waiting { reason } = &last.state else { panic!("{:?}", last.state) };
    assert!(reason.is_due_to(ReasonKind::ImageMissing), "{reason}");
}

#[test]
fn it_passes_a_goal_on_its_way_without_a_stop() {
    let mut options = GoalOptions::default();
    (options.tolerance, options.pass_through) = (Some(0.3), true);
    let via = Task::Go(TaskGoal::new(Pose2::new(0.8, 0.0, 0.0), options));
    let mut robot = Robot::new(RobotConfig::default()).unwrap();
    robot.begin(&Mission::new(vec![via, Task::go(Pose2::new(1.6, 0.0, 0.0))]).unwrap());
    let reports = drive(&mut robot, &mut Base::default(), (0.0, 15.0), 15.0);
    let [passed, arrived] = robot.tasks_ended() else { panic!("{:?}", robot.tasks_ended()) };
    assert!(passed.end == TaskEnd::Done && arrived.end == TaskEnd::Done);
    assert!(
        (0.45..0.6).contains(&passed.pose.x) && (arrived.pose.x - 1.6).abs() < 0.03,
        "{passed:?} {arrived:?}"
    );
    let at = (passed.to.as_secs() * 50.0) as usize;
    let slowest = reports[at - 25..at + 25].iter().map(|report| report.twist.unwrap().v).fold(1.0, f64::min);
    assert!(slowest > 0.25, "{slowest} m/s");
}

#[test]
fn wheels_that_count_nothing_stop_it_without_a_visual_motion() {
    let mut robot = robot(Pose2::new(1.0, 0.0, 0.0));
    let reports = stand(&mut robot, 4.0, |stamp| Some(wall(stamp, 3.0)));
    let driven: f64 = reports.iter().map(|report| report.twist.unwrap().v * 0.02).sum();
    assert!((0.02..0.2).contains(&driven), "{driven} m before it was noticed");
    let last = reports.last().unwrap();
    assert_eq!(last.twist.unwrap().v, 0.0);
    assert!(
        last.state.reason().is_some_and(|reason| reason.to_string().contains("do not count")),
        "{:?}",
        last.state
    );
    let sigma = |report: &StepReport| report.estimate.unwrap().covariance[(0, 0)].sqrt();
    let max = reports.iter().map(sigma).fold(0.0, f64::max);
    assert!(
        (0.5 * driven..3.0 * driven).contains(&max),
        "{max} m after {driven} m that the encoders did not count"
    );
}

#[test]
fn a_goal_in_a_wall_makes_it_look_around_not_drive() {
    let mut robot = robot(Pose2::new(3.0, 0.0, 0.0));
    let reports = stand(&mut robot, 4.0, |stamp| Some(wall(stamp, 3.0)));
    assert!(reports.iter().all(|report| report.twist.unwrap().v == 0.0));
    let last = reports.last().unwrap();
    assert!(
        matches!(&last.state, DriveState::Recovering { reason } if reason.to_string().contains("goal")),
        "{:?}",
        last.state
    );
    assert!(last.twist.unwrap().omega > 0.1);
}

#[test]
fn a_pressed_bumper_stops_it() {
    let mut robot = robot(Pose2::new(1.0, 0.0, 0.0));
    robot.step(&SensorEvent::Touch(Touch { stamp: Stamp::default(), pressed: true }));
    let reports = stand(&mut robot, 4.0, |stamp| Some(wall(stamp, 3.0)));
    assert!(reports.iter().all(|report| report.twist.unwrap().v <= 0.0));
}

#[test]
fn from_a_pressed_bumper_it_backs_out_slowly() {
    let (mut robot, mut base) = (robot(Pose2::new(1.5, 0.0, 0.0)), Base::default());
    drive(&mut robot, &mut base, (0.0, 3.0), f64::INFINITY);
    robot.step(&SensorEvent::Touch(Touch { stamp: Stamp::from_nanos(3_000_000_000), pressed: true }));
    let reports = drive(&mut robot, &mut base, (3.0, 5.0), f64::INFINITY);
    let twists: Vec<Twist2> = reports.iter().map(|report| report.twist.unwrap()).collect();
    assert!(twists[..45].iter().all(|twist| *twist == Twist2::ZERO), "first it stands");
    assert!(twists[60..].iter().all(|twist| *twist == Twist2::new(-0.05, 0.0)), "{:?}", twists.last());
}

#[test]
fn the_same_events_give_the_same_reports() {
    let run = || stand(&mut robot(Pose2::new(1.0, 0.5, 1.0)), 3.0, |stamp| Some(wall(stamp, 3.0)));
    let twists =
        |reports: Vec<StepReport>| reports.into_iter().map(|report| report.twist).collect::<Vec<_>>();
    assert_eq!(twists(run()), twists(run()));
}

/// A laser's sweep of a wall across the view, `distance` m ahead.
fn on_laser(stamp: Stamp, distance: f64) -> SensorEvent {
    let beam = |i: i32| {
        let range = distance / (f64::from(i).to_radians()).cos();
        if i.abs() < 80 && range < 10.0 { Beam::Hit { range } } else { Beam::Free { range: 10.0 } }
    };
    let (first, step) = ((-135_f64).to_radians(), 1_f64.to_radians());
    SensorEvent::Scan(
        Scan::new(stamp, Vector2::zeros(), first, step, (-135..=135).map(beam).collect()).unwrap(),
    )
}

/// A robot of 0.5 x 0.4 m that sees with a laser.
fn box_with_laser() -> RobotConfig {
    let mut config = RobotConfig::default();
    config.sight = RangeSource::Laser;
    config.footprint = Some(vec![[0.25, 0.2], [-0.25, 0.2], [-0.25, -0.2], [0.25, -0.2]]);
    config
}

#[test]
fn with_a_laser_it_needs_no_camera_and_stops_when_the_scans_stop() {
    let mut robot = Robot::new(box_with_laser()).unwrap();
    robot.drive_to(Pose2::new(1.0, 0.0, 0.0)).unwrap();
    let until = Stamp::from_nanos(3_000_000_000);
    let reports = stand(&mut robot, 5.0, |stamp| (stamp < until).then(|| on_laser(stamp, 3.0)));
    assert!(reports[120..150].iter().any(|report| report.twist.unwrap().v > 0.05));
    let last = reports.last().unwrap();
    assert_eq!(last.twist, Some(Twist2::ZERO));
    assert!(
        last.state.reason().is_some_and(|reason| reason.to_string().contains("scan")),
        "{:?}",
        last.state
    );
    assert_eq!(robot.grid().at(Vector2::new(3.01, 0.0)), trundle_core::Cell::Occupied);
}

#[test]
fn a_camera_robot_takes_no_scan_for_sight() {
    let mut robot = robot(Pose2::new(1.0, 0.0, 0.0));
    let reports = stand(&mut robot, 3.0, |stamp| Some(on_laser(stamp, 3.0)));
    assert!(reports.iter().all(|report| report.twist == Some(Twist2::ZERO)));
}

#[test]
fn a_resumed_robot_has_its_map_and_maps_nothing_until_its_pose_is_known() {
    let mut first = robot(Pose2::new(1.0, 0.0, 0.0)).with_checkpoints();
    let memory = (0..300)
        .filter_map(|i| {
            let stamp = Stamp::from_nanos(i * 50_000_000);
            first.step(&SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 }));
            first.step(&wall(stamp, 3.0)).checkpoint
        })
        .last()
        .unwrap();
    assert_eq!(memory.grid.at(Vector2::new(3.01, 0.0)), trundle_core::Cell::Occupied);
    assert_eq!(memory.mission.left.tasks(), [Task::go(Pose2::new(1.0, 0.0, 0.0))]);
    let memory = Checkpoint::from_bytes(&memory.to_bytes()).unwrap();
    let mut second = Robot::resume(RobotConfig::default(), &memory).unwrap();
    assert_eq!(second.grid().at(Vector2::new(3.01, 0.0)), trundle_core::Cell::Occupied);
    let reports = stand(&mut second, 3.0, |stamp| Some(wall(stamp, 1.5)));
    assert!(
        matches!(&reports.last().unwrap().state, DriveState::Lost { reason } if reason.is_due_to(ReasonKind::PoseUnknown))
    );
    assert!(reports.iter().all(|report| report.twist.unwrap().v == 0.0));
    assert_ne!(second.grid().at(Vector2::new(1.51, 0.0)), trundle_core::Cell::Occupied);
    let broken = Checkpoint { visual: vec![1, 2, 3], ..memory };
    assert!(matches!(Robot::resume(RobotConfig::default(), &broken), Err(CheckpointError::Visual(_))));
}
