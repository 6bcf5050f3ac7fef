//! Another map while the robot runs.

use crate::robot::Base;
use trundle_core::{
    Battery, Beam, BodyEvent, BodyEventKind, Cell, GridGeometry, MapAnnotations, NamedPlace, OccupancyGrid,
    Pose2, PowerSource, Scan, SensorEvent, Stamp, Twist2, Vector2,
};
use trundle_runtime::{LazyImage, Mission, OperatorCommand, RangeSource, Robot, RobotConfig, Task};

/// A room whose outline fits itself nowhere else, map frame \[m\].
const CORNERS: [[f64; 2]; 8] =
    [[-2.0, -1.5], [3.0, -1.5], [3.0, 0.5], [1.8, 0.5], [1.8, 2.5], [-0.6, 2.5], [-0.6, 1.4], [-2.0, 1.4]];
/// The robot's pose in that room.
const START: Pose2 = Pose2 { x: -0.8, y: -0.4, theta: 2.0 };

fn walls() -> impl Iterator<Item = (Vector2, Vector2)> {
    let corner = |[x, y]: [f64; 2]| Vector2::new(x, y);
    (0..CORNERS.len()).map(move |i| (corner(CORNERS[i]), corner(CORNERS[(i + 1) % CORNERS.len()])))
}

/// Distance to the nearest wall along a ray \[m\].
fn range(from: Vector2, angle: f64) -> f64 {
    let ray = Vector2::new(angle.cos(), angle.sin());
    let hit = |(a, b): (Vector2, Vector2)| {
        let (along, to) = (b - a, a - from);
        let spread = ray.perp(&along);
        let (t, s) = (to.perp(&along) / spread, to.perp(&ray) / spread);
        (t > 0.0 && (0.0..=1.0).contains(&s)).then_some(t)
    };
    walls().filter_map(hit).fold(f64::INFINITY, f64::min)
}

/// A sweep of a laser over a full turn.
fn sweep(stamp: Stamp, pose: Pose2) -> SensorEvent {
    let step = 1_f64.to_radians();
    let beam = |k: i32| Beam::Hit { range: range(pose.position(), pose.theta + f64::from(k) * step) };
    let beams = (-180..180).map(beam).collect();
    SensorEvent::Scan(Scan::new(stamp, Vector2::zeros(), -180.0 * step, step, beams).unwrap())
}

/// The room as a map of this cell size \[m\].
fn room(resolution: f64) -> OccupancyGrid {
    let size = |length: f64| (length / resolution).round() as usize;
    let geometry = GridGeometry::new(resolution, Vector2::new(-2.5, -2.0), size(6.0), size(5.0)).unwrap();
    let cell = |i: usize| {
        let center = geometry.center(geometry.cell(i));
        let crossings = walls().filter(|(a, b)| {
            (a.y > center.y) != (b.y > center.y)
                && center.x < (b.x - a.x) * (center.y - a.y) / (b.y - a.y) + a.x
        });
        let is_inside = crossings.count() % 2 == 1;
        let off = |(a, b): (Vector2, Vector2)| {
            let along = (b - a).normalize();
            let t = (center - a).dot(&along).clamp(0.0, (b - a).norm());
            (center - a - along * t).norm()
        };
        match walls().map(off).fold(f64::INFINITY, f64::min) {
            near if near <= 0.6 * resolution => Cell::Occupied,
            _ if is_inside => Cell::Free,
            _ => Cell::Unknown,
        }
    };
    OccupancyGrid::new(geometry, (0..geometry.len()).map(cell).collect()).unwrap()
}

/// The room of cells of 5 cm in a map frame that begins `x` m to the left.
fn shifted_room(x: f64) -> OccupancyGrid {
    let grid = room(0.05);
    let GridGeometry { resolution, origin, width, height, .. } = *grid.geometry();
    let geometry = GridGeometry::new(resolution, origin + Vector2::new(x, 0.0), width, height).unwrap();
    OccupancyGrid::new(geometry, grid.cells().to_vec()).unwrap()
}

