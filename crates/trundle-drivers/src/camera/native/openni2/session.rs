//! An open device of OpenNI2 with its two streams.

use super::functions::{
    DeviceInfo, Frame, OpenNiApi, OpenNiDevice, STATUS_OK, STATUS_TIME_OUT, Stream, VideoMode,
};
use crate::camera::native::DeviceEntry;
use crate::camera::{CameraError, PixelFormat, RawImage};
use std::ffi::{CString, c_char, c_int};
use std::sync::Arc;
use std::time::Duration;
use trundle_core::{Invalid, Stamp};

const SENSOR_COLOR: c_int = 2;
const SENSOR_DEPTH: c_int = 3;
const DEVICE_COMMAND_SEEK: c_int = 1;
const DEVICE_PROPERTY_REGISTRATION: c_int = 5;
const REGISTRATION_DEPTH_TO_COLOR: c_int = 1;
const DEVICE_PROPERTY_PLAYBACK_SPEED: c_int = 100;
const DEVICE_PROPERTY_PLAYBACK_REPEAT: c_int = 101;
/// Speed of a recording that plays one image for each that is read. Source: `OpenNI.h`, `PlaybackControl::setSpeed`.
const SPEED_BY_READER: f32 = -1.0;
const STREAM_PROPERTY_CROPPING: c_int = 0;
const STREAM_PROPERTY_HORIZONTAL_FOV: c_int = 1;
const STREAM_PROPERTY_VERTICAL_FOV: c_int = 2;
const STREAM_PROPERTY_VIDEO_MODE: c_int = 3;
const STREAM_PROPERTY_MIRRORING: c_int = 7;
const STREAM_PROPERTY_FRAME_COUNT: c_int = 8;
const FORMAT_DEPTH_100_UM: c_int = 101;
/// Nanoseconds in a microsecond. Source: SI.
const NANOS_PER_US: i64 = 1000;

/// Kind of a stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Color,
    Depth,
}

/// An open device. A drop closes the streams and the device; the library remains initialised. A recording remains open, with its streams
/// stopped, until the program ends: the thread of its player reads the list of streams without a lock, and crashes if one is destroyed.
#[derive(Debug)]
pub(super) struct OpenDevice {
    api: Arc<OpenNiApi>,
    name: String,
    device: *mut OpenNiDevice,
    /// Colour and depth; null for a missing stream.
    streams: [*mut Stream; 2],
}

// SAFETY: the library locks its objects; they may move between threads.
unsafe impl Send for OpenDevice {}

/// The cameras listed by the library; the URI is used as serial number.
pub fn list_devices(api: &Arc<OpenNiApi>) -> Result<Vec<DeviceEntry>, CameraError> {
    let (mut list, mut count) = (std::ptr::null_mut::<DeviceInfo>(), 0);
    // SAFETY: list and count have places.
    api.check("oniGetDeviceList", unsafe { (api.oniGetDeviceList)(&mut list, &mut count) }, "any camera")?;
    if list.is_null() {
        return Ok(Vec::new());
    }
    // SAFETY: the library made a list of `count` entries.
    let infos = unsafe { std::slice::from_raw_parts(list, usize::try_from(count).unwrap_or(0)) };
    let entries = infos.iter().map(entry).collect();
    // SAFETY: the list came from the library and is not used afterwards.
    unsafe { (api.oniReleaseDeviceList)(list) };
    Ok(entries)
}

fn entry(info: &DeviceInfo) -> DeviceEntry {
    let name = format!("{} {}", text(&info.vendor), text(&info.name));
    DeviceEntry { name, serial: text(&info.uri), firmware: String::new(), usb: None }
}

