//! The check of base and camera before the first drive: rates, delays, signs of the encoders, the floor in the images.

use super::check_log::{BaseLog, CameraLog, CheckLog, ImageNote, mean, rate_and_gap};
use super::{Drivers, OpenCamera};
use crate::calibrate::{CalibratedValue, Calibration, floor_values};
use crate::real_time::device_report::{base_rows, camera_row};
use crate::{AppError, stop};
use std::sync::Arc;
use std::time::Instant;
use trundle_core::{PinholeCamera, Vector3};
use trundle_drivers::BaseSpec;
use trundle_estimation::FloorMount;
use trundle_runtime::RobotConfig;

/// Part of the camera's own rate below which images are too few. Source: ours.
const MIN_RATE_PART: f64 = 0.8;
/// Smallest rate of the wheels' readings \[Hz\]: control steps follow them. Source: half of a Kobuki's 50 Hz.
const MIN_WHEELS_HZ: f64 = 25.0;
/// Smallest rate of the gyro's readings \[Hz\]. Source: as the wheels'.
const MIN_GYRO_HZ: f64 = 25.0;
/// Smallest part of the pixels with depth. Source: ours.
const MIN_DEPTH_PART: f64 = 0.1;
/// Smallest distance of both wheels at which a push shows the encoders' signs \[m\]. Source: ours.
const MIN_PUSH_M: f64 = 0.1;
/// Smallest turn at which wheels and gyro are compared \[rad\]: 20 deg. Source: ours.
const MIN_TURN_RAD: f64 = 0.35;
/// Smallest number of images that show the floor. Source: ours.
const MIN_FLOOR_IMAGES: usize = 3;

/// The checks.
pub struct CheckRequest<'a> {
    /// The base.
    pub base: &'a BaseSpec,
    /// The camera.
    pub camera: OpenCamera,
    /// The camera that the robot works with.
    pub output: PinholeCamera,
    /// The robot.
    pub robot: &'a RobotConfig,
    /// Duration of the check \[s\].
    pub seconds: f64,
}

/// The result of a check.
#[derive(Debug, Default)]
pub struct HardwareReport {
    /// The table: what, value.
    pub rows: Vec<Vec<String>>,
    /// Faults to mend before a drive, each with the remedy; empty if none was found.
    pub problems: Vec<String>,
    /// Parts that were not checked, and how to check them.
    pub notes: Vec<String>,
    /// Values for the robot file.
    pub values: Calibration,
}

impl HardwareReport {
    /// The parts that were not checked, one line each, and one line if no fault was found.
    #[must_use]
    pub fn closing_lines(&self) -> Vec<String> {
        let notes = self.notes.iter().map(|note| format!("note: {note}"));
        notes.chain(self.problems.is_empty().then(|| "No problem found.".to_owned())).collect()
    }
}

/// Starts base and camera without driving and measures their data; a person may push the robot during the check.
///
/// # Errors
/// When base or camera cannot be started.
pub fn check_hardware(request: CheckRequest<'_>) -> Result<HardwareReport, AppError> {
    let CheckRequest { base, camera, output, robot, seconds } = request;
    let (info, origin) = (camera.info().clone(), Instant::now());
    let expected_up = robot.mount.base_from_camera().inverse().rotate(Vector3::z());
    let log = Arc::new(CheckLog::new(origin, output, robot.drive, expected_up));
    let sink = Arc::clone(&log);
    let on_event = move |event| sink.on_event(&event);
    let drivers = Drivers::start(base, camera, output, origin, on_event)?;
    // The probe of the base uses a part of the time since the origin.
    let start = Instant::now();
    let is_over = || stop::is_requested(|| format!("{:.1} s", start.elapsed().as_secs_f64()));
    while start.elapsed().as_secs_f64() < seconds && !is_over() {
        std::thread::sleep(stop::POLL_PERIOD);
    }
    let (versions, devices) = (drivers.versions(), drivers.report());
    drop(drivers);
    let (base_log, camera_log) = (log.base(), log.camera());
    let mut report = HardwareReport::default();
    let text = |version: Option<_>| {
        version.map_or("unknown".to_owned(), |v: trundle_drivers::kobuki::protocol::Version| v.to_string())
    };
    report.row(
        "base",
        format!("{base}, hardware {}, firmware {}", text(versions.hardware), text(versions.firmware)),
    );
    report.problems.extend(versions.firmware_fault());
    report.check_base(&base_log);
    report.rows.extend(devices.base.iter().flat_map(base_rows));
    let size = format!("{} x {} px", info.color.camera.width(), info.color.camera.height());
    report.row("camera", format!("{}, {size}, {:.0} Hz", info.name, info.color.rate_hz));
    report.check_camera(&camera_log, info.color.rate_hz);
    report.rows.extend(devices.camera.iter().map(camera_row));
    report.problems.extend(devices.camera_fault.map(|fault| format!("camera: {fault}")));
    report.check_wheels(&base_log);
    report.check_floor(&camera_log, robot);
    report.notes.extend(base_log.body.events.iter().map(|event| format!("event at {event}")));
    report.values.values.extend(intrinsics(&info.color.camera, &robot.camera));
    Ok(report)
}

