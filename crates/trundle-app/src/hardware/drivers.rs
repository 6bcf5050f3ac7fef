//! The drivers of base and camera, in their own threads.

use crate::{AppError, stop};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};
use trundle_core::{PinholeCamera, SensorEvent, Stamp, Twist2};
use trundle_drivers::camera::camera_thread::{
    CameraCounters, CameraThread, CameraThreadConfig, CameraThreadParts, StampMapFactory,
};
use trundle_drivers::camera::{CameraError, CameraInfo, DepthCamera};
use trundle_drivers::clock::{DeviceClock, DeviceClockConfig, HostClock};
use trundle_drivers::kobuki::{BaseCounters, KobukiBase, KobukiBaseConfig, Versions};
use trundle_drivers::{BaseSpec, CameraSpec};

/// Longest wait for a camera to open: a stream's writer may start after us. Source: ours.
const CAMERA_TIMEOUT: Duration = Duration::from_secs(10);

/// Name of the program of the command line.
const PROGRAM_NAME: &str = "trundle";

/// Longest wait for a lost camera to open again: in between, the driver's threads check for the end of the run. Source: ours.
const REOPEN_TIMEOUT: Duration = Duration::from_secs(1);

/// A camera that is open, and how to open it again.
pub struct OpenCamera {
    spec: CameraSpec,
    camera: Box<dyn DepthCamera>,
}

impl OpenCamera {
    /// Opens the camera.
    ///
    /// # Errors
    /// When the camera does not exist or cannot be used, or the user interrupted.
    pub fn open(spec: &CameraSpec) -> Result<Self, AppError> {
        let (sender, opened) = channel();
        let asked = spec.clone();
        let open = move || _ = sender.send(asked.open(CAMERA_TIMEOUT, &helper_program()));
        std::thread::Builder::new()
            .name("open-camera".to_owned())
            .spawn(open)
            .map_err(|error| AppError::Environment(format!("cannot start a thread: {error}")))?;
        let camera = loop {
            match opened.recv_timeout(stop::POLL_PERIOD) {
                Ok(camera) => break camera.map_err(|error| refused(spec, &error))?,
                Err(RecvTimeoutError::Timeout) if stop::is_requested(|| "nothing".to_owned()) => {
                    return Err(AppError::Stopped);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(AppError::Environment(format!("camera {spec}: its driver panicked")));
                }
            }
        };
        Ok(Self { spec: spec.clone(), camera })
    }

    /// Refuses a recorded camera: a base must not drive by old images.
    ///
    /// # Errors
    /// When the camera is a recording.
    pub fn require_live(&self) -> Result<(), AppError> {
        if self.info().is_live {
            return Ok(());
        }
        Err(AppError::Input(format!(
            "camera {} is a recording, expected a live camera: the robot would drive by old images; `trundle slam` and `trundle run --check` \
             take recordings",
            self.spec
        )))
    }

    /// The intrinsics that the robot works with: those given, else the camera's own.
    ///
    /// # Errors
    /// When those given are of another image size.
    pub fn intrinsics(&self, given: Option<&PinholeCamera>) -> Result<PinholeCamera, AppError> {
        let own = self.info().color.camera;
        let size = |camera: &PinholeCamera| format!("{} x {} px", camera.width(), camera.height());
        match given {
            None => Ok(own),
            Some(given) if size(given) == size(&own) => Ok(*given),
            Some(given) => Err(AppError::Input(format!(
                "camera of the robot file is {}, expected {} as {} delivers",
                size(given),
                size(&own),
                self.spec
            ))),
        }
    }

    /// The camera's own description.
    #[must_use]
    pub fn info(&self) -> &CameraInfo {
        self.camera.info()
    }
}

/// Path of the program `trundle`, for its helper commands `serve-camera` and `guard-base`: the present program if it is `trundle`, else the
/// one in the search path.
fn helper_program() -> PathBuf {
    let is_trundle = |program: &PathBuf| program.file_stem().is_some_and(|name| name == PROGRAM_NAME);
    std::env::current_exe().ok().filter(is_trundle).unwrap_or_else(|| PROGRAM_NAME.into())
}

fn refused(spec: &CameraSpec, error: &CameraError) -> AppError {
    AppError::Input(format!("camera {spec}: {error}"))
}

/// Running drivers of base and camera. Dropping them stops the base.
pub struct Drivers {
    base: KobukiBase,
    camera: CameraThread,
}

impl Drivers {
    /// Starts base and camera; `output` is the camera that the robot works with. Stamps count from `origin`. `send` receives the events,
    /// from several threads.
    ///
    /// # Errors
    /// When the base does not answer, or the system refuses a thread.
    pub fn start(
        base: &BaseSpec,
        camera: OpenCamera,
        output: PinholeCamera,
        origin: Instant,
        send: impl Fn(SensorEvent) + Clone + Send + 'static,
    ) -> Result<Self, AppError> {
        let clock: HostClock = Arc::new(move || Stamp::default().after(origin.elapsed().as_secs_f64()));
        let config = KobukiBaseConfig::default();
        let base = KobukiBase::start(
            base.connector(&helper_program()),
            config,
            Arc::clone(&clock),
            Box::new(send.clone()),
        )
        .map_err(AppError::input)?;
        let config = CameraThreadConfig { output: Some(output), ..CameraThreadConfig::default() };
        let OpenCamera { spec, camera } = camera;
        let mut first = Some(camera);
        let factory = move || first.take().map_or_else(|| spec.open(REOPEN_TIMEOUT, &helper_program()), Ok);
        let parts = CameraThreadParts {
            factory: Box::new(factory),
            sink: Box::new(send),
            clock,
            stamps: stamp_maps(),
        };
        let camera = CameraThread::start(parts, config)
            .map_err(|error| AppError::Environment(format!("cannot start the camera's threads: {error}")))?;
        Ok(Self { base, camera })
    }

    /// Sender for commands to the base.
    #[must_use]
    pub fn commands(&self) -> Sender<Twist2> {
        self.base.commands()
    }

    /// Versions of the base.
    #[must_use]
    pub fn versions(&self) -> Versions {
        self.base.versions()
    }

    /// Bytes read and dropped so far.
    #[must_use]
    pub fn counters(&self) -> (BaseCounters, CameraCounters) {
        (self.base.counters(), self.camera.counters())
    }

    /// The last fault of the camera, in words.
    #[must_use]
    pub fn camera_fault(&self) -> Option<String> {
        self.camera.last_fault()
    }
}

/// A filter that maps the camera's clock to the host's, reset at each opening.
fn stamp_maps() -> StampMapFactory {
    Box::new(|info| {
        let config = DeviceClockConfig { transport_delay_s: info.delay_s, ..DeviceClockConfig::default() };
        let mut clock = DeviceClock::new(config);
        Box::new(move |device, arrival| clock.to_host(device.nanos, arrival))
    })
}
