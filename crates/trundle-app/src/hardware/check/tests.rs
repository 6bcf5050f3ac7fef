//! Tests of the findings, from events of base and camera at given times.

use super::*;
use trundle_core::{
    Battery, BodyEvent, BodyEventKind, ColorImage, DepthImage, DifferentialDrive, Distortion, GyroRate,
    PerWheel, PowerSource, RgbdImage, SensorEvent, Stamp, WheelTicks,
};

/// Period of the readings of a Kobuki \[s\].
const BASE_PERIOD_S: f64 = 0.02;
/// Bias of the gyro of these tests \[rad/s\].
const BIAS_RAD_S: f64 = 0.01;

fn at(time: f64) -> Stamp {
    Stamp::default().after(time)
}

/// A log for a Kobuki and a camera of 4 x 3 px.
fn log() -> CheckLog {
    let camera = PinholeCamera::new((4, 3), (4.0, 4.0), (1.5, 1.0), Distortion::default()).unwrap();
    CheckLog::new(Instant::now(), camera, DifferentialDrive::KOBUKI, -Vector3::y())
}

fn wheels(log: &CheckLog, time: f64, [left, right]: [f64; 2]) {
    let ticks = |metres: f64| (metres / DifferentialDrive::KOBUKI.metres_per_tick()).round() as i64 as u16;
    let reading = WheelTicks { stamp: at(time), left: ticks(left), right: ticks(right) };
    log.on_event_at(time, &SensorEvent::Wheels(reading));
}

fn gyro(log: &CheckLog, time: f64, omega: f64) {
    log.on_event_at(time, &SensorEvent::Gyro(GyroRate { stamp: at(time), omega: omega + BIAS_RAD_S }));
}

fn body(log: &CheckLog, time: f64, kind: BodyEventKind) {
    log.on_event_at(time, &SensorEvent::Body(BodyEvent::new(at(time), kind)));
}

/// One second at rest, then one of motion: distances counted by the wheels (left, right) \[m\], turn by the gyro \[rad\].
fn moved(distances: [f64; 2], turn: f64) -> HardwareReport {
    let log = log();
    for i in 0..=100 {
        let (time, part) = (f64::from(i) * BASE_PERIOD_S, f64::from(i - 50).max(0.0) / 50.0);
        wheels(&log, time, distances.map(|distance| part * distance));
        gyro(&log, time, if i > 50 { turn } else { 0.0 });
    }
    let mut report = HardwareReport::default();
    report.check_base(&log.base());
    report.check_wheels(&log.base());
    report
}

fn value<'a>(report: &'a HardwareReport, name: &str) -> Option<&'a str> {
    report.rows.iter().find(|row| row[0] == name).map(|row| row[1].as_str())
}

#[test]
fn a_straight_push_ahead_has_right_signs() {
    let report = moved([0.5, 0.49], 0.02);
    assert_eq!(value(&report, "signs of encoders and gyro"), Some("right"));
    assert_eq!(value(&report, "pushed: left wheel, right wheel"), Some("0.500 m, 0.490 m"));
    assert_eq!(value(&report, "turned: by wheels, by gyro"), Some("-2.5 deg, 1.1 deg"));
    assert_eq!(value(&report, "wheels: rate, longest gap"), Some("50.0 Hz, 20 ms"));
    assert_eq!(value(&report, "gyro: rate, bias at rest"), Some("50.0 Hz, 0.573 deg/s"));
    assert!(report.problems.is_empty() && report.notes.is_empty(), "{report:?}");
    assert_eq!(report.closing_lines(), ["No problem found."]);
}

#[test]
fn wrong_signs_are_named_with_a_remedy_that_exists() {
    for (distances, turn, part) in [
        ([-0.5, -0.5], 0.0, "both encoders count down: push the robot ahead, or rewire both"),
        ([-0.5, 0.5], 0.0, "in opposite directions on a straight push: rewire the one that counts down"),
        ([0.5, -0.5], 0.0, "in opposite directions on a straight push"),
        // Swapped encoders on a turn to the left: the right wheel rolls ahead, the left one counts it.
        ([0.2, -0.2], 1.7, "wheels and gyro turn in opposite directions: swap the plugs"),
        ([-0.2, 0.2], -1.7, "wheels and gyro turn in opposite directions"),
    ] {
        let report = moved(distances, turn);
        assert!(report.problems.len() == 1 && report.problems[0].contains(part), "{part}: {report:?}");
        assert_eq!(value(&report, "signs of encoders and gyro"), None);
    }
}

#[test]
fn turns_and_curves_with_right_signs_are_no_problem() {
    for (distances, turn) in
        [([-0.2, 0.2], 1.7), ([0.2, -0.2], -1.7), ([0.3, 0.5], 0.87), ([-0.5, -0.3], 0.87)]
    {
        let report = moved(distances, turn);
        assert!(report.problems.is_empty(), "{distances:?}: {report:?}");
        assert_eq!(value(&report, "signs of encoders and gyro"), Some("right"));
    }
}