impl HardwareReport {
    fn row(&mut self, name: &str, value: String) {
        self.rows.push(vec![name.to_owned(), value]);
    }

    fn check_base(&mut self, log: &BaseLog) {
        match rate_and_gap(&log.wheels) {
            Some((rate, gap)) => {
                self.row("wheels: rate, longest gap", format!("{rate:.1} Hz, {gap:.0} ms"));
                if rate < MIN_WHEELS_HZ {
                    let problem =
                        format!("wheel readings come at {rate:.1} Hz, expected {MIN_WHEELS_HZ} Hz or more");
                    self.problems.push(format!("{problem}: check the cable and the load of the computer"));
                }
            }
            None => self.problems.push("no wheel readings came: check the base's cable and power".to_owned()),
        }
        let gyro_rate = rate_and_gap(&log.gyro).map(|(rate, _)| rate);
        if let Some(rate) = gyro_rate {
            let bias = self.gyro_bias(&log.rest_rates);
            self.row("gyro: rate, bias at rest", format!("{rate:.1} Hz, {bias}"));
        }
        if gyro_rate.is_none_or(|rate| rate < MIN_GYRO_HZ) {
            let rate = gyro_rate.map_or("do not come".to_owned(), |rate| format!("come at {rate:.1} Hz"));
            self.problems.push(format!(
                "readings of the gyro {rate}, expected {MIN_GYRO_HZ} Hz or more: update the base's firmware, or check its cable"
            ));
        }
        if log.body.wheel_drop.any() {
            let problem = "a wheel hangs free: put the robot on the floor, or mend the switch of the wheel";
            self.problems.push(problem.to_owned());
        }
        if let Some(battery) = &log.body.battery {
            let charge = battery.charge.map_or(String::new(), |charge| format!(", {:.0} %", charge * 100.0));
            self.row("battery", format!("{:.1} V{charge}", battery.voltage_v));
        }
    }

    /// The bias of the gyro in words, from its rates \[rad/s\] before the wheels first turned.
    fn gyro_bias(&mut self, rest_rates: &[f64]) -> String {
        if rest_rates.is_empty() {
            let how = "leave the robot at rest for the first 3 s of the check";
            self.notes
                .push(format!("bias of the gyro not measured, the wheels turned from the beginning: {how}"));
            return "not measured".to_owned();
        }
        format!("{:.3} deg/s", mean(rest_rates).to_degrees())
    }

