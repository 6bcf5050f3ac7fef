//! A camera of OpenNI2.

use super::functions::OpenNiApi;
use super::playback::{Playback, add};
use super::session::{Kind, OpenDevice, depth_unit_m, list_devices, pixel_format};
use crate::camera::native::freenect::calibration::depth_camera_pose;
use crate::camera::native::image_pair::ImagePair;
use crate::camera::native::{RgbdCalibration, Selection};
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera, RawImage, StreamInfo};
use std::ffi::c_int;
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

/// A camera of OpenNI2, or a recording of one.
#[derive(Debug)]
pub struct OpenNiCamera {
    info: CameraInfo,
    device: OpenDevice,
    images: Images,
}

/// Images that wait for their pair.
#[derive(Debug)]
enum Images {
    Live(ImagePair),
    Recorded(Playback),
}

impl OpenNiCamera {
    /// Opens a camera and starts its streams in their default modes, with depth registered to colour if the camera offers it. The serial
    /// number of `selection` is the URI of [`list_devices`]; `Dummy` is the driver's own test image. A recording plays as fast as it is read,
    /// once in the life of the program; its depth counts as not registered, as a camera delivers it by default.
    ///
    /// # Errors
    /// When the camera is missing or in use, it reports no field of view and the settings give no calibration, or it is a recording without
    /// the cropping of its streams.
    pub fn open(
        api: &Arc<OpenNiApi>,
        selection: &Selection,
        settings: &OpenNiSettings,
    ) -> Result<Self, CameraError> {
        let uri = uri(api, selection)?;
        let device = OpenDevice::open(api, &uri)?;
        let is_recording = device.is_recording();
        if is_recording && !device.has_cropping() {
            return Err(without_cropping(&uri));
        }
        let is_registered = device.register_depth();
        let info = CameraInfo { is_live: !is_recording, ..info(&device, settings, is_registered)? };
        let rate_hz = info.color.rate_hz.min(info.depth.rate_hz);
        let images = if is_recording {
            device.play_once()?;
            Images::Recorded(Playback::new(
                [Kind::Color, Kind::Depth].map(|kind| device.frame_count(kind)),
                rate_hz,
            ))
        } else {
            Images::Live(ImagePair::new(rate_hz))
        };
        device.start()?;
        Ok(Self { info, device, images })
    }
}

impl Images {
    /// Adds an image with its number in the stream; returns the pair that it completes.
    fn add(&mut self, kind: Kind, image: RawImage, number: c_int) -> Option<CameraFrame> {
        match self {
            Self::Recorded(playback) => playback.add(kind, image, number),
            Self::Live(pair) => add(pair, kind, image),
        }
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
            let Some((kind, image, number)) = self.device.next_image(left)? else {
                if let Images::Recorded(playback) = &mut self.images {
                    playback.on_silence(Instant::now());
                }
                return Ok(None);
            };
            if let Some(frame) = self.images.add(kind, image, number) {
                return Ok(Some(frame));
            }
            if self.has_ended() {
                return Ok(None);
            }
        }
    }

    fn has_ended(&self) -> bool {
        matches!(&self.images, Images::Recorded(playback) if playback.has_ended())
    }
}

fn uri(api: &Arc<OpenNiApi>, selection: &Selection) -> Result<String, CameraError> {
    match selection {
        Selection::Serial(uri) => Ok(uri.clone()),
        Selection::First => {
            let first = list_devices(api)?.into_iter().next();
            first.map(|device| device.serial).ok_or_else(|| CameraError::NoDevice { kind: KIND.into() })
        }
        Selection::File(file) => match file.to_str() {
            Some(path) if file.is_file() => Ok(path.to_owned()),
            _ => Err(CameraError::Io {
                place: file.display().to_string(),
                source: std::io::ErrorKind::NotFound.into(),
            }),
        },
    }
}

fn without_cropping(file: &str) -> CameraError {
    CameraError::StreamsUnavailable {
        device: format!("{KIND} {file}"),
        wanted: "the cropping of both streams, without which the library plays no image of a recording"
            .into(),
        remedy: "record a camera that has this property, as the Xtion and the Kinect v1 do".into(),
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