#[test]
fn a_robot_that_is_not_pushed_is_no_problem_and_a_note() {
    let report = moved([0.05, 0.5], 0.0);
    assert!(report.problems.is_empty(), "{report:?}");
    assert!(report.notes[0].starts_with("signs of the encoders not checked: push the robot"), "{report:?}");
    assert_eq!(value(&report, "signs of encoders and gyro"), None);
}

#[test]
fn without_rest_the_bias_is_not_measured() {
    let log = log();
    for i in 0..50 {
        let time = f64::from(i) * BASE_PERIOD_S;
        wheels(&log, time, [0.01 * f64::from(i); 2]);
        if i > 0 {
            gyro(&log, time, 0.0);
        }
    }
    let mut report = HardwareReport::default();
    report.check_base(&log.base());
    assert_eq!(value(&report, "gyro: rate, bias at rest"), Some("50.0 Hz, not measured"));
    assert!(report.notes[0].contains("leave the robot at rest"), "{report:?}");
    assert!(report.problems.is_empty(), "{report:?}");
}

#[test]
fn a_silent_or_slow_base_is_a_problem() {
    let mut report = HardwareReport::default();
    report.check_base(&log().base());
    assert!(report.problems[0].starts_with("no wheel readings came"), "{report:?}");
    assert!(report.problems[1].starts_with("readings of the gyro do not come"), "{report:?}");
    let slow = log();
    for i in 0..20 {
        let time = 0.1 * f64::from(i);
        wheels(&slow, time, [0.0; 2]);
        gyro(&slow, time, 0.0);
    }
    let mut report = HardwareReport::default();
    report.check_base(&slow.base());
    assert!(
        report.problems[0].starts_with("wheel readings come at 10.0 Hz, expected 25 Hz or more"),
        "{report:?}"
    );
    assert!(report.problems[1].starts_with("readings of the gyro come at 10.0 Hz"), "{report:?}");
    assert_eq!(report.problems.len(), 2);
}

#[test]
fn a_hanging_wheel_is_a_problem_until_it_returns_and_the_battery_is_shown() {
    let log = log();
    let battery =
        Battery { voltage_v: 15.72, charge: Some(0.62), source: PowerSource::default(), is_charging: false };
    for i in 0..10 {
        wheels(&log, f64::from(i) * BASE_PERIOD_S, [0.0; 2]);
        gyro(&log, f64::from(i) * BASE_PERIOD_S, 0.0);
    }
    body(&log, 0.1, BodyEventKind::Battery(battery));
    body(&log, 0.2, BodyEventKind::WheelDrop(PerWheel { left: true, right: false }));
    let report = || {
        let mut report = HardwareReport::default();
        report.check_base(&log.base());
        report
    };
    assert!(report().problems.iter().any(|problem| problem.starts_with("a wheel hangs free")));
    assert_eq!(value(&report(), "battery"), Some("15.7 V, 62 %"));
    body(&log, 0.3, BodyEventKind::WheelDrop(PerWheel::default()));
    assert!(report().problems.is_empty());
    assert_eq!(log.base().body.events, ["0.2 s: a wheel hangs"]);
}

/// Images every `period` \[s\] of the depth `depth` \[m\], of which each arrives 20 ms late, against a camera of 30 Hz.
fn watched(period: f64, depth: f32) -> HardwareReport {
    let log = log();
    for i in 0..20 {
        let time = f64::from(i) * period;
        let (color, depth) = (ColorImage::filled(4, 3, [0; 3]), DepthImage::filled(4, 3, depth));
        let image = RgbdImage::new(at(time), color, depth).unwrap();
        log.on_event_at(time + 0.02, &SensorEvent::Rgbd(image));
    }
    let mut report = HardwareReport::default();
    report.check_camera(&log.camera(), 30.0);
    report
}

#[test]
fn images_too_few_or_without_depth_are_problems() {
    let good = watched(1.0 / 30.0, 2.0);
    assert!(good.problems.is_empty(), "{good:?}");
    assert_eq!(value(&good, "images: rate, longest gap, age on arrival"), Some("30.0 Hz, 33 ms, 20 ms"));
    assert_eq!(value(&good, "pixels with depth"), Some("100 %"));
    let slow = watched(0.1, 2.0);
    assert!(
        slow.problems[0].starts_with("images come at 10.0 Hz, expected 30 Hz: use a USB 3 port"),
        "{slow:?}"
    );
    let empty = watched(1.0 / 30.0, 0.0);
    assert!(empty.problems[0].starts_with("only 0.0 % of the pixels have depth, expected 10 %"), "{empty:?}");
    assert!(slow.problems.len() == 1 && empty.problems.len() == 1);
    let mut none = HardwareReport::default();
    none.check_camera(&log().camera(), 30.0);
    assert!(none.problems[0].starts_with("0 images came: check its cable"), "{none:?}");
}
