//! The hardware of a run: base and camera in threads of their own, as one body.

use crate::AppError;
use crate::real_time::{EventFeed, LiveBody, TimedEvent};
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_core::{PinholeCamera, SensorEvent, Stamp};
use trundle_drivers::camera::camera_thread::{
    CameraThread, CameraThreadConfig, CameraThreadParts, StampMapFactory,
};
use trundle_drivers::camera::{CameraError, CameraInfo, DepthCamera};
use trundle_drivers::clock::{DeviceClock, DeviceClockConfig, HostClock};
use trundle_drivers::kobuki::{KobukiBase, KobukiBaseConfig};
use trundle_drivers::{BaseSpec, CameraSpec};
use trundle_runtime::real_time::InboxSender;

/// Longest wait for a camera to open \[s\]: a stream's writer may start after us. Source: ours.
const CAMERA_TIMEOUT: Duration = Duration::from_secs(10);

/// A camera that is open, and how to open it again.
pub struct OpenCamera {
    spec: CameraSpec,
    camera: Box<dyn DepthCamera>,
}

impl OpenCamera {
    /// Opens the camera.
    ///
    /// # Errors
    /// When there is no such camera, or it cannot be used.
    pub fn open(spec: &CameraSpec) -> Result<Self, AppError> {
        let camera = spec.open(CAMERA_TIMEOUT).map_err(|error| refused(spec, &error))?;
        Ok(Self { spec: spec.clone(), camera })
    }

    /// What the camera says of itself.
    pub fn info(&self) -> &CameraInfo {
        self.camera.info()
    }
}

fn refused(spec: &CameraSpec, error: &CameraError) -> AppError {
    AppError::Input(format!("camera {spec}: {error}"))
}

/// Starts base and camera; `output` is the camera that the robot works with. Events go to `events`.
///
/// # Errors
/// When the base does not answer, or the system refuses a thread.
pub fn start_hardware(
    base: &BaseSpec,
    camera: OpenCamera,
    output: PinholeCamera,
    events: InboxSender<TimedEvent>,
) -> Result<LiveBody, AppError> {
    let origin = Instant::now();
    let feed = EventFeed::new(events, origin);
    let clock: HostClock = Arc::new(move || Stamp::default().after(origin.elapsed().as_secs_f64()));
    let sink = || -> Box<dyn FnMut(SensorEvent) + Send> {
        let feed = feed.clone();
        Box::new(move |event| feed.send(&event))
    };
    let base = KobukiBase::start(base.connector(), KobukiBaseConfig::default(), Arc::clone(&clock), sink())
        .map_err(|error| AppError::Input(format!("base {base}: {error}")))?;
    let config = CameraThreadConfig { output: Some(output), ..CameraThreadConfig::default() };
    let OpenCamera { spec, camera } = camera;
    let mut first = Some(camera);
    let factory = move || first.take().map_or_else(|| spec.open(CAMERA_TIMEOUT), Ok);
    let parts = CameraThreadParts { factory: Box::new(factory), sink: sink(), clock, stamps: stamp_maps() };
    let camera = CameraThread::start(parts, config)
        .map_err(|error| AppError::Environment(format!("cannot start the camera's threads: {error}")))?;
    let commands = base.commands();
    LiveBody::start(feed, Some(commands), move || {
        base.stop();
        drop(camera);
    })
}

/// The camera's clock mapped to the host's by a filter, anew for each opening.
fn stamp_maps() -> StampMapFactory {
    Box::new(|info| {
        let config = DeviceClockConfig { transport_delay_s: info.delay_s, ..DeviceClockConfig::default() };
        let mut clock = DeviceClock::new(config);
        Box::new(move |device, arrival| clock.to_host(device.nanos, arrival))
    })
}
