//! Selection of a camera.

use crate::camera::UsbSpeed;
use std::fmt;
use std::path::PathBuf;

/// Kind of a camera, named after the library that drives it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NativeKind {
    /// RealSense D4xx, librealsense2.
    RealSense,
    /// Kinect v1, libfreenect.
    Freenect,
    /// Orbbec, OrbbecSDK 2.
    Orbbec,
    /// Xtion and Astra, OpenNI2.
    OpenNi2,
    /// Kinect V2, libusb.
    #[cfg(feature = "kinect2-usb")]
    Kinect2Usb,
}

impl NativeKind {
    /// All kinds.
    pub const ALL: &[Self] = &[
        Self::RealSense,
        Self::Freenect,
        Self::Orbbec,
        Self::OpenNi2,
        #[cfg(feature = "kinect2-usb")]
        Self::Kinect2Usb,
    ];

    /// The cameras of this kind, for messages.
    pub fn cameras(self) -> &'static str {
        match self {
            Self::RealSense => "RealSense",
            Self::Freenect => "Kinect v1",
            Self::Orbbec => "Orbbec",
            Self::OpenNi2 => "Xtion or Astra",
            #[cfg(feature = "kinect2-usb")]
            Self::Kinect2Usb => "Kinect V2",
        }
    }
}

/// The name in settings, as `realsense`.
impl fmt::Display for NativeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::RealSense => "realsense",
            Self::Freenect => "freenect",
            Self::Orbbec => "orbbec",
            Self::OpenNi2 => "openni2",
            #[cfg(feature = "kinect2-usb")]
            Self::Kinect2Usb => "kinect2",
        })
    }
}

/// Selection of a camera of a kind.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Selection {
    /// The first that the library lists.
    #[default]
    First,
    /// The one with this serial number.
    Serial(String),
    /// A recording.
    File(PathBuf),
}

impl Selection {
    /// The camera in words, for errors.
    pub(in crate::camera) fn describe(&self, kind: &str) -> String {
        match self {
            Self::First => kind.to_owned(),
            Self::Serial(serial) => format!("{kind} with serial number {serial}"),
            Self::File(file) => file.display().to_string(),
        }
    }
}

/// A connected camera.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceEntry {
    /// Name of the model.
    pub name: String,
    /// Serial number; empty if unknown.
    pub serial: String,
    /// Version of the firmware; empty if unknown.
    pub firmware: String,
    /// Speed of the USB connection; `None` if unknown or not USB.
    pub usb: Option<UsbSpeed>,
}
