//! The functions of OpenNI2 that are used. Source: its public headers `OniCAPI.h`, `OniCTypes.h`, version 2.2.

use crate::camera::CameraError;
use crate::camera::native::library::functions::functions;
use crate::camera::native::library::{LibrarySpec, LibraryVersion, NativeLibrary};
use std::ffi::{CStr, c_char, c_int, c_void};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// Specification of OpenNI2.
pub const LIBRARY: LibrarySpec = LibrarySpec {
    name: "OpenNI2",
    variable: "TRUNDLE_OPENNI2_LIB",
    sonames: &["libOpenNI2.so.0", "libOpenNI2.so"],
    wheel: None,
    from: LibraryVersion::new(2, 2, 0),
    below: LibraryVersion::new(3, 0, 0),
    remedy: "run 'sudo apt install libopenni2-0', or name its file in TRUNDLE_OPENNI2_LIB",
};

/// Version of the interface that the structures here belong to. Source: `OniVersion.h`, 1000 major + minor.
const API_VERSION: c_int = 2002;
pub(super) const STATUS_OK: c_int = 0;
pub(super) const STATUS_NO_DEVICE: c_int = 6;
pub(super) const STATUS_TIME_OUT: c_int = 102;

/// An open device.
#[repr(C)]
#[derive(Debug)]
pub struct OpenNiDevice {
    _private: [u8; 0],
}

/// A stream of a device.
#[repr(C)]
#[derive(Debug)]
pub struct Stream {
    _private: [u8; 0],
}

/// `OniVersion`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Version {
    major: c_int,
    minor: c_int,
    maintenance: c_int,
    build: c_int,
}

/// `OniDeviceInfo`.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct DeviceInfo {
    pub(super) uri: [c_char; 256],
    pub(super) vendor: [c_char; 256],
    pub(super) name: [c_char; 256],
    usb_vendor: u16,
    usb_product: u16,
}

/// `OniVideoMode`.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct VideoMode {
    /// `OniPixelFormat`.
    pub format: c_int,
    /// Columns \[px\].
    pub width: c_int,
    /// Rows \[px\].
    pub height: c_int,
    /// Frames per second \[Hz\].
    pub rate_hz: c_int,
}

/// `OniFrame`.
#[repr(C)]
#[derive(Debug)]
pub struct Frame {
    pub(super) size: c_int,
    pub(super) data: *const c_void,
    sensor: c_int,
    pub(super) micros: u64,
    pub(super) index: c_int,
    pub(super) width: c_int,
    pub(super) height: c_int,
    pub(super) mode: VideoMode,
    is_cropped: c_int,
    crop_x: c_int,
    crop_y: c_int,
    pub(super) stride: c_int,
}

functions! {
    /// The functions of OpenNI2. `oniShutdown` is not used, because version 2.2.0.33 crashes in it.
    pub struct OpenNiApi {
        fn oniInitialize(c_int) -> c_int;
        fn oniGetVersion() -> Version;
        fn oniGetExtendedError() -> *const c_char;
        fn oniGetDeviceList(*mut *mut DeviceInfo, *mut c_int) -> c_int;
        fn oniReleaseDeviceList(*mut DeviceInfo) -> c_int;
        fn oniDeviceOpen(*const c_char, *mut *mut OpenNiDevice) -> c_int;
        fn oniDeviceClose(*mut OpenNiDevice) -> c_int;
        fn oniDeviceGetInfo(*mut OpenNiDevice, *mut DeviceInfo) -> c_int;
        fn oniDeviceSetProperty(*mut OpenNiDevice, c_int, *const c_void, c_int) -> c_int;
        fn oniDeviceIsCommandSupported(*mut OpenNiDevice, c_int) -> c_int;
        fn oniDeviceIsImageRegistrationModeSupported(*mut OpenNiDevice, c_int) -> c_int;
        fn oniDeviceCreateStream(*mut OpenNiDevice, c_int, *mut *mut Stream) -> c_int;
        fn oniStreamDestroy(*mut Stream);
        fn oniStreamStart(*mut Stream) -> c_int;
        fn oniStreamStop(*mut Stream);
        fn oniStreamGetProperty(*mut Stream, c_int, *mut c_void, *mut c_int) -> c_int;
        fn oniStreamSetProperty(*mut Stream, c_int, *const c_void, c_int) -> c_int;
        fn oniWaitForAnyStream(*mut *mut Stream, c_int, *mut c_int, c_int) -> c_int;
        fn oniStreamReadFrame(*mut Stream, *mut *mut Frame) -> c_int;
        fn oniFrameRelease(*mut Frame);
    }
}

impl OpenNiApi {
    /// Loads the library and starts its drivers, which run until the program ends; `setting` is its file in the settings, if given.
    ///
    /// # Errors
    /// When the library is missing, broken, of another version, or its drivers do not start.
    pub fn load(setting: Option<&Path>) -> Result<Arc<Self>, CameraError> {
        static STARTED: OnceLock<c_int> = OnceLock::new();
        let api = Self::from_library(NativeLibrary::load(LIBRARY, setting)?)?;
        api.library.check_version(api.version())?;
        // SAFETY: the number is the version of the structures above.
        let code = *STARTED.get_or_init(|| unsafe { (api.oniInitialize)(API_VERSION) });
        api.check("oniInitialize", code, "any camera")?;
        Ok(Arc::new(api))
    }

    /// Version of the library.
    pub fn version(&self) -> LibraryVersion {
        // SAFETY: the function has no argument.
        let found = unsafe { (self.oniGetVersion)() };
        LibraryVersion::new(
            found.major.unsigned_abs(),
            found.minor.unsigned_abs(),
            found.maintenance.unsigned_abs(),
        )
    }

    /// File of the library.
    pub fn file(&self) -> PathBuf {
        self.library.path_of(self.oniInitialize as *const ())
    }

    /// The error of a status of the camera `device`.
    pub(super) fn check(&self, function: &str, status: c_int, device: &str) -> Result<(), CameraError> {
        match status {
            STATUS_OK => Ok(()),
            STATUS_NO_DEVICE => Err(CameraError::NoDevice { kind: device.into() }),
            status => Err(CameraError::LibraryFailed {
                library: LIBRARY.name.into(),
                function: function.into(),
                message: format!("{} (status {status})", self.last_error()),
                remedy: "unplug the camera and plug it in again, and check that no other program uses it"
                    .into(),
            }),
        }
    }

    fn last_error(&self) -> String {
        // SAFETY: the function has no argument; its text ends with a zero and lives until the next call.
        let text = unsafe { (self.oniGetExtendedError)() };
        if text.is_null() {
            return String::new();
        }
        // SAFETY: as above.
        unsafe { CStr::from_ptr(text) }.to_string_lossy().trim().to_owned()
    }
}
