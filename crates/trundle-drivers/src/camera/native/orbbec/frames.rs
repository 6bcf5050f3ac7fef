//! Frames of OrbbecSDK as frames of a camera.

use super::api::{Handle, OrbbecError};
use super::functions::{Frame, OrbbecApi, Profile};
use super::intrinsics::{pinhole_camera, pose};
use crate::camera::{CameraError, CameraFrame, PixelFormat, RawImage, StreamInfo};
use std::ffi::c_int;
use std::sync::Arc;
use trundle_core::{Invalid, Pose3, Stamp};

pub(super) const FORMAT_Y16: c_int = 8;
pub(super) const FORMAT_RGB: c_int = 22;
/// Nanoseconds in a microsecond. Source: SI.
const NANOS_PER_US: i64 = 1000;
/// Metres in a millimetre. Source: SI.
const M_PER_MM: f64 = 1e-3;

/// The form of the pixels for a number of `ob_format`; `None` if [`PixelFormat`] has none.
fn pixel_format(format: c_int) -> Option<PixelFormat> {
    Some(match format {
        0 | 1 => PixelFormat::Yuyv,
        2 => PixelFormat::Uyvy,
        5 => PixelFormat::Mjpg,
        FORMAT_Y16 | 28 => PixelFormat::Depth16,
        9 => PixelFormat::Gray8,
        FORMAT_RGB => PixelFormat::Rgb8,
        23 => PixelFormat::Bgr8,
        25 => PixelFormat::Bgra8,
        31 => PixelFormat::Rgba8,
        _ => return None,
    })
}

/// Colour and depth of one set.
pub(super) struct FrameSet {
    color: Handle<Frame>,
    depth: Handle<Frame>,
}

impl FrameSet {
    /// The images of a set; `None` if one is missing.
    pub(super) fn new(api: &Arc<OrbbecApi>, set: &Handle<Frame>) -> Result<Option<Self>, OrbbecError> {
        // SAFETY: the set is valid.
        let color = api.owned_or_none(api.ob_delete_frame, |error| unsafe {
            (api.ob_frameset_get_color_frame)(set.get(), error)
        })?;
        // SAFETY: as above.
        let depth = api.owned_or_none(api.ob_delete_frame, |error| unsafe {
            (api.ob_frameset_get_depth_frame)(set.get(), error)
        })?;
        Ok(color.zip(depth).map(|(color, depth)| Self { color, depth }))
    }

    /// A copy of both images.
    pub(super) fn copy(&self, api: &OrbbecApi, device: &str) -> Result<CameraFrame, CameraError> {
        Ok(CameraFrame { color: image(api, &self.color, device)?, depth: image(api, &self.depth, device)? })
    }

    /// Length of one unit of depth \[m\].
    pub(super) fn depth_unit_m(&self, api: &OrbbecApi) -> Result<f64, OrbbecError> {
        // SAFETY: the frame is valid and holds depth.
        let mm =
            api.call(|error| unsafe { (api.ob_depth_frame_get_value_scale)(self.depth.get(), error) })?;
        Ok(f64::from(mm) * M_PER_MM)
    }

    /// The colour stream, the depth stream, and the pose of the depth camera in the colour camera's frame.
    pub(super) fn streams(
        &self,
        api: &Arc<OrbbecApi>,
        device: &str,
    ) -> Result<(StreamInfo, StreamInfo, Pose3), CameraError> {
        let color = profile(api, &self.color).map_err(|error| error.of(device))?;
        let depth = profile(api, &self.depth).map_err(|error| error.of(device))?;
        // SAFETY: both profiles are valid.
        let raw = api.call(|error| unsafe {
            (api.ob_stream_profile_get_extrinsic_to)(depth.get(), color.get(), error)
        });
        let color_from_depth = pose(&raw.map_err(|error| error.of(device))?)
            .map_err(|problem| CameraError::IntrinsicsUnusable { stream: "depth", problem })?;
        Ok((
            stream_info(api, &self.color, &color, "colour", device)?,
            stream_info(api, &self.depth, &depth, "depth", device)?,
            color_from_depth,
        ))
    }
}

