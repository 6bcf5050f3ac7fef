//! Conditions of the body that hold the robot: of several the most important one is named, and each has to end.

use crate::robot::robot;
use trundle_core::{
    Battery, BodyEvent, BodyEventKind, Button, Device, Link, PerWheel, Pose2, PowerSource, SensorEvent,
    Stamp, Twist2,
};
use trundle_runtime::{MotionHold, Robot};

/// A condition: its begin, its end, and the hold that it makes.
type Condition = (BodyEventKind, BodyEventKind, MotionHold);

fn battery(charge: f64) -> BodyEventKind {
    let source = PowerSource::Battery;
    BodyEventKind::Battery(Battery { voltage_v: 14.0, charge: Some(charge), source, is_charging: false })
}

/// The conditions, the most important one first.
fn conditions() -> [Condition; 6] {
    let (one, none) = (PerWheel { left: true, right: false }, PerWheel::default());
    let link = |device, is_up| BodyEventKind::Link(Link { device, is_up });
    let press = BodyEventKind::Button(Button { index: 0, pressed: true });
    [
        (link(Device::Base, false), link(Device::Base, true), MotionHold::DeviceLost(Device::Base)),
        (link(Device::Camera, false), link(Device::Camera, true), MotionHold::DeviceLost(Device::Camera)),
        (BodyEventKind::WheelDrop(one), BodyEventKind::WheelDrop(none), MotionHold::WheelDrop),
        (BodyEventKind::OverCurrent(one), BodyEventKind::OverCurrent(none), MotionHold::OverCurrent),
        (battery(0.01), battery(0.5), MotionHold::BatteryEmpty),
        (press, press, MotionHold::Paused),
    ]
}

/// Sends the event; the robot's hold after it. Every report of a held robot stops the wheels.
fn send(robot: &mut Robot, at: &mut f64, kind: BodyEventKind) -> Option<MotionHold> {
    *at += 0.1;
    let report = robot.step(&SensorEvent::Body(BodyEvent::new(Stamp::default().after(*at), kind)));
    if robot.hold().is_some() {
        assert!(report.twist.is_none_or(|twist| twist == Twist2::ZERO), "{kind:?}");
    }
    robot.hold()
}

#[test]
fn of_two_conditions_the_more_important_one_is_named_in_either_order() {
    for (i, first) in conditions().into_iter().enumerate() {
        for second in conditions().into_iter().skip(i + 1) {
            for (a, b) in [(first, second), (second, first)] {
                let (mut robot, mut at) = (robot(Pose2::new(1.0, 0.0, 0.0)), 0.0);
                assert_eq!(send(&mut robot, &mut at, a.0), Some(a.2));
                assert_eq!(send(&mut robot, &mut at, b.0), Some(first.2), "{:?} before {:?}", a.2, b.2);
                assert_eq!(send(&mut robot, &mut at, first.1), Some(second.2), "the other one still holds");
                assert_eq!(send(&mut robot, &mut at, second.1), None);
            }
        }
    }
}

#[test]
fn all_conditions_at_once_end_one_by_one_in_the_order_of_their_importance() {
    let (mut robot, mut at) = (robot(Pose2::new(1.0, 0.0, 0.0)), 0.0);
    for (begin, _, _) in conditions().into_iter().rev() {
        send(&mut robot, &mut at, begin);
    }
    let mut named = vec![robot.hold()];
    for (_, end, _) in conditions() {
        named.push(send(&mut robot, &mut at, end));
    }
    let expected: Vec<Option<MotionHold>> =
        conditions().map(|(_, _, hold)| Some(hold)).into_iter().chain([None]).collect();
    assert_eq!(named, expected);
}

#[test]
fn a_condition_that_is_reported_twice_ends_once() {
    for (begin, end, hold) in conditions() {
        if hold == MotionHold::Paused {
            continue; // A second press of the button is the end of the pause.
        }
        let (mut robot, mut at) = (robot(Pose2::new(1.0, 0.0, 0.0)), 0.0);
        assert_eq!(send(&mut robot, &mut at, begin), Some(hold));
        assert_eq!(send(&mut robot, &mut at, begin), Some(hold));
        assert_eq!(send(&mut robot, &mut at, end), None, "{hold}");
    }
}
