//! A connection to libfreenect, and an open Kinect.

use super::functions::{Attributes, Context, FreenectApi, FreenectDevice, ImageCallback, LIBRARY};
use crate::camera::native::Selection;
use crate::camera::{CameraError, native::DeviceEntry};
use std::ffi::{CStr, CString, c_int};
use std::ptr::NonNull;
use std::sync::Arc;
use std::time::Duration;

/// Environment variable of fakenect: the folder to play.
const FAKE_FOLDER_VARIABLE: &str = "FAKENECT_PATH";
const LOG_LEVEL_ERROR: c_int = 1;
const SUBDEVICE_CAMERA: c_int = 2;
const RESOLUTION_MEDIUM: c_int = 1;
const VIDEO_RGB: c_int = 0;
const DEPTH_11BIT: c_int = 0;
/// Numbers of libusb, which libfreenect passes through. Source: `libusb.h`.
const USB_ERROR_ACCESS: c_int = -3;
const USB_ERROR_NO_DEVICE: c_int = -4;
const USB_ERROR_BUSY: c_int = -6;
/// Kind of the camera, in errors.
pub(super) const KIND: &str = "Kinect v1";

/// A connection to the library.
#[derive(Debug)]
pub(super) struct Session {
    pub(super) api: Arc<FreenectApi>,
    context: NonNull<Context>,
}

// SAFETY: libfreenect has no threads; its objects may move between threads.
unsafe impl Send for Session {}

impl Session {
    /// A connection that leaves motor and microphones alone.
    pub(super) fn new(api: &Arc<FreenectApi>) -> Result<Self, CameraError> {
        if api.is_fake() && std::env::var_os(FAKE_FOLDER_VARIABLE).is_none() {
            // Without the variable, fakenect would end the program.
            return Err(failed(
                "freenect_init",
                -1,
                format!("set {FAKE_FOLDER_VARIABLE} to a folder of fakenect-record"),
            ));
        }
        let mut context: *mut Context = std::ptr::null_mut();
        // SAFETY: the context is writable; for a null USB context the library creates one.
        let code = unsafe { (api.freenect_init)(&mut context, std::ptr::null_mut()) };
        let context = NonNull::new(context).filter(|_| code >= 0);
        let context = context
            .ok_or_else(|| failed("freenect_init", code, "check that USB devices are visible".into()))?;
        // SAFETY: the context is valid.
        unsafe {
            (api.freenect_set_log_level)(context.as_ptr(), LOG_LEVEL_ERROR);
            (api.freenect_select_subdevices)(context.as_ptr(), SUBDEVICE_CAMERA);
        }
        Ok(Self { api: Arc::clone(api), context })
    }

    /// The connected cameras. Their serial numbers are empty if the library cannot list them.
    pub(super) fn devices(&self) -> Vec<DeviceEntry> {
        // SAFETY: the context is valid.
        let count = unsafe { (self.api.freenect_num_devices)(self.context.as_ptr()) };
        let count = usize::try_from(count).unwrap_or(0);
        let mut serials = self.serials();
        serials.resize(count, String::new());
        let entry = |serial| DeviceEntry { name: KIND.into(), serial, firmware: String::new(), usb: None };
        serials.into_iter().map(entry).collect()
    }

    fn serials(&self) -> Vec<String> {
        let functions = (self.api.freenect_list_device_attributes, self.api.freenect_free_device_attributes);
        let (Some(list), Some(free)) = functions else { return Vec::new() };
        let mut first: *mut Attributes = std::ptr::null_mut();
        // SAFETY: the context is valid, and the list is writable.
        unsafe { list(self.context.as_ptr(), &mut first) };
        let mut serials = Vec::new();
        let mut next = first;
        while !next.is_null() {
            // SAFETY: the library made a list of living entries that ends with null; its texts end with a zero.
            let (text, following) = unsafe { ((*next).camera_serial, (*next).next) };
            // SAFETY: as above.
            let serial =
                (!text.is_null()).then(|| unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned());
            serials.push(serial.unwrap_or_default());
            next = following;
        }
        // SAFETY: the list came from the library and is not used afterwards.
        unsafe { free(first) };
        serials
    }