/// The same as [`run`] for a robot with background jobs, each of which ends before the next event.
fn run_with_jobs(robot: &mut Robot, base: &mut Base, from: f64, seconds: f64) {
    let work = |robot: &mut Robot, base: &mut Base| {
        while let Some(job) = robot.next_job() {
            base.command(robot.apply_answer(job.run()).twist);
        }
    };
    for i in (from * 50.0) as i64..((from + seconds) * 50.0) as i64 {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        for event in base.on_wheels(stamp) {
            base.command(robot.step(&event).twist);
            work(robot, base);
        }
        if i % 5 == 0 {
            robot.step(&sweep(stamp, START * base.pose()));
            work(robot, base);
        }
    }
}

/// Runs for `seconds` from `from`; the base begins at [`START`] in truth.
fn run(robot: &mut Robot, base: &mut Base, from: f64, seconds: f64) {
    for i in (from * 50.0) as i64..((from + seconds) * 50.0) as i64 {
        let stamp = Stamp::from_nanos(i * 20_000_000);
        for event in base.on_wheels(stamp) {
            base.command(robot.step(&event).twist);
        }
        if i % 5 == 0 {
            robot.step(&sweep(stamp, START * base.pose()));
        }
    }
}

/// A robot with a laser that has driven for 2 s without a map, and its base.
fn driven() -> (Robot, Base) {
    let mut config = RobotConfig::default();
    config.sight = RangeSource::Laser;
    let (mut robot, mut base) = (Robot::new(config).unwrap(), Base::default());
    robot.drive_to(Pose2::new(0.3, 0.0, 0.0)).unwrap();
    run(&mut robot, &mut base, 0.0, 2.0);
    let place = NamedPlace { id: 1, name: "desk".into(), pose: Pose2::IDENTITY };
    robot.annotate(MapAnnotations { zones: Vec::new(), places: vec![place] });
    (robot, base)
}

#[test]
fn a_robot_drops_what_belongs_to_its_old_map_and_finds_itself_in_the_new_one() {
    let (mut robot, mut base) = driven();
    let report = robot.execute(OperatorCommand::LoadMap(Box::new(room(0.05)))).unwrap();
    assert!(report.map_replaced);
    assert!(robot.tasks_left().unwrap().is_empty() && robot.annotations().places.is_empty());
    assert_eq!(robot.grid().at(Vector2::new(3.0, 0.0)), Cell::Occupied, "the new map");
    assert!(robot.estimate().covariance[(0, 0)] > 1.0, "the pose is unknown");
    let goal = Pose2::new(0.4, 1.0, 1.0);
    robot.execute(OperatorCommand::Begin(Mission::new(vec![Task::go(goal)]).unwrap())).unwrap();
    run(&mut robot, &mut base, 2.0, 90.0);
    let truth = START * base.pose();
    let off = truth.inverse() * robot.estimate().pose;
    assert!(off.position().norm() < 0.05 && off.theta.abs() < 0.03, "{off:?}, {:?}", robot.tasks_left());
    assert!(truth.distance(&goal) < 0.05, "it drives in the frame of the new map: {truth:?}");
}

#[test]
fn a_map_of_other_cells_is_refused_and_the_robot_goes_on_with_its_own() {
    let (mut robot, mut base) = driven();
    let goal = Pose2::new(0.6, 0.0, 0.0);
    robot.drive_to(goal).unwrap();
    run(&mut robot, &mut base, 2.0, 0.2);
    let before = robot.grid().clone();
    let report = robot.execute(OperatorCommand::LoadMap(Box::new(room(0.1)))).unwrap();
    assert!(!report.map_replaced && *robot.grid() == before);
    assert_eq!((robot.tasks_left().unwrap().len(), robot.annotations().places.len()), (1, 1));
    run(&mut robot, &mut base, 2.2, 10.0);
    assert!(base.pose().distance(&goal) < 0.05, "{:?}", base.pose());
    assert!(robot.estimate().covariance[(0, 0)] < 0.01, "the pose is as well known as before");
}

