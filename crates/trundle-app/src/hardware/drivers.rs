//! The drivers of base and camera, in their own threads.

use crate::real_time::DeviceReport;
use crate::{AppError, stop};
use nalgebra::UnitQuaternion;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};
use trundle_core::{PinholeCamera, SensorEvent, Stamp, Twist2};
use trundle_drivers::camera::camera_thread::{
    CameraThread, CameraThreadConfig, CameraThreadParts, StampMapFactory,
};
use trundle_drivers::camera::{CameraError, CameraInfo, DepthCamera};
use trundle_drivers::clock::{DeviceClock, DeviceClockConfig, HostClock};
use trundle_drivers::kobuki::{Accessories, KobukiBase, KobukiBaseConfig, Versions};
use trundle_drivers::{BaseSpec, CameraSpec};
use trundle_runtime::CameraMount;

/// Longest wait for a camera to open: a stream's writer may start after us. Source: ours.
const CAMERA_TIMEOUT: Duration = Duration::from_secs(10);

/// Name of the program of the command line.
const PROGRAM_NAME: &str = "trundle";

/// Longest wait for a lost camera to open again: in between, the driver's threads check for the end of the run. Source: ours.
const REOPEN_TIMEOUT: Duration = Duration::from_secs(1);

/// Source of the colour camera's intrinsics.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IntrinsicsSource {
    /// The camera's own.
    Device,
    /// The table `[camera]` of the robot file.
    Robot,
}

impl IntrinsicsSource {
    /// The choices of a front end: name, help text, value.
    pub const CHOICES: [(&'static str, &'static str, Self); 2] = [
        ("device", "The camera's own; its readout time is that of the robot file", Self::Device),
        ("robot", "The table [camera] of the robot file", Self::Robot),
    ];
}

/// Source of the robot's gyro.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GyroOrigin {
    /// The base: its gyro is at the axle, and its readings come in the packets of the wheels.
    Base,
    /// A RealSense camera with a gyro, for a base whose gyro is absent or broken.
    Camera,
}

impl GyroOrigin {
    /// The choices of a front end: name, help text, value.
    pub const CHOICES: [(&'static str, &'static str, Self); 2] = [
        ("base", "The base's own, in the packets of the wheels", Self::Base),
        ("camera", "That of a RealSense D435i or D455, for a base whose gyro is broken", Self::Camera),
    ];
}

/// A camera that is open, and how to open it again.
pub struct OpenCamera {
    spec: CameraSpec,
    camera: Box<dyn DepthCamera>,
    /// Rotation of the colour camera on the base, if the camera's gyro is read instead of the base's.
    gyro: Option<UnitQuaternion<f64>>,
}

impl OpenCamera {
    /// Opens the camera.
    ///
    /// # Errors
    /// When the camera does not exist or cannot be used, or the user interrupted.
    pub fn open(spec: &CameraSpec) -> Result<Self, AppError> {
        Self::open_by(spec, None)
    }

    /// Opens the camera, with its gyro if `gyro` says so; `mount` is that of the colour camera on the base.
    ///
    /// # Errors
    /// As [`OpenCamera::open`], and when the gyro is asked for and the camera has none that is read.
    pub fn open_with(spec: &CameraSpec, gyro: GyroOrigin, mount: &CameraMount) -> Result<Self, AppError> {
        match gyro {
            GyroOrigin::Base => Self::open(spec),
            GyroOrigin::Camera => Self::open_by(spec, Some(mount.base_from_camera().rotation)),
        }
    }

