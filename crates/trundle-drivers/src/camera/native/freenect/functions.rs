//! The functions of libfreenect that are used. Source: its public header `libfreenect.h`, version 0.5.

use crate::camera::CameraError;
use crate::camera::native::library::functions::functions;
use crate::camera::native::library::{LibrarySpec, LibraryVersion, NativeLibrary};
use std::ffi::{c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Specification of libfreenect. The library has no version function: the soname means 0.5.
pub const LIBRARY: LibrarySpec = LibrarySpec {
    name: "libfreenect",
    variable: "TRUNDLE_FREENECT_LIB",
    sonames: &["libfreenect.so.0.5", "libfreenect.so.0"],
    wheel: None,
    from: LibraryVersion::new(0, 5, 0),
    below: LibraryVersion::new(0, 6, 0),
    remedy: "run 'sudo apt install libfreenect0.5', or name its file in TRUNDLE_FREENECT_LIB",
};

/// `freenect_context`.
#[repr(C)]
#[derive(Debug)]
pub struct Context {
    _private: [u8; 0],
}

/// `freenect_device`.
#[repr(C)]
#[derive(Debug)]
pub struct FreenectDevice {
    _private: [u8; 0],
}

/// `freenect_frame_mode`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct FrameMode {
    reserved: u32,
    resolution: i32,
    format: i32,
    /// Bytes of an image.
    pub bytes: i32,
    /// Columns \[px\].
    pub width: i16,
    /// Rows \[px\].
    pub height: i16,
    data_bits: i8,
    padding_bits: i8,
    /// Frames per second \[Hz\].
    pub framerate: i8,
    /// 0 for an unavailable mode.
    pub is_valid: i8,
}

/// `freenect_device_attributes`: a list of serial numbers.
#[repr(C)]
#[derive(Debug)]
pub struct Attributes {
    pub(super) next: *mut Attributes,
    pub(super) camera_serial: *const c_char,
}

/// A function that receives images: device, data, ticks.
pub(super) type ImageCallback = unsafe extern "C" fn(*mut FreenectDevice, *mut c_void, u32);

functions! {
    /// The functions of libfreenect.
    pub struct FreenectApi {
        fn freenect_init(*mut *mut Context, *mut c_void) -> c_int;
        fn freenect_shutdown(*mut Context) -> c_int;
        fn freenect_set_log_level(*mut Context, c_int);
        fn freenect_select_subdevices(*mut Context, c_int);
        fn freenect_num_devices(*mut Context) -> c_int;
        fn freenect_open_device(*mut Context, *mut *mut FreenectDevice, c_int) -> c_int;
        fn freenect_open_device_by_camera_serial(*mut Context, *mut *mut FreenectDevice, *const c_char) -> c_int;
        fn freenect_close_device(*mut FreenectDevice) -> c_int;
        fn freenect_set_depth_callback(*mut FreenectDevice, ImageCallback);
        fn freenect_set_video_callback(*mut FreenectDevice, ImageCallback);
        fn freenect_find_depth_mode(c_int, c_int) -> FrameMode;
        fn freenect_find_video_mode(c_int, c_int) -> FrameMode;
        fn freenect_set_depth_mode(*mut FreenectDevice, FrameMode) -> c_int;
        fn freenect_set_video_mode(*mut FreenectDevice, FrameMode) -> c_int;
        fn freenect_start_depth(*mut FreenectDevice) -> c_int;
        fn freenect_start_video(*mut FreenectDevice) -> c_int;
        fn freenect_stop_depth(*mut FreenectDevice) -> c_int;
        fn freenect_stop_video(*mut FreenectDevice) -> c_int;
        fn freenect_process_events_timeout(*mut Context, *mut libc::timeval) -> c_int;
        optional fn freenect_list_device_attributes(*mut Context, *mut *mut Attributes) -> c_int;
        optional fn freenect_free_device_attributes(*mut Attributes);
    }
}

impl FreenectApi {
    /// Loads the library; `setting` is its file in the settings, if given.
    ///
    /// # Errors
    /// When the library is missing, broken, or lacks functions.
    pub fn load(setting: Option<&Path>) -> Result<Arc<Self>, CameraError> {
        Self::from_library(NativeLibrary::load(LIBRARY, setting)?).map(Arc::new)
    }

    /// File of the library.
    pub fn file(&self) -> PathBuf {
        self.library.path_of(self.freenect_init as *const ())
    }

    /// Whether the library is fakenect, which plays a folder instead of a camera.
    pub fn is_fake(&self) -> bool {
        self.file().components().any(|part| part.as_os_str().to_string_lossy().contains("fakenect"))
    }
}
