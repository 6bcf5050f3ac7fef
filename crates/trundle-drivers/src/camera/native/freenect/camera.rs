//! A Kinect v1.

use super::calibration::assumed_calibration;
use super::functions::FreenectApi;
use super::receiver::{Receiver, on_depth, on_video};
use super::session::{KIND, OpenKinect, Session};
use crate::camera::native::{DeviceEntry, RgbdCalibration, Selection};
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera, PixelFormat, StreamInfo};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Frames per second \[Hz\]. Source: OpenKinect wiki, "Imaging information".
const RATE_HZ: f64 = 30.0;
/// Time from the middle of the exposure to the arrival of a frame \[s\]. Source: ours, assumed: one frame of readout and depth computation,
/// half an exposure. Measure the delay if it matters.
const DEFAULT_DELAY_S: f64 = 0.05;
/// Length of one unit of depth \[m\]; without use for raw disparity, which has its own formula. Source: `libfreenect.h`,
/// `FREENECT_DEPTH_MM`.
const DEPTH_UNIT_M: f64 = 0.001;

/// Settings of a Kinect v1.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct FreenectSettings {
    /// The calibration; `None` for the assumed one.
    pub calibration: Option<RgbdCalibration>,
    /// Time from the middle of the exposure to the arrival of a frame \[s\]. Default 0.05, assumed.
    pub delay_s: f64,
    /// File of the library; `None` if it is searched.
    pub library: Option<PathBuf>,
}

impl Default for FreenectSettings {
    fn default() -> Self {
        Self { calibration: None, delay_s: DEFAULT_DELAY_S, library: None }
    }
}

/// A Kinect v1, or a folder of `fakenect-record` played by fakenect.
#[derive(Debug)]
pub struct FreenectCamera {
    info: CameraInfo,
    kinect: OpenKinect,
    receiver: Receiver,
    has_ended: bool,
}

impl FreenectCamera {
    /// Opens a Kinect and starts its streams, 640 x 480 at 30 Hz. Depth is raw disparity, not registered to colour.
    ///
    /// # Errors
    /// When the camera is missing, in use or forbidden.
    pub fn open(
        api: &Arc<FreenectApi>,
        selection: &Selection,
        settings: &FreenectSettings,
    ) -> Result<Self, CameraError> {
        if let Selection::File(file) = selection {
            return Err(no_recording(&file.display().to_string()));
        }
        let session = Session::new(api)?;
        let serial = match selection {
            Selection::Serial(serial) => serial.clone(),
            _ => session.devices().into_iter().next().map(|device| device.serial).unwrap_or_default(),
        };
        let info = info(serial, settings, !api.is_fake())?;
        let kinect = session.open(selection)?;
        kinect.start(on_video, on_depth)?;
        Ok(Self { info, kinect, receiver: Receiver::new(RATE_HZ), has_ended: false })
    }
}

/// The connected Kinects.
///
/// # Errors
/// When the library refuses.
pub fn list_devices(api: &Arc<FreenectApi>) -> Result<Vec<DeviceEntry>, CameraError> {
    Ok(Session::new(api)?.devices())
}

impl DepthCamera for FreenectCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        let start = Instant::now();
        while !self.has_ended {
            let left = timeout.saturating_sub(start.elapsed());
            let Self { kinect, receiver, .. } = self;
            let code = receiver.during(|| kinect.process(left));
            if let Some(frame) = receiver.take_pair() {
                return Ok(Some(frame));
            }
            match (code < 0, self.info.is_live) {
                (true, true) => return Err(CameraError::Unplugged { device: KIND.into() }),
                (is_over, _) => self.has_ended = is_over,
            }
            if left.is_zero() {
                break;
            }
        }
        Ok(None)
    }

    fn has_ended(&self) -> bool {
        self.has_ended
    }
}

fn info(serial: String, settings: &FreenectSettings, is_live: bool) -> Result<CameraInfo, CameraError> {
    let assumed = assumed_calibration()
        .map_err(|problem| CameraError::IntrinsicsUnusable { stream: "depth", problem })?;
    if settings.calibration.is_none() {
        tracing::info!(
            "the calibration of the Kinect v1 is assumed: give the one of this camera in the settings"
        );
    }
    let calibration = settings.calibration.unwrap_or(assumed);
    let stream = |format, camera| StreamInfo { format, camera, rate_hz: RATE_HZ };
    Ok(CameraInfo {
        name: KIND.into(),
        serial,
        firmware: String::new(),
        usb: None,
        color: stream(PixelFormat::Rgb8, calibration.color),
        depth: stream(PixelFormat::Disparity11, calibration.depth),
        depth_unit_m: DEPTH_UNIT_M,
        color_from_depth: calibration.color_from_depth,
        delay_s: settings.delay_s,
        is_live,
    })
}

fn no_recording(file: &str) -> CameraError {
    CameraError::StreamsUnavailable {
        device: KIND.into(),
        wanted: format!("the recording {file}"),
        remedy: "set FAKENECT_PATH to a folder of fakenect-record and TRUNDLE_FREENECT_LIB to fakenect/libfreenect.so.0.5, \
            and choose no file"
            .into(),
    }
}