    fn open_by(spec: &CameraSpec, gyro: Option<UnitQuaternion<f64>>) -> Result<Self, AppError> {
        let (sender, opened) = channel();
        let asked = spec.clone();
        let open = move || _ = sender.send(open_camera(&asked, gyro.is_some(), CAMERA_TIMEOUT));
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
        Ok(Self { spec: spec.clone(), camera, gyro })
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
            "camera {} is a recording, expected a live camera: the robot would drive by old images; `trundle convert {} OUT` makes a folder \
             of it for `trundle slam`, and `trundle run --check` takes recordings",
            self.spec, self.spec
        )))
    }

    /// Refuses a live camera, whose images have no end.
    ///
    /// # Errors
    /// When the camera is live.
    pub(crate) fn require_recording(&self) -> Result<(), AppError> {
        if !self.info().is_live {
            return Ok(());
        }
        Err(AppError::Input(format!(
            "camera {} is live, expected a recording of a camera, as kinect2-dump:FILE or realsense:FILE.db3",
            self.spec
        )))
    }

    /// The camera alone.
    pub(crate) fn into_camera(self) -> Box<dyn DepthCamera> {
        self.camera
    }

    /// The intrinsics that the robot works with.
    ///
    /// # Errors
    /// When those of the robot file are of another image size than the camera's, or its readout time is not valid.
    pub fn intrinsics(
        &self,
        source: IntrinsicsSource,
        robot_file: &PinholeCamera,
    ) -> Result<PinholeCamera, AppError> {
        match source {
            IntrinsicsSource::Device => self.own_intrinsics(robot_file),
            IntrinsicsSource::Robot => self.checked_intrinsics(robot_file),
        }
    }

    /// The camera's own intrinsics. Cameras do not report the readout time of their rolling shutter: without it, that of the robot file.
    fn own_intrinsics(&self, robot_file: &PinholeCamera) -> Result<PinholeCamera, AppError> {
        let own = self.info().color.camera;
        if own.readout() > 0.0 {
            return Ok(own);
        }
        own.with_readout(robot_file.readout()).map_err(AppError::input)
    }

    /// The intrinsics of the robot file, which must have the camera's image size.
    fn checked_intrinsics(&self, robot_file: &PinholeCamera) -> Result<PinholeCamera, AppError> {
        let size = |camera: &PinholeCamera| format!("{} x {} px", camera.width(), camera.height());
        let (given, own) = (size(robot_file), size(&self.info().color.camera));
        if given == own {
            return Ok(*robot_file);
        }
        Err(AppError::Input(format!(
            "camera of the robot file is {given}, expected {own} as {} delivers",
            self.spec
        )))
    }

    /// The camera's own description.
    #[must_use]
    pub fn info(&self) -> &CameraInfo {
        self.camera.info()
    }
}

fn open_camera(
    spec: &CameraSpec,
    with_gyro: bool,
    timeout: Duration,
) -> Result<Box<dyn DepthCamera>, CameraError> {
    if with_gyro { spec.open_with_gyro() } else { spec.open(timeout, &helper_program()) }
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
        let OpenCamera { spec, camera, gyro } = camera;
        let config = KobukiBaseConfig::default();
        let sink = base_sink(send.clone(), gyro.is_none());
        let base =
            KobukiBase::start(base.connector(&helper_program()), config, Arc::clone(&clock), Box::new(sink))
                .map_err(AppError::input)?;
        let mut config = CameraThreadConfig::default();
        config.output = Some(output);
        config.gyro = gyro;
        let mut first = Some(camera);
        let reopen = move || open_camera(&spec, gyro.is_some(), REOPEN_TIMEOUT);
        let factory = move || first.take().map_or_else(&reopen, Ok);
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

    /// Lights and sounds of the base.
    #[must_use]
    pub fn accessories(&self) -> Accessories {
        self.base.accessories()
    }

    /// Versions of the base.
    #[must_use]
    pub fn versions(&self) -> Versions {
        self.base.versions()
    }

    /// What base and camera have read, dropped and lost so far.
    #[must_use]
    pub fn report(&self) -> DeviceReport {
        DeviceReport::of_camera(self.camera.counters(), self.camera.last_fault())
            .with_base(self.base.counters())
    }
}

/// The events of the base, with or without those of its gyro.
fn base_sink(send: impl Fn(SensorEvent), with_gyro: bool) -> impl Fn(SensorEvent) {
    move |event| {
        if with_gyro || !matches!(event, SensorEvent::Gyro(_)) {
            send(event);
        }
    }
}

