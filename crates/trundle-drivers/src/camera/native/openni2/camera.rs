//! A camera of OpenNI2.

use super::functions::OpenNiApi;
use super::session::{Kind, OpenDevice, depth_unit_m, list_devices, pixel_format};
use crate::camera::native::freenect::calibration::depth_camera_pose;
use crate::camera::native::image_pair::ImagePair;
use crate::camera::native::{RgbdCalibration, Selection};
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera, StreamInfo};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_core::PinholeCamera;

/// Time from the middle of the exposure to the arrival of a frame \[s\]. Source: ours, assumed as for the Kinect v1, whose sensor it is.
const DEFAULT_DELAY_S: f64 = 0.05;
/// Kind of the camera, in errors.
const KIND: &str = "OpenNI2";

/// Settings of a camera of OpenNI2.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OpenNiSettings {
    /// The calibration; `None` for the fields of view that the camera reports, without distortion.
    pub calibration: Option<RgbdCalibration>,
    /// Time from the middle of the exposure to the arrival of a frame \[s\]. Default 0.05, assumed.
    pub delay_s: f64,
    /// File of the library; `None` if it is searched.
    pub library: Option<PathBuf>,
}

impl Default for OpenNiSettings {
    fn default() -> Self {
        Self { calibration: None, delay_s: DEFAULT_DELAY_S, library: None }
    }
}

/// A camera of OpenNI2.
#[derive(Debug)]
pub struct OpenNiCamera {
    info: CameraInfo,
    device: OpenDevice,
    pair: ImagePair,
}

impl OpenNiCamera {
    /// Opens a camera and starts its streams in their default modes, with depth registered to colour if the camera offers it. The serial
    /// number of `selection` is the URI of [`list_devices`]; `Dummy` is the driver's own test image.
    ///
    /// # Errors
    /// When the camera is missing or in use, it reports no field of view and the settings give no calibration, or it is a recording.
    pub fn open(
        api: &Arc<OpenNiApi>,
        selection: &Selection,
        settings: &OpenNiSettings,
    ) -> Result<Self, CameraError> {
        let uri = uri(api, selection)?;
        let device = OpenDevice::open(api, &uri)?;
        if device.is_recording() {
            return Err(no_recording(&uri));
        }
        let is_registered = device.register_depth();
        let info = info(&device, settings, is_registered)?;
        device.start()?;
        let pair = ImagePair::new(info.color.rate_hz.min(info.depth.rate_hz));
        Ok(Self { info, device, pair })
    }
}

impl DepthCamera for OpenNiCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        let start = Instant::now();
        loop {
            let left = timeout.saturating_sub(start.elapsed());
            match self.device.next_image(left)? {
                Some((Kind::Color, image)) => self.pair.color = Some(image),
                Some((Kind::Depth, image)) => self.pair.depth = Some(image),
                None => return Ok(None),
            }
            if let Some(frame) = self.pair.take() {
                return Ok(Some(frame));
            }
        }
    }
}

fn uri(api: &Arc<OpenNiApi>, selection: &Selection) -> Result<String, CameraError> {
    match selection {
        Selection::Serial(uri) => Ok(uri.clone()),
        Selection::First => {
            let first = list_devices(api)?.into_iter().next();
            first.map(|device| device.serial).ok_or_else(|| CameraError::NoDevice { kind: KIND.into() })
        }
        Selection::File(file) => Err(no_recording(&file.display().to_string())),
    }
}

fn no_recording(file: &str) -> CameraError {
    CameraError::StreamsUnavailable {
        device: KIND.into(),
        wanted: format!("the recording {file}"),
        remedy: "convert it to a camera stream, or name a camera as `trundle devices` lists it".into(),
    }
}

fn info(
    device: &OpenDevice,
    settings: &OpenNiSettings,
    is_registered: bool,
) -> Result<CameraInfo, CameraError> {
    let about = device.about()?;
    let color = stream(device, Kind::Color, settings.calibration.map(|own| own.color), "colour")?;
    let depth = stream(device, Kind::Depth, settings.calibration.map(|own| own.depth), "depth")?;
    let own_pose = settings.calibration.map_or(Some(depth_camera_pose()), |own| own.color_from_depth);
    Ok(CameraInfo {
        name: about.name,
        serial: about.serial,
        firmware: about.firmware,
        usb: about.usb,
        color,
        depth,
        depth_unit_m: depth_unit_m(device.mode(Kind::Depth)?),
        color_from_depth: own_pose.filter(|_| !is_registered),
        delay_s: settings.delay_s,
        is_live: true,
    })
}

fn stream(
    device: &OpenDevice,
    kind: Kind,
    calibrated: Option<PinholeCamera>,
    stream: &'static str,
) -> Result<StreamInfo, CameraError> {
    let mode = device.mode(kind)?;
    let side = |pixels| usize::try_from(pixels).unwrap_or(0);
    let size = (side(mode.width), side(mode.height));
    let reported = || PinholeCamera::from_field_of_view(size, device.fields_of_view(kind));
    let camera = calibrated.map_or_else(reported, Ok);
    let camera = camera.map_err(|problem| CameraError::IntrinsicsUnusable { stream, problem })?;
    Ok(StreamInfo { format: pixel_format(mode.format)?, camera, rate_hz: f64::from(mode.rate_hz) })
}
