//! A camera as a user names it.

use crate::camera::kinect2::usb::KINECT2_USB_STATE;
use crate::camera::kinect2::{DecoderConfig, DumpCamera};
use crate::camera::native::openni2::{OpenNiSettings, serve_openni};
use crate::camera::native::realsense::{RealSenseApi, RealSenseCamera, RealSenseSettings};
use crate::camera::native::{NativeKind, Selection, open};
use crate::camera::pipe::{FolderCamera, ProcessCamera, StreamCamera, StreamWriter};
use crate::camera::{CameraError, CameraFrame, DepthCamera};
use std::fmt;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::str::FromStr;
use std::time::Duration;

/// Command of a program that writes the frames of a camera to its standard output: [`CameraSpec::serve`].
pub const SERVE_COMMAND: &str = "serve-camera";

/// A camera as a user names it: `stream:PATH`, `folder:PATH`, `realsense`, `realsense:SERIAL`, `realsense:FILE.db3` and so on.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum CameraSpec {
    /// Frames on a pipe, FIFO, file or standard input (`-`), as docs/camera-stream.md has them.
    Stream(PathBuf),
    /// A folder that grows, as docs/camera-stream.md has it.
    Folder(PathBuf),
    /// A camera, or a recording of one, through its maker's library.
    Native(NativeKind, Selection),
    /// A dump of the packets of a Kinect V2.
    Kinect2Dump(PathBuf),
}

/// Names of the kinds of camera, for messages.
const KINDS: &str = "realsense, freenect (Kinect v1), orbbec, openni2, kinect2 (needs the feature kinect2-usb), stream:PATH, \
     folder:PATH, kinect2-dump:FILE; a serial number or \
     recording may follow, as realsense:FILE.db3";

impl CameraSpec {
    /// Opens the camera; the head of a stream is waited for at most `timeout`. `program` has a command [`SERVE_COMMAND`]: cameras whose
    /// library may crash run in that process.
    ///
    /// # Errors
    /// When the camera does not exist, its library is missing, or it cannot be used.
    pub fn open(&self, timeout: Duration, program: &Path) -> Result<Box<dyn DepthCamera>, CameraError> {
        Ok(match self {
            Self::Stream(path) => Box::new(StreamCamera::open(path, timeout)?),
            Self::Folder(path) => Box::new(FolderCamera::open(path)?),
            Self::Kinect2Dump(file) => Box::new(DumpCamera::open(file, DecoderConfig::default())?),
            Self::Native(NativeKind::OpenNi2, _) => {
                let mut command = Command::new(program);
                command.args([SERVE_COMMAND, &self.to_string()]);
                Box::new(ProcessCamera::start(command, &self.to_string(), timeout)?)
            }
            Self::Native(kind, selection) => open(*kind, selection)?,
        })
    }

    /// Opens a RealSense camera with its gyro.
    ///
    /// # Errors
    /// As [`CameraSpec::open`], and for every other kind of camera: its gyro is not read.
    pub fn open_with_gyro(&self) -> Result<Box<dyn DepthCamera>, CameraError> {
        let Self::Native(NativeKind::RealSense, selection) = self else {
            return Err(CameraError::StreamsUnavailable {
                device: self.to_string(),
                wanted: "a gyro".to_owned(),
                remedy: "use realsense (D435i, D455), or the gyro of the base".to_owned(),
            });
        };
        let settings = RealSenseSettings { gyro: true, ..RealSenseSettings::default() };
        Ok(Box::new(RealSenseCamera::open(&RealSenseApi::load(None)?, selection, &settings)?))
    }

