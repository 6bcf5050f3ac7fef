//! Selection of a camera.

use crate::camera::UsbSpeed;
use std::fmt;
use std::path::PathBuf;

/// Endings of the recordings of all cameras, in lower case. Source: librealsense's recorder (`.db3`, `.bag`), OpenNI2's recorder (`.oni`),
/// OrbbecSDK's recorder (`.bag`), the dumps of a Kinect V2 (`.dump`).
const RECORDING_ENDINGS: [&str; 4] = [".db3", ".bag", ".oni", ".dump"];

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

    /// Whether a serial number of this kind may hold a slash: OpenNI2 names a camera by a URI, as `1d27/0601@1/9`.
    const fn has_slash_in_serial(self) -> bool {
        matches!(self, Self::OpenNi2)
    }

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
    /// The camera of `kind` that a user names by `which`: the first, a serial number, or a recording. Only this function decides by the name
    /// what a recording is: a base must not drive by one. A driver whose library opens files under any name must ask the library as well.
    #[must_use]
    pub fn named(kind: NativeKind, which: Option<&str>) -> Self {
        let lower = which.unwrap_or_default().to_lowercase();
        let is_path = lower.contains('/') && !kind.has_slash_in_serial();
        match which {
            None => Self::First,
            Some(file) if is_path || RECORDING_ENDINGS.iter().any(|end| lower.ends_with(end)) => {
                Self::File(file.into())
            }
            Some(serial) => Self::Serial(serial.to_owned()),
        }
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_recording_of_any_maker_is_a_file_for_every_kind_of_camera() {
        for kind in NativeKind::ALL {
            for name in
                ["drive.db3", "drive.bag", "drive.oni", "DRIVE.ONI", "a b.Bag", "kinect.dump", "d/x.oni"]
            {
                assert_eq!(
                    Selection::named(*kind, Some(name)),
                    Selection::File(name.into()),
                    "{kind}:{name}"
                );
            }
        }
    }

    #[test]
    fn a_serial_number_of_any_maker_is_a_camera() {
        use NativeKind::{Freenect, OpenNi2, Orbbec, RealSense};
        let serials = [
            (RealSense, "832112070255"),
            (Freenect, "A00362A08602047A"),
            (Orbbec, "AB12"),
            (OpenNi2, "1d27/0601@1/9"),
            (OpenNi2, "freenect://0"),
            (OpenNi2, "Dummy"),
        ];
        for (kind, serial) in serials {
            assert_eq!(Selection::named(kind, Some(serial)), Selection::Serial(serial.into()), "{kind}");
        }
        assert!(NativeKind::ALL.iter().all(|kind| Selection::named(*kind, None) == Selection::First));
    }

    #[test]
    fn a_path_is_a_file_except_where_a_serial_number_looks_like_one() {
        for kind in NativeKind::ALL {
            let is_file = matches!(Selection::named(*kind, Some("/dev/shm/drive")), Selection::File(_));
            assert_eq!(is_file, *kind != NativeKind::OpenNi2, "{kind}");
        }
    }
}
