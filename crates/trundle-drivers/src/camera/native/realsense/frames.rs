//! Frames of librealsense2 as frames of a camera.

use super::api::RealSenseError;
use super::constants::{
    EXTENSION_COMPOSITE_FRAME, EXTENSION_MOTION_FRAME, STREAM_COLOR, STREAM_DEPTH, STREAM_GYRO, pixel_format,
};
use super::functions::{Frame, RealSenseApi};
use super::handle::Handle;
use super::streams::profile_data;
use crate::camera::{GyroSample, RawImage};
use std::ffi::c_int;
use std::sync::Arc;
use trundle_core::{Stamp, Vector3};

/// Nanoseconds in a millisecond. Source: SI.
const NANOS_PER_MS: f64 = 1e6;

/// Content of a frame of the library.
#[derive(Debug)]
pub(super) enum Content {
    /// An image of the stream.
    Image { stream: c_int, image: RawImage, number: u64, domain: c_int },
    /// A sample of the gyro.
    Gyro(GyroSample),
    /// Anything else.
    Other,
}

/// The frames inside a set; for a single frame, the frame itself.
pub(super) fn parts(
    api: &Arc<RealSenseApi>,
    frame: Handle<Frame>,
) -> Result<Vec<Handle<Frame>>, RealSenseError> {
    if !is_a(api, &frame, EXTENSION_COMPOSITE_FRAME)? {
        return Ok(vec![frame]);
    }
    // SAFETY: the frame is valid and a set.
    let count = api.call(|error| unsafe { (api.rs2_embedded_frames_count)(frame.get(), error) })?;
    (0..count)
        .map(|index| {
            // SAFETY: the set is valid, and the index is below its length. The result is a separate reference.
            api.owned(api.rs2_release_frame, |error| unsafe {
                (api.rs2_extract_frame)(frame.get(), index, error)
            })
        })
        .collect()
}

fn is_a(api: &RealSenseApi, frame: &Handle<Frame>, extension: c_int) -> Result<bool, RealSenseError> {
    // SAFETY: the frame is valid.
    let answer =
        api.call(|error| unsafe { (api.rs2_is_frame_extendable_to)(frame.get(), extension, error) })?;
    Ok(answer != 0)
}

/// A copy of a frame that is not a set.
pub(super) fn content(api: &RealSenseApi, frame: &Handle<Frame>) -> Result<Content, RealSenseError> {
    // SAFETY: the frame is valid, and its profile outlives it.
    let profile = api.call(|error| unsafe { (api.rs2_get_frame_stream_profile)(frame.get(), error) })?;
    let data = profile_data(api, profile)?;
    match (data.stream, pixel_format(data.format)) {
        (STREAM_GYRO, _) if is_a(api, frame, EXTENSION_MOTION_FRAME)? => gyro(api, frame),
        (STREAM_COLOR | STREAM_DEPTH, Some(format)) => image(api, frame, data.stream, format),
        _ => Ok(Content::Other),
    }
}

fn gyro(api: &RealSenseApi, frame: &Handle<Frame>) -> Result<Content, RealSenseError> {
    let bytes = bytes(api, frame)?;
    let mut axes = bytes.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
    match (axes.next(), axes.next(), axes.next()) {
        (Some(x), Some(y), Some(z)) => {
            let rate = Vector3::new(f64::from(x), f64::from(y), f64::from(z));
            Ok(Content::Gyro(GyroSample { device_stamp: stamp(api, frame)?, rate }))
        }
        _ => Ok(Content::Other),
    }
}

fn image(
    api: &RealSenseApi,
    frame: &Handle<Frame>,
    stream: c_int,
    format: crate::camera::PixelFormat,
) -> Result<Content, RealSenseError> {
    let frame_pointer = frame.get();
    // SAFETY: the frame is valid and holds an image.
    let width = api.call(|error| unsafe { (api.rs2_get_frame_width)(frame_pointer, error) })?;
    // SAFETY: as above.
    let height = api.call(|error| unsafe { (api.rs2_get_frame_height)(frame_pointer, error) })?;
    // SAFETY: as above.
    let stride = api.call(|error| unsafe { (api.rs2_get_frame_stride_in_bytes)(frame_pointer, error) })?;
    // SAFETY: as above.
    let number = api.call(|error| unsafe { (api.rs2_get_frame_number)(frame_pointer, error) })?;
    // SAFETY: as above.
    let domain = api.call(|error| unsafe { (api.rs2_get_frame_timestamp_domain)(frame_pointer, error) })?;
    let size = |value: c_int| usize::try_from(value).unwrap_or(0);
    let row = format.bytes_per_pixel().map(|bytes| bytes * size(width));
    let image = RawImage {
        format,
        width: size(width),
        height: size(height),
        stride: if row.is_some_and(|row| row != size(stride)) { size(stride) } else { 0 },
        bytes: bytes(api, frame)?,
        device_stamp: stamp(api, frame)?,
    };
    Ok(Content::Image { stream, image, number, domain })
}

/// A copy of the data.
fn bytes(api: &RealSenseApi, frame: &Handle<Frame>) -> Result<Vec<u8>, RealSenseError> {
    // SAFETY: the frame is valid.
    let size = api.call(|error| unsafe { (api.rs2_get_frame_data_size)(frame.get(), error) })?;
    // SAFETY: as above.
    let start = api.call(|error| unsafe { (api.rs2_get_frame_data)(frame.get(), error) })?.cast::<u8>();
    let size = usize::try_from(size).unwrap_or(0);
    if start.is_null() || size == 0 {
        return Ok(Vec::new());
    }
    // SAFETY: the library holds `size` bytes from `start` on while the frame is valid.
    Ok(unsafe { std::slice::from_raw_parts(start, size) }.to_vec())
}

fn stamp(api: &RealSenseApi, frame: &Handle<Frame>) -> Result<Stamp, RealSenseError> {
    // SAFETY: the frame is valid.
    let ms = api.call(|error| unsafe { (api.rs2_get_frame_timestamp)(frame.get(), error) })?;
    Ok(Stamp::from_nanos((ms * NANOS_PER_MS).round() as i64))
}