    /// Opens a camera.
    pub(super) fn open(self, selection: &Selection) -> Result<OpenKinect, CameraError> {
        let name = selection.describe(KIND);
        if self.devices().is_empty() {
            return Err(CameraError::NoDevice { kind: name });
        }
        let mut device: *mut FreenectDevice = std::ptr::null_mut();
        let code = match selection {
            Selection::Serial(serial) => {
                let text = CString::new(serial.as_str())
                    .map_err(|_| CameraError::NoDevice { kind: name.clone() })?;
                // SAFETY: the context and the text are valid, and the device is writable.
                unsafe {
                    (self.api.freenect_open_device_by_camera_serial)(
                        self.context.as_ptr(),
                        &mut device,
                        text.as_ptr(),
                    )
                }
            }
            // SAFETY: the context is valid, and the device is writable.
            _ => unsafe { (self.api.freenect_open_device)(self.context.as_ptr(), &mut device, 0) },
        };
        let device = NonNull::new(device).filter(|_| code >= 0);
        device.map(|device| OpenKinect { session: self, device }).ok_or_else(|| open_error(name, code))
    }

    /// Runs the library's callbacks for at most `timeout`.
    fn process(&self, timeout: Duration) -> c_int {
        let mut time = libc::timeval {
            tv_sec: timeout.as_secs().min(60) as libc::time_t,
            tv_usec: libc::suseconds_t::from(timeout.subsec_micros()),
        };
        // SAFETY: the context and the time are valid.
        unsafe { (self.api.freenect_process_events_timeout)(self.context.as_ptr(), &mut time) }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        // SAFETY: the context is valid and all its devices are closed.
        unsafe { (self.api.freenect_shutdown)(self.context.as_ptr()) };
    }
}

/// An open Kinect.
#[derive(Debug)]
pub(super) struct OpenKinect {
    session: Session,
    device: NonNull<FreenectDevice>,
}

// SAFETY: as for the session.
unsafe impl Send for OpenKinect {}

impl OpenKinect {
    /// Starts 640 x 480 colour and raw disparity, delivered to the callbacks.
    pub(super) fn start(&self, on_video: ImageCallback, on_depth: ImageCallback) -> Result<(), CameraError> {
        let (api, device) = (&self.session.api, self.device.as_ptr());
        // SAFETY: the device is valid, and the callbacks are static functions.
        unsafe {
            (api.freenect_set_video_callback)(device, on_video);
            (api.freenect_set_depth_callback)(device, on_depth);
            let video = (api.freenect_find_video_mode)(RESOLUTION_MEDIUM, VIDEO_RGB);
            check("freenect_set_video_mode", (api.freenect_set_video_mode)(device, video))?;
            let depth = (api.freenect_find_depth_mode)(RESOLUTION_MEDIUM, DEPTH_11BIT);
            check("freenect_set_depth_mode", (api.freenect_set_depth_mode)(device, depth))?;
            check("freenect_start_video", (api.freenect_start_video)(device))?;
            check("freenect_start_depth", (api.freenect_start_depth)(device))
        }
    }

    /// Runs the callbacks; returns a negative number if the camera was unplugged.
    pub(super) fn process(&self, timeout: Duration) -> c_int {
        self.session.process(timeout)
    }
}

impl Drop for OpenKinect {
    fn drop(&mut self) {
        let (api, device) = (&self.session.api, self.device.as_ptr());
        // SAFETY: the device is valid; stopping a stopped stream is allowed.
        unsafe {
            (api.freenect_stop_depth)(device);
            (api.freenect_stop_video)(device);
            (api.freenect_close_device)(device);
        }
    }
}

fn check(function: &str, code: c_int) -> Result<(), CameraError> {
    let remedy = || "unplug the Kinect from USB and power, and plug it in again".to_owned();
    if code >= 0 { Ok(()) } else { Err(failed(function, code, remedy())) }
}

fn failed(function: &str, code: c_int, remedy: String) -> CameraError {
    CameraError::LibraryFailed {
        library: LIBRARY.name.into(),
        function: function.into(),
        message: format!("error {code}"),
        remedy,
    }
}

fn open_error(device: String, code: c_int) -> CameraError {
    match code {
        USB_ERROR_ACCESS => CameraError::NoPermission {
            device,
            remedy: "run 'sudo adduser $USER plugdev', log in again, and plug the Kinect in again".into(),
        },
        USB_ERROR_NO_DEVICE => CameraError::Unplugged { device },
        USB_ERROR_BUSY => CameraError::Busy { device },
        code => failed("freenect_open_device", code, format!("check the power supply of the {device}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usb_errors_are_named() {
        assert!(matches!(open_error("k".into(), -3), CameraError::NoPermission { .. }));
        assert!(matches!(open_error("k".into(), -6), CameraError::Busy { .. }));
        assert!(matches!(open_error("k".into(), -1), CameraError::LibraryFailed { .. }));
    }
}
