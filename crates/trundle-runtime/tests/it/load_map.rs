//! Another map while the robot runs.

use crate::robot::Base;
use trundle_core::{
    Battery, Beam, BodyEvent, BodyEventKind, Cell, GridGeometry, MapAnnotations, NamedPlace, OccupancyGrid,
    Pose2, PowerSource, Scan, SensorEvent, Stamp, Vector2,
};
use trundle_runtime::{Mission, OperatorCommand, RangeSource, Robot, RobotConfig, Task};

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

/// A sweep of a laser that looks all round.
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
    let report = robot.obey(OperatorCommand::LoadMap(Box::new(room(0.05)))).unwrap();
    assert!(report.map_replaced);
    assert!(robot.tasks_left().unwrap().is_empty() && robot.annotations().places.is_empty());
    assert_eq!(robot.grid().at(Vector2::new(3.0, 0.0)), Cell::Occupied, "the new map");
    assert!(robot.estimate().covariance[(0, 0)] > 1.0, "the pose is unknown");
    let goal = Pose2::new(0.4, 1.0, 1.0);
    robot.obey(OperatorCommand::Begin(Mission::new(vec![Task::Go(goal)]).unwrap())).unwrap();
    run(&mut robot, &mut base, 2.0, 90.0);
    let truth = START * base.pose();
    let off = truth.inverse() * robot.estimate().pose;
    assert!(off.position().norm() < 0.05 && off.theta.abs() < 0.03, "{off:?}, {:?}", robot.tasks_left());
    assert!(truth.distance(&goal) < 0.05, "it drives in the frame of the new map: {truth:?}");
}

#[test]
fn a_map_of_other_cells_is_refused_and_the_robot_keeps_its_own_and_stands() {
    let (mut robot, mut base) = driven();
    let before = robot.grid().clone();
    let report = robot.obey(OperatorCommand::LoadMap(Box::new(room(0.1)))).unwrap();
    assert!(!report.map_replaced && *robot.grid() == before);
    assert_eq!((robot.tasks_left().unwrap().len(), robot.annotations().places.len()), (0, 1));
    run(&mut robot, &mut base, 2.0, 2.0);
    let rest = base.pose();
    run(&mut robot, &mut base, 4.0, 2.0);
    assert_eq!(base.pose(), rest);
    assert!(robot.estimate().covariance[(0, 0)] < 0.01, "the pose is as well known as before");
}

#[test]
fn a_docked_robot_knows_its_station_in_the_new_map_only_once_it_knows_its_pose() {
    let (mut robot, mut base) = driven();
    let charging = |seconds: i64| {
        let source = PowerSource::ChargingStation;
        let battery = Battery { voltage_v: 16.0, charge: Some(0.9), source, is_charging: true };
        SensorEvent::Body(BodyEvent {
            stamp: Stamp::from_nanos(seconds * 1_000_000_000),
            kind: BodyEventKind::Battery(battery),
        })
    };
    robot.step(&charging(2));
    assert!(robot.station().is_some());
    robot.obey(OperatorCommand::LoadMap(Box::new(room(0.05)))).unwrap();
    robot.step(&charging(2));
    assert!(robot.station().is_none(), "at an unknown pose");
    let charging_ends =
        Battery { voltage_v: 16.0, charge: None, source: PowerSource::Battery, is_charging: false };
    robot.step(&SensorEvent::Body(BodyEvent {
        stamp: Stamp::from_nanos(2_000_000_000),
        kind: BodyEventKind::Battery(charging_ends),
    }));
    robot
        .obey(OperatorCommand::Begin(Mission::new(vec![Task::Go(Pose2::new(0.4, 1.0, 1.0))]).unwrap()))
        .unwrap();
    run(&mut robot, &mut base, 2.0, 60.0);
    robot.step(&charging(62));
    let off = robot.station().unwrap().pose.position() - robot.estimate().pose.position();
    assert!(off.norm() < 0.5, "{off:?}");
}

#[test]
fn a_map_survives_a_recording() {
    let command = OperatorCommand::LoadMap(Box::new(room(0.05)));
    let text = serde_json::to_string(&command).unwrap();
    assert!(text.starts_with(r#"{"load_map":{"resolution_m":0.05"#), "{}", &text[..60]);
    assert_eq!(serde_json::from_str::<OperatorCommand>(&text).unwrap(), command);
}
