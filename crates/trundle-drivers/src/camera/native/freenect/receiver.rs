//! Images from the callbacks of libfreenect, put together.
//!
//! The library calls back inside `freenect_process_events_timeout`, in the thread that called it. A thread-local variable leads the
//! callbacks to their receiver.

use super::functions::FreenectDevice;
use super::ticks::TickClock;
use crate::camera::native::image_pair::ImagePair;
use crate::camera::{CameraFrame, PixelFormat, RawImage};
use std::cell::Cell;
use std::ffi::c_void;
use std::ptr::NonNull;

/// Columns and rows of both images \[px\]. Source: `libfreenect.h`, `FREENECT_RESOLUTION_MEDIUM`.
pub(super) const SIZE_PX: (usize, usize) = (640, 480);

thread_local! {
    static RECEIVER: Cell<Option<NonNull<Receiver>>> = const { Cell::new(None) };
}

/// The images of one call of the library.
#[derive(Debug)]
pub(super) struct Receiver {
    clock: TickClock,
    pair: ImagePair,
}

impl Receiver {
    /// A receiver without images; `rate_hz` is the rate of both streams \[Hz\].
    pub(super) fn new(rate_hz: f64) -> Self {
        Self { clock: TickClock::default(), pair: ImagePair::new(rate_hz) }
    }

    /// Runs `call`, in which the library calls back.
    pub(super) fn during<T>(&mut self, call: impl FnOnce() -> T) -> T {
        RECEIVER.set(Some(NonNull::from(self)));
        let result = call();
        RECEIVER.set(None);
        result
    }

    /// A pair of images of the same time; `None` without a pair.
    pub(super) fn take_pair(&mut self) -> Option<CameraFrame> {
        self.pair.take()
    }

    fn image(&mut self, format: PixelFormat, bytes: Vec<u8>, ticks: u32) -> RawImage {
        RawImage::packed(format, SIZE_PX, bytes, self.clock.stamp(ticks))
    }
}

/// Receives a colour image.
///
/// # Safety
/// `data` points to 640 x 480 pixels of 3 bytes.
pub(super) unsafe extern "C" fn on_video(_: *mut FreenectDevice, data: *mut c_void, ticks: u32) {
    // SAFETY: the caller vouches for the data.
    unsafe {
        receive(data, 3, |receiver, bytes| {
            let image = receiver.image(PixelFormat::Rgb8, bytes, ticks);
            receiver.pair.add_color(image);
        })
    };
}

/// Receives a raw disparity image.
///
/// # Safety
/// `data` points to 640 x 480 pixels of 2 bytes.
pub(super) unsafe extern "C" fn on_depth(_: *mut FreenectDevice, data: *mut c_void, ticks: u32) {
    // SAFETY: the caller vouches for the data.
    unsafe {
        receive(data, 2, |receiver, bytes| {
            let image = receiver.image(PixelFormat::Disparity11, bytes, ticks);
            receiver.pair.add_depth(image);
        });
    };
}

/// Copies an image to the receiver of this thread.
///
/// # Safety
/// `data` is null or points to an image of `bytes_per_pixel`.
unsafe fn receive(data: *mut c_void, bytes_per_pixel: usize, store: impl FnOnce(&mut Receiver, Vec<u8>)) {
    let Some(mut receiver) = RECEIVER.get().filter(|_| !data.is_null()) else { return };
    // SAFETY: the caller vouches for the length.
    let bytes =
        unsafe { std::slice::from_raw_parts(data.cast::<u8>(), SIZE_PX.0 * SIZE_PX.1 * bytes_per_pixel) };
    // SAFETY: `during` borrows the receiver until the library returns, and the library makes one callback at a time.
    store(unsafe { receiver.as_mut() }, bytes.to_vec());
}