    /// Writes the frames of the camera to `out`, as docs/camera-stream.md has them, until that fails or the camera ends.
    ///
    /// # Errors
    /// When the camera cannot be opened or read, or writing fails.
    pub fn serve(&self, out: impl Write) -> Result<(), CameraError> {
        let Self::Native(NativeKind::OpenNi2, selection) = self else {
            let problem = "only a camera of kind openni2 is served".to_owned();
            return Err(CameraError::BadHeader { place: self.to_string(), problem });
        };
        serve_openni(selection, &OpenNiSettings::default(), |info| {
            let mut writer = StreamWriter::new(out, info)?;
            Ok(move |frame: CameraFrame| writer.write(&frame))
        })
    }

    fn native(kind: &str, which: Option<&str>) -> Option<Self> {
        let kind = NativeKind::ALL.iter().copied().find(|known| known.to_string() == kind)?;
        Some(Self::Native(kind, Selection::named(kind, which)))
    }
}

impl FromStr for CameraSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, which) = text.split_once(':').map_or((text, None), |(kind, which)| (kind, Some(which)));
        let camera = match (kind, which) {
            (_, Some("")) => None,
            ("stream", Some(path)) => Some(Self::Stream(path.into())),
            ("folder", Some(path)) => Some(Self::Folder(path.into())),
            ("kinect2-dump", Some(file)) => Some(Self::Kinect2Dump(file.into())),
            ("kinect2", _) if !cfg!(feature = "kinect2-usb") => return Err(KINECT2_USB_STATE.to_owned()),
            _ => Self::native(kind, which),
        };
        camera.ok_or_else(|| format!("no camera '{text}', expected one of {KINDS}"))
    }
}

impl fmt::Display for CameraSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stream(path) => write!(f, "stream:{}", path.display()),
            Self::Folder(path) => write!(f, "folder:{}", path.display()),
            Self::Kinect2Dump(file) => write!(f, "kinect2-dump:{}", file.display()),
            Self::Native(kind, Selection::First) => kind.fmt(f),
            Self::Native(kind, Selection::Serial(serial)) => write!(f, "{kind}:{serial}"),
            Self::Native(kind, Selection::File(file)) => write!(f, "{kind}:{}", file.display()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_is_named_by_kind_and_place() {
        for text in [
            "stream:-",
            "stream:/tmp/camera",
            "folder:images",
            "realsense",
            "realsense:832112070255",
            "realsense:drive.db3",
            "freenect",
            "orbbec",
            "openni2",
            "kinect2-dump:a.dump",
        ] {
            assert_eq!(text.parse::<CameraSpec>().unwrap().to_string(), text);
        }
        let file = Selection::File("drive.db3".into());
        assert_eq!("realsense:drive.db3".parse(), Ok(CameraSpec::Native(NativeKind::RealSense, file)));
        let recording = Selection::File("drive.oni".into());
        assert_eq!("openni2:drive.oni".parse(), Ok(CameraSpec::Native(NativeKind::OpenNi2, recording)));
        for text in ["", "stream", "stream:", "folder:", "webcam", "realsense:", "kinect2-dump"] {
            assert!(
                text.parse::<CameraSpec>().unwrap_err().starts_with(&format!("no camera '{text}', expected"))
            );
        }
    }

    #[test]
    fn only_a_realsense_has_a_gyro_that_is_read() {
        let error = "orbbec".parse::<CameraSpec>().unwrap().open_with_gyro().err().unwrap().to_string();
        assert!(error.contains("orbbec does not offer a gyro: use realsense"), "{error}");
    }

    #[test]
    fn a_kinect2_needs_its_feature() {
        let parsed = "kinect2:012345".parse::<CameraSpec>();
        if cfg!(feature = "kinect2-usb") {
            assert_eq!(parsed.unwrap().to_string(), "kinect2:012345");
        } else {
            assert!(parsed.unwrap_err().contains("cargo build --release --features kinect2-usb"));
        }
    }

    #[test]
    fn a_process_that_is_not_a_camera_is_named() {
        let mut command = Command::new("echo");
        command.arg("hello");
        let error = ProcessCamera::start(command, "openni2", Duration::from_secs(5)).unwrap_err().to_string();
        assert!(error.contains("openni2"), "{error}");
    }
}
