//! A camera as a user names it.

use crate::camera::pipe::{FolderCamera, StreamCamera};
use crate::camera::{CameraError, DepthCamera};
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

/// A camera as a user names it: `stream:PATH`, `folder:PATH`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum CameraSpec {
    /// Frames on a pipe, FIFO, file or standard input (`-`), as docs/camera-stream.md has them.
    Stream(PathBuf),
    /// A folder that grows, as docs/camera-stream.md has it.
    Folder(PathBuf),
}

/// What the kinds of camera are called, for messages.
const KINDS: &str = "stream:PATH, folder:PATH";

impl CameraSpec {
    /// Opens the camera; a stream's header is waited for at most `timeout`.
    ///
    /// # Errors
    /// When there is no such camera, or it cannot be used.
    pub fn open(&self, timeout: Duration) -> Result<Box<dyn DepthCamera>, CameraError> {
        Ok(match self {
            Self::Stream(path) => Box::new(StreamCamera::open(path, timeout)?),
            Self::Folder(path) => Box::new(FolderCamera::open(path)?),
        })
    }
}

impl FromStr for CameraSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            Some(("stream", path)) if !path.is_empty() => Ok(Self::Stream(path.into())),
            Some(("folder", path)) if !path.is_empty() => Ok(Self::Folder(path.into())),
            _ => Err(format!("no camera '{text}', expected one of {KINDS}")),
        }
    }
}

impl fmt::Display for CameraSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stream(path) => write!(f, "stream:{}", path.display()),
            Self::Folder(path) => write!(f, "folder:{}", path.display()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_is_named_by_kind_and_place() {
        for text in ["stream:-", "stream:/tmp/camera", "folder:images"] {
            assert_eq!(text.parse::<CameraSpec>().unwrap().to_string(), text);
        }
        for text in ["", "stream", "folder:", "webcam"] {
            assert!(
                text.parse::<CameraSpec>().unwrap_err().starts_with(&format!("no camera '{text}', expected"))
            );
        }
    }
}
