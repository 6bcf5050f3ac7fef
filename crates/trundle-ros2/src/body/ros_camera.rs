//! The camera of a ROS 2 robot as a depth camera of the drivers: they convert, register and watch its frames.

use super::BodySettings;
use super::image_inbox::{ImageInbox, ReceivedImage};
use crate::convert::camera_info;
use crate::convert::image::{
    color_from_ros, compressed_color_from_ros, compressed_depth_from_ros, depth_from_ros,
};
use crate::node::Diagnostics;
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_core::{Invalid, PinholeCamera, Pose3};
use trundle_drivers::camera::{
    CameraError, CameraFrame, CameraInfo, DepthCamera, PixelFormat, RawImage, StreamInfo,
};

/// Rate of a camera whose rate is unknown \[Hz\]. Source: ours.
const ASSUMED_RATE_HZ: f64 = 30.0;
/// Length of a unit of whole-numbered depth \[m\]. Source: REP 118.
const DEPTH_UNIT_M: f64 = 0.001;

/// Settings to open the camera.
#[derive(Clone)]
pub struct RosCameraSource {
    /// Queue of the camera's messages.
    pub inbox: Arc<ImageInbox>,
    /// Topics.
    pub settings: BodySettings,
    /// The depth camera's pose in the colour camera's frame; `None` if depth is registered to colour.
    pub color_from_depth: Option<Pose3>,
    /// Receiver of reports on broken images.
    pub diagnostics: Diagnostics,
}

/// The camera of a ROS 2 robot.
pub struct RosCamera {
    source: RosCameraSource,
    info: CameraInfo,
}

impl RosCameraSource {
    /// Opens the camera: waits for its intrinsics and a first pair of images.
    ///
    /// # Errors
    /// Names the topic without a usable message within `timeout`.
    pub fn open(&self, timeout: Duration) -> Result<RosCamera, CameraError> {
        let end = Instant::now() + timeout;
        let no_device = |topic: &str| CameraError::NoDevice { kind: format!("ROS 2 topic {topic}") };
        let frame = loop {
            let left = end.saturating_duration_since(Instant::now());
            let Some(pair) = self.inbox.take(left.min(Duration::from_millis(50))) else {
                if left.is_zero() {
                    let has_info = self.inbox.infos().0.is_some();
                    return Err(no_device(if has_info {
                        &self.settings.color
                    } else {
                        &self.settings.camera_info
                    }));
                }
                continue;
            };
            match self.frame(pair) {
                Ok(frame) => break frame,
                Err(error) if Instant::now() >= end => return Err(CameraError::BrokenFrame(error)),
                Err(_) => {}
            }
        };
        let (color, depth) = self.cameras()?;
        let stream =
            |image: &RawImage, camera| StreamInfo { format: image.format, camera, rate_hz: ASSUMED_RATE_HZ };
        let info = CameraInfo {
            name: format!("ROS 2 camera {}", self.settings.color),
            serial: String::new(),
            firmware: String::new(),
            usb: None,
            color: stream(&frame.color, color),
            depth: stream(&frame.depth, depth),
            depth_unit_m: DEPTH_UNIT_M,
            color_from_depth: self.color_from_depth,
            delay_s: 0.0,
            is_live: true,
        };
        Ok(RosCamera { source: self.clone(), info })
    }

    /// The intrinsics of colour and depth.
    ///
    /// # Errors
    /// When they have not arrived or are unusable.
    pub fn cameras(&self) -> Result<(PinholeCamera, PinholeCamera), CameraError> {
        let (color, depth) = self.inbox.infos();
        let missing = || CameraError::NoDevice { kind: format!("ROS 2 topic {}", self.settings.camera_info) };
        let usable = |info, stream| {
            camera_info::from_ros(&info, self.settings.rectification())
                .map_err(|problem| CameraError::IntrinsicsUnusable { stream, problem })
        };
        let color = usable(color.ok_or_else(missing)?, "color")?;
        let depth = depth.map(|info| usable(info, "depth")).transpose()?;
        Ok((color, depth.unwrap_or(color)))
    }

    /// A pair of messages as a frame of the drivers.
    fn frame(&self, (color, depth): (ReceivedImage, ReceivedImage)) -> Result<CameraFrame, Invalid> {
        let (color_info, depth_info) = self.inbox.infos();
        let expected = |what: &str| format!("message on {what}: without it images have no size");
        let Some(color_info) = color_info else {
            let topic = &self.settings.camera_info;
            return Err(self.named(topic, Invalid::new("camera_info", "missing", "", expected(topic))));
        };
        let size = |info: &crate::generated::sensor_msgs::CameraInfoMessage| {
            (info.width as usize, info.height as usize)
        };
        let color_size = size(&color_info);
        let depth_size = depth_info.as_ref().map_or(color_size, size);
        let color = match color {
            ReceivedImage::Raw(image) => color_from_ros(image),
            ReceivedImage::Compressed(image) => compressed_color_from_ros(image, color_size),
        };
        let color = color.and_then(|image| of_size(image, color_size));
        let depth = match depth {
            ReceivedImage::Raw(image) => depth_from_ros(image),
            ReceivedImage::Compressed(image) => compressed_depth_from_ros(image),
        };
        let depth = depth.and_then(|image| of_size(image, depth_size));
        Ok(CameraFrame {
            color: color.map_err(|error| self.named(&self.settings.color, error))?,
            depth: depth.map_err(|error| self.named(&self.settings.depth, error))?,
        })
    }