fn text(field: &[c_char; 256]) -> String {
    // A `c_char` is signed on x86-64 and unsigned on aarch64.
    let byte = |char: &c_char| u8::from_ne_bytes(char.to_ne_bytes());
    let bytes: Vec<u8> = field.iter().map(byte).take_while(|byte| *byte != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

impl OpenDevice {
    /// Opens the device with this URI and creates its streams without starting them.
    pub(super) fn open(api: &Arc<OpenNiApi>, uri: &str) -> Result<Self, CameraError> {
        let no_device = || CameraError::NoDevice { kind: uri.to_owned() };
        let text = CString::new(uri).map_err(|_| no_device())?;
        let mut device = std::ptr::null_mut();
        // SAFETY: the text is valid, and the device is writable.
        api.check("oniDeviceOpen", unsafe { (api.oniDeviceOpen)(text.as_ptr(), &mut device) }, uri)?;
        let streams = [std::ptr::null_mut(); 2];
        let mut open = Self { api: Arc::clone(api), name: uri.to_owned(), device, streams };
        open.make_stream(Kind::Color, SENSOR_COLOR)?;
        open.make_stream(Kind::Depth, SENSOR_DEPTH)?;
        Ok(open)
    }

    fn make_stream(&mut self, kind: Kind, sensor: c_int) -> Result<(), CameraError> {
        let place = &mut self.streams[kind as usize];
        // SAFETY: the device is valid, and the stream is writable.
        let status = unsafe { (self.api.oniDeviceCreateStream)(self.device, sensor, place) };
        self.api.check("oniDeviceCreateStream", status, &self.name)?;
        let is_mirrored: c_int = 0;
        // SAFETY: the stream is valid, and the value has the size of its type. A device without the property refuses the call.
        unsafe {
            (self.api.oniStreamSetProperty)(
                self.streams[kind as usize],
                STREAM_PROPERTY_MIRRORING,
                (&raw const is_mirrored).cast(),
                size_of_value::<c_int>(),
            );
        }
        Ok(())
    }

    /// Whether the device is a recording, which the library opens under any file name: only a recording can be wound to another frame.
    pub(super) fn is_recording(&self) -> bool {
        // SAFETY: the device is valid.
        unsafe { (self.api.oniDeviceIsCommandSupported)(self.device, DEVICE_COMMAND_SEEK) != 0 }
    }

    /// Makes a recording play each image once, as it is read.
    pub(super) fn play_once(&self) -> Result<(), CameraError> {
        let (is_repeated, speed): (c_int, f32) = (0, SPEED_BY_READER);
        self.set(DEVICE_PROPERTY_PLAYBACK_REPEAT, &is_repeated)?;
        self.set(DEVICE_PROPERTY_PLAYBACK_SPEED, &speed)
    }

    fn set<T: Copy>(&self, number: c_int, value: &T) -> Result<(), CameraError> {
        let value: *const T = value;
        // SAFETY: the device is valid, and the value has the size of its type.
        let status = unsafe {
            (self.api.oniDeviceSetProperty)(self.device, number, value.cast(), size_of_value::<T>())
        };
        self.api.check("oniDeviceSetProperty", status, &self.name)
    }

    /// Whether a recording has the cropping of each stream: without it the library delivers none of its images.
    pub(super) fn has_cropping(&self) -> bool {
        // Flag, column, row, width, height.
        let mut cropping = [0 as c_int; 5];
        [Kind::Color, Kind::Depth]
            .iter()
            .all(|kind| self.property(*kind, STREAM_PROPERTY_CROPPING, &mut cropping) == STATUS_OK)
    }

    /// Number of images of a stream of a recording; 0 if it is unknown.
    pub(super) fn frame_count(&self, kind: Kind) -> c_int {
        let mut count = 0;
        self.property(kind, STREAM_PROPERTY_FRAME_COUNT, &mut count);
        count
    }

    /// Requests depth registered to colour; `false` if the device does not offer it.
    pub(super) fn register_depth(&self) -> bool {
        let mode = REGISTRATION_DEPTH_TO_COLOR;
        // SAFETY: the device is valid, and the value has the size of its type.
        unsafe {
            (self.api.oniDeviceIsImageRegistrationModeSupported)(self.device, mode) != 0
                && (self.api.oniDeviceSetProperty)(
                    self.device,
                    DEVICE_PROPERTY_REGISTRATION,
                    (&raw const mode).cast(),
                    size_of_value::<c_int>(),
                ) == STATUS_OK
        }
    }

    /// The device's own description.
    pub(super) fn about(&self) -> Result<DeviceEntry, CameraError> {
        // SAFETY: all fields of the structure may be zero.
        let mut info: DeviceInfo = unsafe { std::mem::zeroed() };
        // SAFETY: the device is valid, and the information is writable.
        self.api.check(
            "oniDeviceGetInfo",
            unsafe { (self.api.oniDeviceGetInfo)(self.device, &mut info) },
            &self.name,
        )?;
        Ok(entry(&info))
    }

    /// Size, rate and format of a stream.
    pub(super) fn mode(&self, kind: Kind) -> Result<VideoMode, CameraError> {
        let mut mode = VideoMode::default();
        let status = self.property(kind, STREAM_PROPERTY_VIDEO_MODE, &mut mode);
        self.api.check("oniStreamGetProperty", status, &self.name).map(|()| mode)
    }

    /// Fields of view \[rad\]; 0 if the stream does not report them.
    pub(super) fn fields_of_view(&self, kind: Kind) -> (f64, f64) {
        let (mut across, mut down) = (0_f32, 0_f32);
        self.property(kind, STREAM_PROPERTY_HORIZONTAL_FOV, &mut across);
        self.property(kind, STREAM_PROPERTY_VERTICAL_FOV, &mut down);
        (f64::from(across), f64::from(down))
    }

    fn property<T: Copy>(&self, kind: Kind, number: c_int, value: &mut T) -> c_int {
        let mut size = size_of_value::<T>();
        let place: *mut T = value;
        // SAFETY: the stream is valid, and the value has the size given.
        unsafe {
            (self.api.oniStreamGetProperty)(self.streams[kind as usize], number, place.cast(), &mut size)
        }
    }

    /// Starts both streams.
    pub(super) fn start(&self) -> Result<(), CameraError> {
        self.streams.iter().try_for_each(|stream| {
            // SAFETY: the stream is valid.
            self.api.check("oniStreamStart", unsafe { (self.api.oniStreamStart)(*stream) }, &self.name)
        })
    }

    /// The next image of either stream, and its number in the stream; `None` if none came within `timeout`.
    pub(super) fn next_image(
        &mut self,
        timeout: Duration,
    ) -> Result<Option<(Kind, RawImage, c_int)>, CameraError> {
        let ms = c_int::try_from(timeout.as_millis()).unwrap_or(c_int::MAX);
        let mut index = -1;
        // SAFETY: both streams are valid, and the index is writable.
        let status = unsafe { (self.api.oniWaitForAnyStream)(self.streams.as_mut_ptr(), 2, &mut index, ms) };
        if status == STATUS_TIME_OUT {
            return Ok(None);
        }
        self.api.check("oniWaitForAnyStream", status, &self.name)?;
        let kind = if index == 0 { Kind::Color } else { Kind::Depth };
        let mut frame: *mut Frame = std::ptr::null_mut();
        // SAFETY: the stream is valid and has a frame, whose pointer is writable.
        let status = unsafe { (self.api.oniStreamReadFrame)(self.streams[kind as usize], &mut frame) };
        self.api.check("oniStreamReadFrame", status, &self.name)?;
        // SAFETY: the library made the frame; it is valid until its release.
        let (image, number) = unsafe { (image(&*frame), (*frame).index) };
        // SAFETY: the frame came from the library and is not used afterwards.
        unsafe { (self.api.oniFrameRelease)(frame) };
        Ok(Some((kind, image?, number)))
    }
}

impl Drop for OpenDevice {
    fn drop(&mut self) {
        let is_recording = self.is_recording();
        for stream in self.streams.into_iter().filter(|stream| !stream.is_null()) {
            // SAFETY: the stream is valid; stopping a stopped stream is allowed.
            unsafe { (self.api.oniStreamStop)(stream) };
            if !is_recording {
                // SAFETY: the stream is valid and not used afterwards.
                unsafe { (self.api.oniStreamDestroy)(stream) };
            }
        }
        if !is_recording {
            // SAFETY: the device is valid and its streams are destroyed.
            unsafe { (self.api.oniDeviceClose)(self.device) };
        }
    }
}

fn size_of_value<T>() -> c_int {
    size_of::<T>() as c_int
}

/// The form of the pixels for a number of `OniPixelFormat`.
pub(super) fn pixel_format(format: c_int) -> Result<PixelFormat, Invalid> {
    Ok(match format {
        100 | FORMAT_DEPTH_100_UM => PixelFormat::Depth16,
        200 => PixelFormat::Rgb8,
        201 => PixelFormat::Uyvy,
        202 => PixelFormat::Gray8,
        204 => PixelFormat::Mjpg,
        205 => PixelFormat::Yuyv,
        other => {
            return Err(Invalid::new(
                "pixel format of OpenNI2",
                other,
                "",
                "depth in mm, RGB888, YUV422, YUYV, GRAY8 or JPEG",
            ));
        }
    })
}

/// Length of one unit of depth \[m\].
pub(super) fn depth_unit_m(mode: VideoMode) -> f64 {
    if mode.format == FORMAT_DEPTH_100_UM { 1e-4 } else { 1e-3 }
}

/// A copy of an image.
///
/// # Safety
/// The frame must be valid: `data` points to `size` bytes.
unsafe fn image(frame: &Frame) -> Result<RawImage, Invalid> {
    let format = pixel_format(frame.mode.format)?;
    let number = |value: c_int| usize::try_from(value).unwrap_or(0);
    let (width, height, size) = (number(frame.width), number(frame.height), number(frame.size));
    let bytes = if frame.data.is_null() || size == 0 {
        Vec::new()
    } else {
        // SAFETY: the caller vouches for the data.
        unsafe { std::slice::from_raw_parts(frame.data.cast::<u8>(), size) }.to_vec()
    };
    let is_padded = format.bytes_per_pixel().is_some_and(|bytes| bytes * width != number(frame.stride));
    let nanos = i64::try_from(frame.micros).unwrap_or(i64::MAX).saturating_mul(NANOS_PER_US);
    let stride = if is_padded { number(frame.stride) } else { 0 };
    Ok(RawImage { format, width, height, stride, bytes, device_stamp: Stamp::from_nanos(nanos) })
}
