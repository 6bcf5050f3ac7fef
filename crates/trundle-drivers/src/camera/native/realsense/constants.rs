//! Numbers of the C API of librealsense2. Source: its headers `rs_sensor.h`, `rs_types.h`, `rs_frame.h`, `rs_record_playback.h`.

use crate::camera::PixelFormat;
use std::ffi::c_int;

pub(super) const CAMERA_INFO_NAME: c_int = 0;
pub(super) const CAMERA_INFO_SERIAL_NUMBER: c_int = 1;
pub(super) const CAMERA_INFO_FIRMWARE_VERSION: c_int = 2;
pub(super) const CAMERA_INFO_USB_TYPE: c_int = 9;

pub(super) const STREAM_DEPTH: c_int = 1;
pub(super) const STREAM_COLOR: c_int = 2;
pub(super) const STREAM_GYRO: c_int = 5;

pub(super) const FORMAT_ANY: c_int = 0;
pub(super) const FORMAT_Z16: c_int = 1;
pub(super) const FORMAT_RGB8: c_int = 5;
pub(super) const FORMAT_MOTION_XYZ32F: c_int = 16;

pub(super) const EXTENSION_DEPTH_SENSOR: c_int = 7;
pub(super) const EXTENSION_MOTION_FRAME: c_int = 9;
pub(super) const EXTENSION_COMPOSITE_FRAME: c_int = 10;

pub(super) const EXCEPTION_CAMERA_DISCONNECTED: c_int = 1;

pub(super) const DOMAIN_HARDWARE_CLOCK: c_int = 0;

pub(super) const PLAYBACK_STATUS_STOPPED: c_int = 3;

/// The form of the pixels for a number of `rs2_format`; `None` if [`PixelFormat`] has none.
pub(super) fn pixel_format(format: c_int) -> Option<PixelFormat> {
    Some(match format {
        FORMAT_Z16 => PixelFormat::Depth16,
        4 => PixelFormat::Yuyv,
        FORMAT_RGB8 => PixelFormat::Rgb8,
        6 => PixelFormat::Bgr8,
        7 => PixelFormat::Rgba8,
        8 => PixelFormat::Bgra8,
        9 => PixelFormat::Gray8,
        14 => PixelFormat::Uyvy,
        22 => PixelFormat::Mjpg,
        _ => return None,
    })
}
