//! Loading of librealsense2, and calls with its errors.

use super::functions::{Context, ErrorOut, RawError, RealSenseApi};
use super::handle::Handle;
use crate::camera::CameraError;
use crate::camera::native::library::{LibrarySpec, LibraryVersion, NativeLibrary, WheelFile};
use std::ffi::{CStr, c_char, c_int};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Specification of librealsense2.
pub const LIBRARY: LibrarySpec = LibrarySpec {
    name: "librealsense2",
    variable: "TRUNDLE_REALSENSE_LIB",
    sonames: &[
        "librealsense2.so.2.59",
        "librealsense2.so.2.58",
        "librealsense2.so.2.57",
        "librealsense2.so.2.56",
        "librealsense2.so.2.55",
        "librealsense2.so.2.54",
        "librealsense2.so.2.53",
        "librealsense2.so.2.52",
        "librealsense2.so.2.51",
        "librealsense2.so.2.50",
        "librealsense2.so",
    ],
    wheel: Some(WheelFile { folder: "pyrealsense2", prefix: "pyrealsense2.cpython" }),
    from: LibraryVersion::new(2, 50, 0),
    below: LibraryVersion::new(3, 0, 0),
    remedy: "run 'python3 -m pip install --user pyrealsense2' and set TRUNDLE_PYTHON_WHEELS=python3, or install librealsense2 from \
        https://github.com/realsenseai/librealsense, or name its file in TRUNDLE_REALSENSE_LIB",
};

/// An error of the library.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct RealSenseError {
    /// The function that failed.
    pub(super) function: String,
    /// The message.
    pub(super) message: String,
    /// A number of `rs2_exception_type`.
    pub(super) kind: c_int,
}

impl RealSenseApi {
    /// Loads the library; `setting` is its file in the settings, if given.
    ///
    /// # Errors
    /// When the library is missing, broken, or of another version.
    pub fn load(setting: Option<&Path>) -> Result<Arc<Self>, CameraError> {
        let api = Self::new(NativeLibrary::load(LIBRARY, setting)?)?;
        api.library.check_version(api.version()?)?;
        Ok(Arc::new(api))
    }

    /// Version of the library.
    ///
    /// # Errors
    /// When the library does not report its version.
    pub fn version(&self) -> Result<LibraryVersion, CameraError> {
        // SAFETY: the function takes the place of an error only.
        let number = self.call(|error| unsafe { (self.rs2_get_api_version)(error) });
        number
            .map(|number| LibraryVersion::from_decimal(number.unsigned_abs()))
            .map_err(|error| error.of("any camera"))
    }

    /// File of the library.
    pub fn file(&self) -> PathBuf {
        self.library.path_of(self.rs2_get_api_version as *const ())
    }

    /// A connection to the library.
    pub(super) fn context(self: &Arc<Self>) -> Result<Handle<Context>, RealSenseError> {
        // SAFETY: the function takes a number and the place of an error.
        let version = self.call(|error| unsafe { (self.rs2_get_api_version)(error) })?;
        // SAFETY: as above.
        self.owned(self.rs2_delete_context, |error| unsafe { (self.rs2_create_context)(version, error) })
    }

    /// Calls a function that reports errors.
    pub(super) fn call<T>(&self, function: impl FnOnce(ErrorOut) -> T) -> Result<T, RealSenseError> {
        let mut error: *mut RawError = std::ptr::null_mut();
        let result = function(&mut error);
        if error.is_null() { Ok(result) } else { Err(self.take(error)) }
    }

    /// Calls a function that creates an object, which `delete` frees.
    pub(super) fn owned<T>(
        self: &Arc<Self>,
        delete: unsafe extern "C" fn(*mut T),
        function: impl FnOnce(ErrorOut) -> *mut T,
    ) -> Result<Handle<T>, RealSenseError> {
        let pointer = self.call(function)?;
        Handle::new(pointer, delete, self)
            .ok_or_else(|| RealSenseError::without_object(std::any::type_name::<T>()))
    }

    fn take(&self, error: *mut RawError) -> RealSenseError {
        // SAFETY: the library created the error; its texts live until it is freed, and are copied before.
        unsafe {
            let taken = RealSenseError {
                function: text((self.rs2_get_failed_function)(error)),
                message: text((self.rs2_get_error_message)(error)),
                kind: (self.rs2_get_librealsense_exception_type)(error),
            };
            (self.rs2_free_error)(error);
            taken
        }
    }
}

/// A copy of a text of the library; empty for a null pointer.
///
/// # Safety
/// `text` is null or ends with a zero.
pub(super) unsafe fn text(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: the caller vouches for the zero.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}