#[test]
fn a_broken_image_of_the_old_map_gives_no_pose_in_the_new_one() {
    const SHIFT_M: f64 = 10.0;
    let mut config = RobotConfig::default();
    config.sight = RangeSource::Laser;
    let robot = Robot::new(config).unwrap();
    let (mut robot, mut base) = (robot.with_background_jobs().with_checkpoints(), Base::default());
    run_with_jobs(&mut robot, &mut base, 0.0, 1.0);
    robot.execute(OperatorCommand::LoadMap(Box::new(room(0.05)))).unwrap();
    run_with_jobs(&mut robot, &mut base, 1.0, 1.0);
    robot.queue_image(LazyImage::new(Stamp::from_nanos(1_900_000_000), || Err("broken".to_owned())));
    let job = robot.next_job().unwrap();
    let report = robot.execute(OperatorCommand::LoadMap(Box::new(shifted_room(SHIFT_M)))).unwrap();
    assert!(report.map_replaced && report.checkpoint.is_none(), "the visual map is with the job");
    let report = robot.apply_answer(job.run());
    assert_eq!(report.broken_image.as_deref(), Some("broken"));
    assert_eq!(report.checkpoint.unwrap().grid, *robot.grid());
    let mission = Mission::new(vec![Task::go(Pose2::new(SHIFT_M + 0.4, 1.0, 1.0))]).unwrap();
    robot.execute(OperatorCommand::Begin(mission)).unwrap();
    run_with_jobs(&mut robot, &mut base, 2.0, 60.0);
    let truth = Pose2::new(SHIFT_M, 0.0, 0.0) * START * base.pose();
    let estimate = robot.estimate();
    assert!(truth.distance(&estimate.pose) < 0.05, "truth {truth:?}, estimate {:?}", estimate.pose);
    assert!(estimate.covariance[(0, 0)] < 0.01);
}

#[test]
fn a_docked_robot_knows_its_station_in_the_new_map_only_once_it_knows_its_pose() {
    let (mut robot, mut base) = driven();
    let charging = |seconds: i64| {
        let source = PowerSource::ChargingStation;
        let battery = Battery { voltage_v: 16.0, charge: Some(0.9), source, is_charging: true };
        SensorEvent::Body(BodyEvent::new(
            Stamp::from_nanos(seconds * 1_000_000_000),
            BodyEventKind::Battery(battery),
        ))
    };
    robot.step(&charging(2));
    assert!(robot.station().is_some());
    robot.execute(OperatorCommand::LoadMap(Box::new(room(0.05)))).unwrap();
    robot.step(&charging(2));
    assert!(robot.station().is_none(), "at an unknown pose");
    let charging_ends =
        Battery { voltage_v: 16.0, charge: None, source: PowerSource::Battery, is_charging: false };
    robot.step(&SensorEvent::Body(BodyEvent::new(
        Stamp::from_nanos(2_000_000_000),
        BodyEventKind::Battery(charging_ends),
    )));
    robot
        .execute(OperatorCommand::Begin(Mission::new(vec![Task::go(Pose2::new(0.4, 1.0, 1.0))]).unwrap()))
        .unwrap();
    run(&mut robot, &mut base, 2.0, 60.0);
    robot.step(&charging(62));
    let off = robot.station().unwrap().pose.position() - robot.estimate().pose.position();
    assert!(off.norm() < 0.5, "{off:?}");
}

#[test]
fn a_robot_that_drives_brakes_as_it_obeys_and_its_checkpoint_has_the_new_map_and_no_mission() {
    let mut config = RobotConfig::default();
    config.sight = RangeSource::Laser;
    let (mut robot, mut base) = (Robot::new(config.clone()).unwrap().with_checkpoints(), Base::default());
    robot.drive_to(Pose2::new(1.0, 0.0, 0.0)).unwrap();
    run(&mut robot, &mut base, 0.0, 2.0);
    let speed = base.twist().v;
    assert!(speed > 0.05, "{speed}");
    let report = robot.execute(OperatorCommand::LoadMap(Box::new(room(0.05)))).unwrap();
    let twist = report.twist.unwrap();
    assert!(twist.v <= speed, "{twist:?} after {speed} m/s");
    let checkpoint = report.checkpoint.unwrap();
    assert_eq!(checkpoint.grid, *robot.grid());
    let resumed = Robot::resume(config, &checkpoint).unwrap();
    assert!(resumed.tasks_left().unwrap().is_empty());
    base.command(Some(twist));
    run(&mut robot, &mut base, 2.0, 1.5);
    assert_eq!(base.twist(), Twist2::ZERO);
}

#[test]
fn a_map_survives_a_recording() {
    let command = OperatorCommand::LoadMap(Box::new(room(0.05)));
    let text = serde_json::to_string(&command).unwrap();
    assert!(text.starts_with(r#"{"load_map":{"resolution_m":0.05"#), "{}", &text[..60]);
    assert_eq!(serde_json::from_str::<OperatorCommand>(&text).unwrap(), command);
}