    fn check_camera(&mut self, log: &CameraLog, nominal_hz: f64) {
        let column = |value: fn(&ImageNote) -> f64| log.images.iter().map(value).collect::<Vec<f64>>();
        let Some((rate, gap)) = rate_and_gap(&column(|image| image.arrival_s)) else {
            let remedy = "check its cable, its USB port and what else uses it";
            return self.problems.push(format!("{} images came: {remedy}", log.images.len()));
        };
        let age = median(&column(|image| image.age_ms));
        self.row(
            "images: rate, longest gap, age on arrival",
            format!("{rate:.1} Hz, {gap:.0} ms, {age:.0} ms"),
        );
        let part = mean(&column(|image| image.depth_part));
        self.row("pixels with depth", format!("{:.0} %", part * 100.0));
        if rate < MIN_RATE_PART * nominal_hz {
            let problem = format!("images come at {rate:.1} Hz, expected {nominal_hz:.0} Hz");
            self.problems.push(format!("{problem}: use a USB 3 port, a smaller image or a lower rate"));
        }
        if part < MIN_DEPTH_PART {
            let expected = "expected 10 % or more: turn the robot to something 1 to 3 m away";
            self.problems.push(format!("only {:.1} % of the pixels have depth, {expected}", part * 100.0));
        }
    }

    /// The signs of encoders and gyro, if the robot was pushed.
    fn check_wheels(&mut self, log: &BaseLog) {
        let [left, right] = log.distances;
        let (turn, gyro) = ((right - left) / log.wheelbase(), log.gyro_turn);
        self.row("pushed: left wheel, right wheel", format!("{left:.3} m, {right:.3} m"));
        self.row(
            "turned: by wheels, by gyro",
            format!("{:.1} deg, {:.1} deg", turn.to_degrees(), gyro.to_degrees()),
        );
        if left.abs().min(right.abs()) < MIN_PUSH_M {
            let how = "push the robot straight ahead by 0.5 m during the check";
            return self.notes.push(format!("signs of the encoders not checked: {how}"));
        }
        match encoder_fault((left, right), turn, gyro) {
            Some(problem) => self.problems.push(problem.to_owned()),
            None => self.row("signs of encoders and gyro", "right".to_owned()),
        }
    }

    fn check_floor(&mut self, log: &CameraLog, robot: &RobotConfig) {
        let Some(floor) =
            FloorMount::of(&log.floor.views(), None).filter(|floor| floor.images >= MIN_FLOOR_IMAGES)
        else {
            let how = "clear 2 m of floor before the robot, and set mount.pitch_deg to within 15 deg";
            return self
                .notes
                .push(format!("camera's height and tilt not measured, no floor in sight: {how}"));
        };
        self.values.values.extend(floor_values(&floor, &robot.mount));
    }
}

/// The fault that a push or a turn shows, with its remedy: distances of the wheels (left, right) \[m\], turn by wheels and by gyro \[rad\].
fn encoder_fault((left, right): (f64, f64), turn: f64, gyro: f64) -> Option<&'static str> {
    if gyro.abs() > MIN_TURN_RAD {
        return (turn * gyro < 0.0).then_some(
            "wheels and gyro turn in opposite directions: swap the plugs of the left and the right encoder, or mend the mount of the gyro",
        );
    }
    match (left > 0.0, right > 0.0) {
        (true, true) => None,
        (false, false) => Some(
            "both encoders count down: push the robot ahead, or rewire both encoders, which no setting reverses",
        ),
        _ => Some(
            "the encoders count in opposite directions on a straight push: rewire the one that counts down, which no setting reverses",
        ),
    }
}

/// The intrinsics that the camera reports, as keys of the robot file.
fn intrinsics(camera: &PinholeCamera, before: &PinholeCamera) -> Vec<CalibratedValue> {
    let number = |name: &str, value: f64, before: f64, unit, decimals| CalibratedValue {
        sigma: None,
        ..CalibratedValue::key(name, (value, 0.0), unit, before, decimals)
    };
    let (size, old) =
        ((camera.width() as f64, camera.height() as f64), (before.width() as f64, before.height() as f64));
    vec![
        number("camera.width_px", size.0, old.0, "px", 0),
        number("camera.height_px", size.1, old.1, "px", 0),
        number("camera.fx_px", camera.fx(), before.fx(), "px", 3),
        number("camera.fy_px", camera.fy(), before.fy(), "px", 3),
        number("camera.cx_px", camera.cx(), before.cx(), "px", 3),
        number("camera.cy_px", camera.cy(), before.cy(), "px", 3),
    ]
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests;