fn profile(api: &Arc<OrbbecApi>, frame: &Handle<Frame>) -> Result<Handle<Profile>, OrbbecError> {
    // SAFETY: the frame is valid.
    api.owned(api.ob_delete_stream_profile, |error| unsafe {
        (api.ob_frame_get_stream_profile)(frame.get(), error)
    })
}

fn stream_info(
    api: &OrbbecApi,
    frame: &Handle<Frame>,
    profile: &Handle<Profile>,
    stream: &'static str,
    device: &str,
) -> Result<StreamInfo, CameraError> {
    let named = |error: OrbbecError| error.of(device);
    // SAFETY: the profile is valid and that of an image.
    let raw = api.call(|error| unsafe { (api.ob_video_stream_profile_get_intrinsic)(profile.get(), error) });
    // SAFETY: as above.
    let lens =
        api.call(|error| unsafe { (api.ob_video_stream_profile_get_distortion)(profile.get(), error) });
    // SAFETY: as above.
    let rate = api.call(|error| unsafe { (api.ob_video_stream_profile_get_fps)(profile.get(), error) });
    let (camera, error_px) = pinhole_camera(raw.map_err(named)?, lens.map_err(named)?)
        .map_err(|problem| CameraError::IntrinsicsUnusable { stream, problem })?;
    if error_px > 0.0 {
        tracing::info!(device, stream, error_px, "lens model fitted by Brown-Conrady");
    }
    Ok(StreamInfo { format: format(api, frame, device)?, camera, rate_hz: f64::from(rate.map_err(named)?) })
}

fn format(api: &OrbbecApi, frame: &Handle<Frame>, device: &str) -> Result<PixelFormat, CameraError> {
    // SAFETY: the frame is valid.
    let number = api.call(|error| unsafe { (api.ob_frame_get_format)(frame.get(), error) });
    let number = number.map_err(|error| error.of(device))?;
    let unknown =
        || Invalid::new("pixel format of OrbbecSDK", number, "", "rgb, bgr, yuyv, uyvy, mjpg, y8, y16");
    pixel_format(number).ok_or_else(|| unknown().into())
}

fn image(api: &OrbbecApi, frame: &Handle<Frame>, device: &str) -> Result<RawImage, CameraError> {
    let format = format(api, frame, device)?;
    pixels(api, frame, format).map_err(|error| error.of(device))
}

fn pixels(api: &OrbbecApi, frame: &Handle<Frame>, format: PixelFormat) -> Result<RawImage, OrbbecError> {
    // SAFETY: the frame is valid and holds an image.
    let width = api.call(|error| unsafe { (api.ob_video_frame_get_width)(frame.get(), error) })?;
    // SAFETY: as above.
    let height = api.call(|error| unsafe { (api.ob_video_frame_get_height)(frame.get(), error) })?;
    // SAFETY: as above.
    let micros = api.call(|error| unsafe { (api.ob_frame_get_timestamp_us)(frame.get(), error) })?;
    // SAFETY: as above.
    let size = api.call(|error| unsafe { (api.ob_frame_get_data_size)(frame.get(), error) })?;
    // SAFETY: as above.
    let start = api.call(|error| unsafe { (api.ob_frame_get_data)(frame.get(), error) })?;
    let bytes = if start.is_null() || size == 0 {
        Vec::new()
    } else {
        // SAFETY: the library holds `size` bytes from `start` on while the frame is valid.
        unsafe { std::slice::from_raw_parts(start, size as usize) }.to_vec()
    };
    let stamp = i64::try_from(micros).unwrap_or(i64::MAX).saturating_mul(NANOS_PER_US);
    Ok(RawImage::packed(format, (width as usize, height as usize), bytes, Stamp::from_nanos(stamp)))
}
