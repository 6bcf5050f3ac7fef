//! Objects of librealsense2, freed when dropped.

use super::functions::RealSenseApi;
use std::fmt;
use std::ptr::NonNull;
use std::sync::Arc;

/// An object of the library.
pub(super) struct Handle<T> {
    pointer: NonNull<T>,
    delete: unsafe extern "C" fn(*mut T),
    _api: Arc<RealSenseApi>,
}

// SAFETY: the library allows the use of its objects from any thread, one at a time.
unsafe impl<T> Send for Handle<T> {}

impl<T> Handle<T> {
    /// An object that `delete` frees; `None` for a null pointer.
    pub(super) fn new(
        pointer: *mut T,
        delete: unsafe extern "C" fn(*mut T),
        api: &Arc<RealSenseApi>,
    ) -> Option<Self> {
        NonNull::new(pointer).map(|pointer| Self { pointer, delete, _api: Arc::clone(api) })
    }

    /// The address for the functions of the library, valid while the handle lives.
    pub(super) fn get(&self) -> *mut T {
        self.pointer.as_ptr()
    }
}

impl<T> Drop for Handle<T> {
    fn drop(&mut self) {
        // SAFETY: the handle owns the object, and `delete` is the function that the library documents for it.
        unsafe { (self.delete)(self.pointer.as_ptr()) };
    }
}

impl<T> fmt::Debug for Handle<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Handle").field(&self.pointer).finish()
    }
}
