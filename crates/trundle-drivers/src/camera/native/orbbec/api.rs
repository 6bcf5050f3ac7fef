//! Loading of OrbbecSDK, its errors and its objects.

use super::functions::{Context, ErrorOut, LIBRARY, OrbbecApi, RawError};
use crate::camera::CameraError;
use crate::camera::native::library::{LibraryVersion, NativeLibrary};
use std::ffi::{CStr, CString, c_char, c_int};
use std::path::{Path, PathBuf};
use std::ptr::NonNull;
use std::sync::Arc;

const LOG_SEVERITY_OFF: c_int = 5;
const EXCEPTION_CAMERA_DISCONNECTED: c_int = 2;
/// Remedy for a missing permission to open an Orbbec camera.
const PERMISSION_REMEDY: &str = "install the udev rules of OrbbecSDK: run 'sudo scripts/env_setup/install_udev_rules.sh' of \
    https://github.com/orbbec/OrbbecSDK_v2 and plug the camera in again";
/// Remedy for other errors.
const GENERAL_REMEDY: &str = "unplug the camera and plug it in again; if the error stays, search the message in the issues of OrbbecSDK_v2";

/// An error of the library.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct OrbbecError {
    pub(super) function: String,
    pub(super) message: String,
    pub(super) kind: c_int,
}

impl OrbbecError {
    /// The error of the camera `device`.
    pub(super) fn of(self, device: &str) -> CameraError {
        let device = device.to_owned();
        let says = |words: &[&str]| words.iter().any(|words| self.message.to_lowercase().contains(words));
        match self.kind {
            EXCEPTION_CAMERA_DISCONNECTED => CameraError::Unplugged { device },
            _ if says(&["busy", "already been acquired"]) => CameraError::Busy { device },
            _ if says(&["permission", "access denied"]) => {
                CameraError::NoPermission { device, remedy: PERMISSION_REMEDY.into() }
            }
            kind => CameraError::LibraryFailed {
                library: LIBRARY.name.into(),
                function: self.function,
                message: format!("{} (error type {kind})", self.message),
                remedy: GENERAL_REMEDY.into(),
            },
        }
    }
}

impl OrbbecApi {
    /// Loads the library; `setting` is its file in the settings, if given. The library writes no log.
    ///
    /// # Errors
    /// When the library is missing, broken, or of another version.
    pub fn load(setting: Option<&Path>) -> Result<Arc<Self>, CameraError> {
        let api = Self::new(NativeLibrary::load(LIBRARY, setting)?)?;
        api.library.check_version(api.version())?;
        api.prepare().map_err(|error| error.of("any camera"))?;
        Ok(Arc::new(api))
    }

    /// Version of the library.
    pub fn version(&self) -> LibraryVersion {
        // SAFETY: the function has no argument.
        LibraryVersion::from_decimal(unsafe { (self.ob_get_version)() }.unsigned_abs())
    }

    /// File of the library.
    pub fn file(&self) -> PathBuf {
        self.library.path_of(self.ob_get_version as *const ())
    }

    /// Disables the log, and sets the folder of extensions next to the library.
    fn prepare(&self) -> Result<(), OrbbecError> {
        // SAFETY: the function takes a number.
        self.call(|error| unsafe { (self.ob_set_logger_severity)(LOG_SEVERITY_OFF, error) })?;
        let folder = self.file().with_file_name("extensions");
        let Ok(text) = CString::new(folder.to_string_lossy().as_bytes()) else { return Ok(()) };
        if folder.is_dir() {
            // SAFETY: the text is valid.
            self.call(|error| unsafe { (self.ob_set_extensions_directory)(text.as_ptr(), error) })?;
        }
        Ok(())
    }

    /// A connection to the library. Network devices are not enumerated: only USB cameras are found.
    pub(super) fn context(self: &Arc<Self>) -> Result<Handle<Context>, OrbbecError> {
        // SAFETY: the function takes the place of an error only.
        let context =
            self.owned(self.ob_delete_context, |error| unsafe { (self.ob_create_context)(error) })?;
        // SAFETY: the context is valid.
        self.call(|error| unsafe { (self.ob_enable_net_device_enumeration)(context.get(), false, error) })?;
        Ok(context)
    }

    /// Calls a function that reports errors.
    pub(super) fn call<T>(&self, function: impl FnOnce(ErrorOut) -> T) -> Result<T, OrbbecError> {
        let mut error: *mut RawError = std::ptr::null_mut();
        let result = function(&mut error);
        if error.is_null() {
            return Ok(result);
        }
        // SAFETY: the library created the error; its texts are copied.
        Err(unsafe {
            OrbbecError {
                function: text((self.ob_error_get_function)(error)),
                message: text((self.ob_error_get_message)(error)),
                kind: (self.ob_error_get_exception_type)(error),
            }
        })
    }

    /// Calls a function that creates an object, which `delete` frees.
    pub(super) fn owned<T>(
        self: &Arc<Self>,
        delete: unsafe extern "C" fn(*mut T, ErrorOut),
        function: impl FnOnce(ErrorOut) -> *mut T,
    ) -> Result<Handle<T>, OrbbecError> {
        let found = self.owned_or_none(delete, function)?;
        found.ok_or_else(|| OrbbecError {
            function: "a constructor".into(),
            message: format!("no object of type {} came back", std::any::type_name::<T>()),
            kind: 0,
        })
    }

    /// As [`OrbbecApi::owned`]; `None` if the function returned no object.
    pub(super) fn owned_or_none<T>(
        self: &Arc<Self>,
        delete: unsafe extern "C" fn(*mut T, ErrorOut),
        function: impl FnOnce(ErrorOut) -> *mut T,
    ) -> Result<Option<Handle<T>>, OrbbecError> {
        let pointer = self.call(function)?;
        Ok(NonNull::new(pointer).map(|pointer| Handle { pointer, delete, api: Arc::clone(self) }))
    }
}

/// An object of the library, freed when dropped.
#[derive(Debug)]
pub(super) struct Handle<T> {
    pointer: NonNull<T>,
    delete: unsafe extern "C" fn(*mut T, ErrorOut),
    api: Arc<OrbbecApi>,
}

// SAFETY: the library allows the use of its objects from any thread, one at a time.
unsafe impl<T> Send for Handle<T> {}

impl<T> Handle<T> {
    /// The address for the functions of the library, valid while the handle lives.
    pub(super) fn get(&self) -> *mut T {
        self.pointer.as_ptr()
    }
}

impl<T> Drop for Handle<T> {
    fn drop(&mut self) {
        // SAFETY: the handle owns the object, and `delete` is the function that the library documents for it.
        let freed = self.api.call(|error| unsafe { (self.delete)(self.pointer.as_ptr(), error) });
        if let Err(error) = freed {
            tracing::warn!(?error, "OrbbecSDK did not free an object");
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
