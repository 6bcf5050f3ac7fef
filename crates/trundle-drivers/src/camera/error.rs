//! The errors of a depth camera.

use super::UsbSpeed;
use std::io::ErrorKind;
use trundle_core::Invalid;

/// Reason why a camera cannot be opened or read. Each sentence ends with a remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The library of the camera's maker is not installed.
    #[error("the library {name} is not installed: {remedy}")]
    LibraryMissing {
        /// Name of the library, as the loader searches it.
        name: String,
        /// Remedy for the missing library.
        remedy: String,
    },
    /// The library is installed in a version that does not suit.
    #[error("the library {name} has version {found}, expected {expected}: install that version")]
    VersionUnsuitable {
        /// Name of the library.
        name: String,
        /// Version found.
        found: String,
        /// Versions that suit.
        expected: String,
    },
    /// The library is installed, but the loader refuses it.
    #[error("the library {name} cannot be loaded from {file}: {problem}: {remedy}")]
    LibraryBroken {
        /// Name of the library.
        name: String,
        /// File of the library, and the setting that names it.
        file: String,
        /// Message of the loader.
        problem: String,
        /// The remedy.
        remedy: String,
    },
    /// A function of the library failed for a reason without a specific variant.
    #[error("the library {library} failed in {function}: {message}: {remedy}")]
    LibraryFailed {
        /// Name of the library.
        library: String,
        /// Name of the function.
        function: String,
        /// Message of the library.
        message: String,
        /// The remedy.
        remedy: String,
    },
    /// The camera does not offer the requested streams.
    #[error("the camera {device} does not offer {wanted}: {remedy}")]
    StreamsUnavailable {
        /// The camera.
        device: String,
        /// Size, rate and format of the streams.
        wanted: String,
        /// The remedy.
        remedy: String,
    },
    /// No such camera is connected.
    #[error("no camera of kind {kind} is connected: check its cable and its power supply")]
    NoDevice {
        /// Kind of the camera, or its serial number.
        kind: String,
    },
    /// Another program uses the camera.
    #[error("the camera {device} is in use by another program: stop that program")]
    Busy {
        /// The camera.
        device: String,
    },
    /// The user has no permission to open the camera.
    #[error("no permission to open the camera {device}: {remedy}")]
    NoPermission {
        /// The camera.
        device: String,
        /// Remedy for the missing permission.
        remedy: String,
    },
    /// The camera was unplugged.
    #[error("the camera {device} is disconnected: check its cable and its power supply")]
    Unplugged {
        /// The camera.
        device: String,
    },
    /// The camera is connected to a port that is too slow.
    #[error(
        "the camera {device} is connected by {speed}, expected USB 3: use a blue USB port and a USB 3 cable"
    )]
    UsbTooSlow {
        /// The camera.
        device: String,
        /// Speed of the connection.
        speed: UsbSpeed,
    },
    /// The camera reports no usable intrinsics.
    #[error(
        "the intrinsics of the {stream} camera are unusable: {problem}: calibrate the camera, or give its intrinsics in the settings"
    )]
    IntrinsicsUnusable {
        /// The stream, colour or depth.
        stream: &'static str,
        /// The number that is wrong.
        problem: Invalid,
    },
    /// The camera delivers the same frame repeatedly.
    #[error("the camera delivered the same frame {frames} times: open it anew")]
    Stuck {
        /// Identical frames in a row.
        frames: usize,
    },
    /// One frame is damaged.
    #[error("a frame is broken: {0}: the next frame may be good")]
    BrokenFrame(#[from] Invalid),
    /// A stream of frames does not have the documented form.
    #[error("the camera stream {place} has no valid header: {problem}: see docs/camera-stream.md")]
    BadHeader {
        /// The file, pipe or folder.
        place: String,
        /// The problem.
        problem: String,
    },
    /// Reading failed.
    #[error("the camera stream {place} cannot be read: {}", reason(source))]
    Io {
        /// The file, pipe or folder.
        place: String,
        /// The cause.
        source: std::io::Error,
    },
}

/// Reason why a file cannot be read, and the remedy.
fn reason(source: &std::io::Error) -> String {
    match source.kind() {
        ErrorKind::NotFound => {
            "it does not exist: check its name, or start the program that writes it".to_owned()
        }
        ErrorKind::PermissionDenied => "you have no right to: change its permissions or its owner".to_owned(),
        _ => format!("{source}: check the file and the program that writes it"),
    }
}

impl CameraError {
    /// Whether the next frame may be good without reopening the camera.
    pub fn is_of_one_frame(&self) -> bool {
        matches!(self, Self::BrokenFrame(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_stream_is_named_with_what_to_do_and_without_the_words_of_the_system() {
        let error = CameraError::Io { place: "/tmp/camera".to_owned(), source: ErrorKind::NotFound.into() };
        let text = error.to_string();
        assert!(text.contains("/tmp/camera cannot be read: it does not exist: check its name"), "{text}");
    }
}
