//! Errors of librealsense2 as errors of a camera.

use super::api::{LIBRARY, RealSenseError};
use super::constants::EXCEPTION_CAMERA_DISCONNECTED;
use crate::camera::CameraError;
use std::ffi::c_int;

/// Remedy for a missing permission to open a RealSense camera.
const PERMISSION_REMEDY: &str = "install the udev rules of librealsense: copy 99-realsense-libusb.rules from \
    https://github.com/realsenseai/librealsense/tree/master/config to /etc/udev/rules.d, run 'sudo udevadm control --reload' and plug the camera in again";
/// Remedy for other errors.
const GENERAL_REMEDY: &str = "unplug the camera and plug it in again; if the error stays, search the message in the issues of librealsense";

impl RealSenseError {
    /// The error of a function that returned no object.
    pub(super) fn without_object(type_name: &str) -> Self {
        let message = format!("no object of type {type_name} came back");
        Self { function: "a constructor".into(), message, kind: 0 }
    }

    /// The error of the camera `device`.
    pub(super) fn of(self, device: &str) -> CameraError {
        let device = device.to_owned();
        let says = |words: &[&str]| words.iter().any(|words| self.message.to_lowercase().contains(words));
        match self.kind {
            EXCEPTION_CAMERA_DISCONNECTED => CameraError::Unplugged { device },
            _ if says(&["no device connected"]) => CameraError::NoDevice { kind: device },
            _ if says(&["device or resource busy", "errno=16", "resource busy"]) => {
                CameraError::Busy { device }
            }
            _ if says(&["permission denied", "access denied", "errno=13"]) => {
                CameraError::NoPermission { device, remedy: PERMISSION_REMEDY.into() }
            }
            _ if says(&["no such device", "device disconnected", "errno=19"]) => {
                CameraError::Unplugged { device }
            }
            kind => self.unnamed(kind),
        }
    }

    fn unnamed(self, kind: c_int) -> CameraError {
        CameraError::LibraryFailed {
            library: LIBRARY.name.into(),
            function: self.function,
            message: format!("{} (error type {kind})", self.message),
            remedy: GENERAL_REMEDY.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(kind: c_int, message: &str) -> CameraError {
        RealSenseError { function: "rs2_x".into(), message: message.into(), kind }.of("D435 1234")
    }

    #[test]
    fn messages_become_errors_with_a_remedy() {
        assert!(matches!(error(1, "whatever"), CameraError::Unplugged { .. }));
        assert!(matches!(error(0, "No device connected"), CameraError::NoDevice { .. }));
        let busy = "xioctl(VIDIOC_S_FMT) failed, errno=16 Last Error: Device or resource busy";
        assert!(matches!(error(2, busy), CameraError::Busy { .. }));
        let denied = "Cannot open '/dev/video2' Last Error: Permission denied";
        assert!(matches!(error(2, denied), CameraError::NoPermission { .. }));
        let other = error(3, "null pointer passed for argument \"list\"").to_string();
        assert!(other.contains("rs2_x") && other.contains("null pointer"), "{other}");
    }
}
