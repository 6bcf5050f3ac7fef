//! Readings from base and camera during a check.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;
use trundle_core::{
    Battery, BodyEventKind, DifferentialDrive, GyroRate, PerWheel, PinholeCamera, RgbdImage, SensorEvent,
    Stamp, Vector3, WheelTicks,
};
use trundle_estimation::FloorSearch;

/// Images from one whose floor is fitted to the next. Source: ours.
const FLOOR_STEP_IMAGES: usize = 5;

/// A received image.
#[derive(Debug, Clone, Copy)]
pub(super) struct ImageNote {
    pub arrival_s: f64,
    pub age_ms: f64,
    /// Part of the pixels with depth, 0 to 1.
    pub depth_part: f64,
}

/// Facts that the base reported about itself.
#[derive(Debug, Default)]
pub(super) struct BodyNotes {
    pub battery: Option<Battery>,
    /// Wheels that hang free.
    pub wheel_drop: PerWheel,
    /// Events, in words.
    pub events: Vec<String>,
}

/// Readings from base and camera during a check. Each device's thread has its own part: the search of the floor in an image delays no reading
/// of the base.
#[derive(Debug)]
pub(super) struct CheckLog {
    origin: Instant,
    base: Mutex<BaseLog>,
    camera: Mutex<CameraLog>,
}

/// Images of the camera during a check.
#[derive(Debug)]
pub(super) struct CameraLog {
    camera: PinholeCamera,
    pub images: Vec<ImageNote>,
    pub floor: FloorSearch,
}

/// Readings from the base, and events of all devices, during a check.
#[derive(Debug)]
pub(super) struct BaseLog {
    drive: DifferentialDrive,
    /// Arrivals of readings \[s\].
    pub wheels: Vec<f64>,
    pub gyro: Vec<f64>,
    /// Distance of the left and the right wheel \[m\].
    pub distances: [f64; 2],
    /// Turn by the gyro \[rad\].
    pub gyro_turn: f64,
    /// Gyro rates while the wheels were at rest \[rad/s\].
    pub rest_rates: Vec<f64>,
    pub body: BodyNotes,
    last_ticks: Option<WheelTicks>,
    last_gyro: Option<GyroRate>,
    has_rolled: bool,
}

impl CheckLog {
    pub fn new(
        origin: Instant,
        camera: PinholeCamera,
        drive: DifferentialDrive,
        expected_up: Vector3,
    ) -> Self {
        let floor = FloorSearch::new(expected_up);
        Self {
            origin,
            base: Mutex::new(BaseLog::new(drive)),
            camera: Mutex::new(CameraLog { camera, images: Vec::new(), floor }),
        }
    }

    /// Records an event that arrives now.
    pub fn on_event(&self, event: &SensorEvent) {
        self.on_event_at(self.origin.elapsed().as_secs_f64(), event);
    }

    /// Records an event that arrives at `now` \[s\] after the origin.
    pub fn on_event_at(&self, now: f64, event: &SensorEvent) {
        match event {
            SensorEvent::Rgbd(image) => self.camera().on_image(now, image),
            event => self.base().on_event(now, event),
        }
    }

    /// The readings from the base.
    pub fn base(&self) -> MutexGuard<'_, BaseLog> {
        self.base.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The images of the camera.
    pub fn camera(&self) -> MutexGuard<'_, CameraLog> {
        self.camera.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl BaseLog {
    fn new(drive: DifferentialDrive) -> Self {
        Self {
            drive,
            wheels: Vec::new(),
            gyro: Vec::new(),
            distances: [0.0; 2],
            gyro_turn: 0.0,
            rest_rates: Vec::new(),
            body: BodyNotes::default(),
            last_ticks: None,
            last_gyro: None,
            has_rolled: false,
        }
    }

    /// Distance between the wheels of the robot's drive \[m\].
    pub fn wheelbase(&self) -> f64 {
        self.drive.wheelbase
    }

    fn on_event(&mut self, now: f64, event: &SensorEvent) {
        match event {
            SensorEvent::Wheels(ticks) => self.on_wheels(now, ticks),
            SensorEvent::Gyro(rate) => self.on_gyro(now, rate),
            SensorEvent::Body(event) => self.on_body(now, event.kind),
            SensorEvent::Touch(touch) if touch.pressed => {
                self.body.events.push(format!("{now:.1} s: bumper pressed"))
            }
            SensorEvent::Cliff(cliff) if cliff.over_edge => {
                self.body.events.push(format!("{now:.1} s: no floor ahead"))
            }
            _ => {}
        }
    }

    fn on_body(&mut self, now: f64, kind: BodyEventKind) {
        if let BodyEventKind::WheelDrop(wheels) = kind {
            self.body.wheel_drop = wheels;
        }
        let what = match kind {
            BodyEventKind::Battery(battery) => return self.body.battery = Some(battery),
            BodyEventKind::Link(link) if !link.is_up => format!("the {} does not answer", link.device),
            BodyEventKind::WheelDrop(wheels) if wheels.any() => "a wheel hangs".to_owned(),
            BodyEventKind::OverCurrent(wheels) if wheels.any() => "a motor draws too much current".to_owned(),
            BodyEventKind::Button(button) if button.pressed => format!("button B{} pressed", button.index),
            _ => return,
        };
        self.body.events.push(format!("{now:.1} s: {what}"));
    }

    fn on_wheels(&mut self, now: f64, ticks: &WheelTicks) {
        self.wheels.push(now);
        if let Some(last) = self.last_ticks.replace(*ticks) {
            let metres = |from: u16, to: u16| {
                f64::from(to.wrapping_sub(from).cast_signed()) * self.drive.metres_per_tick()
            };
            self.distances[0] += metres(last.left, ticks.left);
            self.distances[1] += metres(last.right, ticks.right);
            self.has_rolled |= (last.left, last.right) != (ticks.left, ticks.right);
        }
    }

    fn on_gyro(&mut self, now: f64, rate: &GyroRate) {
        self.gyro.push(now);
        if !self.has_rolled {
            self.rest_rates.push(rate.omega);
        }
        if let Some(last) = self.last_gyro.replace(*rate) {
            let dt = (rate.stamp - last.stamp).clamp(0.0, 0.1);
            self.gyro_turn += (rate.omega - mean(&self.rest_rates)) * dt;
        }
    }
}

impl CameraLog {
    fn on_image(&mut self, now: f64, image: &RgbdImage) {
        let depth = image.depth();
        let known = depth.data().iter().filter(|depth| **depth > 0.0).count();
        if self.images.len().is_multiple_of(FLOOR_STEP_IMAGES) {
            self.floor.add(depth, &self.camera);
        }
        self.images.push(ImageNote {
            arrival_s: now,
            age_ms: (Stamp::default().after(now) - image.stamp()) * 1e3,
            depth_part: known as f64 / depth.data().len().max(1) as f64,
        });
    }
}

/// The mean; 0 without values.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// The rate of readings by their arrivals \[Hz\], and the longest gap \[ms\]; `None` for fewer than two readings.
pub(super) fn rate_and_gap(arrivals: &[f64]) -> Option<(f64, f64)> {
    let (first, last) = (arrivals.first()?, arrivals.last()?);
    let gap = arrivals.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    (last > first).then(|| ((arrivals.len() - 1) as f64 / (last - first), gap * 1e3))
}
