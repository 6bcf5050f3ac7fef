//! Events of the body besides motion and images: the effect of each on a robot that drives to a goal.

use crate::robot::{Base, robot, wall};
use nalgebra::Matrix3;
use trundle_core::{
    Battery, BodyEvent, BodyEventKind, Button, Device, Link, Odometry, PerWheel, Pose2, PowerSource,
    SensorEvent, Stamp, Twist2,
};
use trundle_runtime::{DriveState, ReasonKind, Robot, StepReport};

fn stamp(seconds: f64) -> Stamp {
    Stamp::default().after(seconds)
}

fn body(seconds: f64, kind: BodyEventKind) -> SensorEvent {
    SensorEvent::Body(BodyEvent::new(stamp(seconds), kind))
}

/// Drives with wheels and gyro at 50 Hz and images at 10 Hz from `from` to `to`, s.
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
    ((from * 50.0).round() as i64..(to * 50.0).round() as i64).map(step).collect()
}

fn driving() -> (Robot, Base) {
    let (mut robot, mut base) = (robot(Pose2::new(1.5, 0.0, 0.0)), Base::default());
    let reports = drive(&mut robot, &mut base, 0.0, 3.0);
    assert!(reports.last().unwrap().twist.unwrap().v > 0.1);
    (robot, base)
}

fn kind_of(report: &StepReport) -> Option<ReasonKind> {
    report.state.reason().map(|reason| reason.kind())
}

fn link(device: Device, is_up: bool) -> BodyEventKind {
    BodyEventKind::Link(Link { device, is_up })
}

fn battery(charge: f64, source: PowerSource, is_charging: bool) -> BodyEventKind {
    BodyEventKind::Battery(Battery { voltage_v: 14.0, charge: Some(charge), source, is_charging })
}

#[test]
fn each_hold_stops_at_once_with_its_kind_and_its_end_lets_the_robot_go_on() {
    let (hang, press) =
        (PerWheel { left: false, right: true }, BodyEventKind::Button(Button { index: 0, pressed: true }));
    for (begin, end, kind) in [
        (
            BodyEventKind::WheelDrop(hang),
            BodyEventKind::WheelDrop(PerWheel::default()),
            ReasonKind::WheelDrop,
        ),
        (
            BodyEventKind::OverCurrent(hang),
            BodyEventKind::OverCurrent(PerWheel::default()),
            ReasonKind::OverCurrent,
        ),
        (link(Device::Base, false), link(Device::Base, true), ReasonKind::DeviceLost),
        (link(Device::Camera, false), link(Device::Camera, true), ReasonKind::DeviceLost),
        (
            battery(0.9, PowerSource::Adapter, true),
            battery(0.9, PowerSource::Battery, false),
            ReasonKind::AdapterConnected,
        ),
        (
            battery(0.01, PowerSource::Battery, false),
            battery(0.05, PowerSource::Battery, false),
            ReasonKind::BatteryEmpty,
        ),
        (press, press, ReasonKind::Paused),
    ] {
        let (mut robot, mut base) = driving();
        let at_once = robot.step(&body(3.0, begin));
        assert_eq!(at_once.twist, Some(Twist2::ZERO), "{begin:?} waits for no wheel reading");
        assert_eq!(kind_of(&at_once), Some(kind), "{}", at_once.state);
        base.command(at_once.twist);
        let held = drive(&mut robot, &mut base, 3.0, 4.0);
        assert!(held.iter().all(|report| report.twist == Some(Twist2::ZERO)), "{begin:?}");
        robot.step(&body(4.0, end));
        let on = drive(&mut robot, &mut base, 4.0, 14.0);
        assert_eq!(on.last().unwrap().state, DriveState::Arrived, "after {begin:?}");
    }
}

#[test]
fn a_long_hold_is_not_a_lack_of_progress() {
    let (mut robot, mut base) = driving();
    let report = robot.step(&body(3.0, link(Device::Base, false)));
    base.command(report.twist);
    for i in 0..1200 {
        let report = robot.step(&body(3.1 + 0.1 * f64::from(i), BodyEventKind::Silence));
        assert_eq!((report.twist, kind_of(&report)), (Some(Twist2::ZERO), Some(ReasonKind::DeviceLost)));
    }
    assert!(robot.tasks_ended().is_empty());
}

#[test]
fn in_silence_the_robot_stops_for_want_of_wheel_readings() {
    let (mut robot, _) = driving();
    let reports: Vec<_> =
        (1..=10).map(|i| robot.step(&body(3.0 + 0.1 * f64::from(i), BodyEventKind::Silence))).collect();
    let last = reports.last().unwrap();
    assert_eq!((last.twist, kind_of(last)), (Some(Twist2::ZERO), Some(ReasonKind::WheelsMissing)));
}

#[test]
fn nothing_is_mapped_while_a_wheel_hangs() {
    let (mut robot, mut base) = driving();
    let known = |robot: &Robot| robot.grid().cells().to_vec();
    robot.step(&body(3.0, BodyEventKind::WheelDrop(PerWheel { left: true, right: true })));
    let before = known(&robot);
    drive(&mut robot, &mut base, 3.0, 5.0);
    assert_eq!(known(&robot), before);
}

#[test]
fn the_battery_is_reported() {
    let (mut robot, _) = driving();
    assert_eq!(robot.battery(), None);
    robot.step(&body(3.0, battery(0.4, PowerSource::Battery, false)));
    assert_eq!(robot.battery().and_then(|battery| battery.charge), Some(0.4));
}

#[test]
fn a_goal_is_reached_by_the_odometry_of_the_body_alone() {
    let (mut robot, mut base) = (robot(Pose2::new(0.4, 0.0, 0.0)), Base::default());
    let mut last = StepReport::default();
    for i in 0..450 {
        let stamp = Stamp::from_nanos(i64::from(i) * 20_000_000);
        base.on_wheels(stamp);
        let pose = Pose2::new(5.0, 1.0, 2.0) * Pose2::new(3.0 - base.to_wall(), 0.0, 0.0);
        let covariance = Matrix3::from_diagonal_element(1e-7 * f64::from(i));
        last = robot.step(&SensorEvent::Odometry(Odometry {
            stamp,
            pose,
            twist: last.twist.unwrap_or_default(),
            covariance,
        }));
        base.command(last.twist);
        if i % 5 == 0 {
            robot.step(&wall(stamp, base.to_wall()));
        }
    }
    assert_eq!(last.state, DriveState::Arrived, "{}", last.state);
    assert!(last.estimate.unwrap().pose.distance(&Pose2::new(0.4, 0.0, 0.0)) < 0.05);
}