/// A filter that maps the camera's clock to the host's, reset at each opening.
fn stamp_maps() -> StampMapFactory {
    Box::new(|info| {
        let mut config = DeviceClockConfig::default();
        config.transport_delay_s = info.delay_s;
        let mut clock = DeviceClock::new(config);
        Box::new(move |device, arrival| clock.to_host(device.nanos, arrival))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use trundle_drivers::camera::native::Selection;

    /// A folder camera of 640 x 480 px whose colour camera has this readout time \[s\].
    fn camera(folder: &std::path::Path, readout: f64) -> OpenCamera {
        let stream = |format: &str| {
            format!(
                "{{\"format\":\"{format}\",\"camera\":{{\"width\":640,\"height\":480,\"fx\":500.0,\"fy\":500.0,\"cx\":320.0,\"cy\":240.0,\
                 \"readout\":{readout}}},\"rate_hz\":30}}"
            )
        };
        let (color, depth) = (stream("mjpg"), stream("depth16"));
        let header = format!(
            "{{\"magic\":\"trundle-camera\",\"version\":1,\"name\":\"test\",\"color\":{color},\"depth\":{depth},\"live\":false}}\n"
        );
        fs::write(folder.join("camera.json"), header).unwrap();
        fs::create_dir_all(folder.join("color")).unwrap();
        fs::create_dir_all(folder.join("depth")).unwrap();
        OpenCamera::open(&format!("folder:{}", folder.display()).parse().unwrap()).unwrap()
    }

    #[test]
    fn a_camera_without_a_readout_time_gets_that_of_the_robot_file() {
        let folder = tempfile::tempdir().unwrap();
        let robot = PinholeCamera::kinect_v2().with_readout(0.02).unwrap();
        let own = camera(folder.path(), 0.0).own_intrinsics(&robot).unwrap();
        assert_eq!((own.fx(), own.readout()), (500.0, 0.02));
        let own = camera(folder.path(), 0.01).own_intrinsics(&robot).unwrap();
        assert_eq!((own.fx(), own.readout()), (500.0, 0.01));
    }

    #[test]
    fn a_recording_neither_drives_a_robot_nor_is_taken_for_a_live_camera() {
        let folder = tempfile::tempdir().unwrap();
        let camera = camera(folder.path(), 0.0);
        let refused = camera.require_live().unwrap_err().to_string();
        let name = format!("folder:{}", folder.path().display());
        assert!(refused.starts_with(&format!("camera {name} is a recording")), "{refused}");
        assert!(refused.contains(&format!("`trundle convert {name} OUT`")), "{refused}");
        assert!(camera.require_recording().is_ok());
        for name in ["openni2:drive.oni", "openni2:DRIVE.ONI", "orbbec:drive.bag", "freenect:drive.oni"] {
            let spec: CameraSpec = name.parse().unwrap();
            assert!(matches!(&spec, CameraSpec::Native(_, Selection::File(_))), "{name}");
        }
    }

    #[test]
    fn with_the_gyro_of_the_camera_that_of_the_base_is_left_out() {
        use trundle_core::{GyroRate, WheelTicks};
        let stamp = Stamp::default();
        for (with_gyro, expected) in [(true, 2), (false, 1)] {
            let count = std::cell::Cell::new(0);
            let sink = base_sink(|_| count.set(count.get() + 1), with_gyro);
            sink(SensorEvent::Gyro(GyroRate { stamp, omega: 0.1 }));
            sink(SensorEvent::Wheels(WheelTicks { stamp, left: 0, right: 0 }));
            assert_eq!(count.get(), expected);
        }
    }

    #[test]
    fn a_camera_without_a_gyro_is_refused() {
        let camera = "folder:x".parse().unwrap();
        let refused = OpenCamera::open_with(&camera, GyroOrigin::Camera, &CameraMount::default());
        let refused = refused.err().unwrap().to_string();
        assert!(refused.contains("does not offer a gyro: use realsense"), "{refused}");
    }

    #[test]
    fn intrinsics_of_another_size_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let camera = camera(folder.path(), 0.0);
        let refused = camera.checked_intrinsics(&PinholeCamera::kinect_v2()).unwrap_err().to_string();
        assert!(
            refused.contains("camera of the robot file is 512 x 424 px, expected 640 x 480 px"),
            "{refused}"
        );
        let own = camera.info().color.camera;
        assert_eq!(camera.checked_intrinsics(&own).unwrap(), own);
    }
}