    /// The error with its topic, after a report.
    fn named(&self, topic: &str, error: Invalid) -> Invalid {
        self.diagnostics.warn(topic, error.to_string());
        Invalid { field: format!("{} of {topic}", error.field), ..error }
    }
}

/// Passes an image of the size that the intrinsics have through.
fn of_size(image: RawImage, (width, height): (usize, usize)) -> Result<RawImage, Invalid> {
    if (image.width, image.height) == (width, height) {
        return Ok(image);
    }
    let value = format!("{} x {}", image.width, image.height);
    Err(Invalid::new("image size", value, "px", format!("{width} x {height} as camera_info says")))
}

impl DepthCamera for RosCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        let Some(pair) = self.source.inbox.take(timeout) else { return Ok(None) };
        let frame = self.source.frame(pair)?;
        let known: [PixelFormat; 2] = [self.info.color.format, self.info.depth.format];
        let (color, _) = self.source.cameras()?;
        if [frame.color.format, frame.depth.format] != known || color != self.info.color.camera {
            // The driver reopens the camera with the new size and format.
            return Err(CameraError::StreamsUnavailable {
                device: self.info.name.clone(),
                wanted: format!("{} with the intrinsics of the start", known[0]),
                remedy: "the publisher changed the images' size or form, and the camera is opened anew"
                    .to_owned(),
            });
        }
        Ok(Some(frame))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convert::image::{color_to_ros, depth_to_ros};
    use trundle_core::{ColorImage, DepthImage, Distortion, Stamp};

    fn camera(width: usize) -> PinholeCamera {
        PinholeCamera::new((width, 2), (3.0, 3.0), (1.0, 0.5), Distortion::default()).unwrap()
    }

    fn source() -> RosCameraSource {
        let diagnostics = Diagnostics::default();
        let inbox = Arc::new(ImageInbox::new(diagnostics.clone()));
        RosCameraSource { inbox, settings: BodySettings::default(), color_from_depth: None, diagnostics }
    }

    fn put_images(source: &RosCameraSource, width: usize, at: i64) {
        let stamp = Stamp::from_nanos(at);
        let color = color_to_ros(&ColorImage::filled(width, 2, [9; 3]), stamp, "camera");
        let depth = depth_to_ros(&DepthImage::filled(width, 2, 1.0), stamp, "camera");
        source.inbox.on_depth(stamp, ReceivedImage::Raw(depth));
        source.inbox.on_color(stamp, ReceivedImage::Raw(color));
    }

    #[test]
    fn images_without_intrinsics_are_named() {
        let source = source();
        put_images(&source, 4, 1);
        let error = source.open(Duration::from_millis(60)).map(drop).unwrap_err().to_string();
        assert!(error.contains("camera/color/camera_info"), "{error}");
        assert!(source.diagnostics.summary().contains("camera_info is missing"));
    }

    #[test]
    fn a_camera_delivers_pairs_and_names_a_changed_size() {
        let source = source();
        source.inbox.on_color_info(camera_info::to_ros(&camera(4), Stamp::default(), "camera"));
        put_images(&source, 4, 1);
        let mut camera_of_ros = source.open(Duration::from_secs(1)).unwrap();
        assert_eq!(camera_of_ros.info().color.camera, camera(4));
        put_images(&source, 4, 2);
        let frame = camera_of_ros.next_frame(Duration::ZERO).unwrap().unwrap();
        assert_eq!((frame.color.width, frame.depth.device_stamp.nanos), (4, 2));
        put_images(&source, 6, 3);
        let error = camera_of_ros.next_frame(Duration::ZERO).unwrap_err().to_string();
        assert!(
            error.contains("image size of camera/color/image_raw/compressed is 6 x 2 px, expected 4 x 2"),
            "{error}"
        );
        source.inbox.on_color_info(camera_info::to_ros(&camera(6), Stamp::default(), "camera"));
        put_images(&source, 6, 4);
        assert!(!camera_of_ros.next_frame(Duration::ZERO).unwrap_err().is_of_one_frame());
        assert!(source.open(Duration::ZERO).map(drop).is_err(), "a new opening waits for images");
        put_images(&source, 6, 5);
        assert_eq!(source.open(Duration::from_secs(1)).unwrap().info().color.camera.width(), 6);
    }
}
