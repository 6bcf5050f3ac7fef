//! A camera's own description.

use super::PixelFormat;
use serde::{Deserialize, Serialize};
use std::fmt;
use trundle_core::{PinholeCamera, Pose3};

/// A camera's own description.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraInfo {
    /// Name of the model.
    pub name: String,
    /// Serial number; empty if unknown.
    pub serial: String,
    /// Version of the firmware; empty if unknown.
    pub firmware: String,
    /// Speed of the USB connection; `None` if unknown or not USB.
    pub usb: Option<UsbSpeed>,
    /// The colour stream. Its camera has the readout time of the rolling shutter.
    pub color: StreamInfo,
    /// The depth stream.
    pub depth: StreamInfo,
    /// Length of one unit of whole-numbered depth \[m\]. 0.001 for millimetres.
    pub depth_unit_m: f64,
    /// Pose of the depth camera in the colour camera's frame; `None` if the camera delivers depth registered to colour.
    pub color_from_depth: Option<Pose3>,
    /// Time from the middle of the exposure to the arrival of the frame at the host \[s\].
    pub delay_s: f64,
    /// Whether frames arrive at the camera's own rate. A recording waits for its reader.
    pub is_live: bool,
}

/// A stream of a camera.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StreamInfo {
    /// Form of the pixels.
    pub format: PixelFormat,
    /// Intrinsics and size of the image.
    pub camera: PinholeCamera,
    /// Frames per second \[Hz\].
    pub rate_hz: f64,
}

/// Speed of a USB connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum UsbSpeed {
    /// USB 1.1, 12 Mbit/s.
    Full,
    /// USB 2.0, 480 Mbit/s.
    High,
    /// USB 3.0, 5 Gbit/s or more.
    Super,
}

impl fmt::Display for UsbSpeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Full => "USB 1 (12 Mbit/s)",
            Self::High => "USB 2 (480 Mbit/s)",
            Self::Super => "USB 3 (5 Gbit/s)",
        })
    }
}
