//! Facts that librealsense2 reports of the streams of a started pipeline.

use super::api::RealSenseError;
use super::constants::{EXTENSION_DEPTH_SENSOR, STREAM_COLOR, STREAM_DEPTH, pixel_format};
use super::functions::{Device, Extrinsics, Intrinsics, PipelineProfile, Profile, ProfileList, RealSenseApi};
use super::handle::Handle;
use super::intrinsics::{pinhole_camera, pose};
use crate::camera::{CameraError, StreamInfo};
use std::ffi::c_int;
use std::sync::Arc;
use trundle_core::{Invalid, Pose3};

/// The streams of a pipeline.
pub(super) struct Streams {
    pub(super) color: StreamInfo,
    pub(super) depth: StreamInfo,
    pub(super) color_from_depth: Pose3,
}

/// Kind, format and rate of a stream.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ProfileData {
    pub(super) stream: c_int,
    pub(super) format: c_int,
    pub(super) rate_hz: c_int,
}

/// The colour and the depth stream of a started pipeline; `device` is the name in errors.
pub(super) fn streams(
    api: &Arc<RealSenseApi>,
    started: &Handle<PipelineProfile>,
    device: &str,
) -> Result<Streams, CameraError> {
    // SAFETY: the profile is valid.
    let list = api.owned(api.rs2_delete_stream_profiles_list, |error| unsafe {
        (api.rs2_pipeline_profile_get_streams)(started.get(), error)
    });
    let list = list.map_err(|error| error.of(device))?;
    let profiles = profiles(api, &list).map_err(|error| error.of(device))?;
    let find = |stream: c_int| profiles.iter().find(|(_, data)| data.stream == stream);
    let (Some(color), Some(depth)) = (find(STREAM_COLOR), find(STREAM_DEPTH)) else {
        return Err(missing(device));
    };
    Ok(Streams {
        color: stream_info(api, color, "colour", device)?,
        depth: stream_info(api, depth, "depth", device)?,
        color_from_depth: extrinsics(api, depth.0, color.0, device)?,
    })
}

fn missing(device: &str) -> CameraError {
    CameraError::StreamsUnavailable {
        device: device.into(),
        wanted: "colour with depth".into(),
        remedy: "use a camera with a colour sensor, or a recording with both streams".into(),
    }
}

fn profiles(
    api: &RealSenseApi,
    list: &Handle<ProfileList>,
) -> Result<Vec<(*const Profile, ProfileData)>, RealSenseError> {
    // SAFETY: the list is valid.
    let count = api.call(|error| unsafe { (api.rs2_get_stream_profiles_count)(list.get(), error) })?;
    (0..count)
        .map(|index| {
            // SAFETY: the list is valid, and the index is below its length.
            let profile =
                api.call(|error| unsafe { (api.rs2_get_stream_profile)(list.get(), index, error) })?;
            Ok((profile, profile_data(api, profile)?))
        })
        .collect()
}

/// Kind, format and rate of a living profile.
pub(super) fn profile_data(
    api: &RealSenseApi,
    profile: *const Profile,
) -> Result<ProfileData, RealSenseError> {
    let [mut stream, mut format, mut index, mut id, mut rate_hz] = [0; 5];
    // SAFETY: the profile is valid, and each number is writable.
    api.call(|error| unsafe {
        (api.rs2_get_stream_profile_data)(
            profile,
            &mut stream,
            &mut format,
            &mut index,
            &mut id,
            &mut rate_hz,
            error,
        )
    })?;
    Ok(ProfileData { stream, format, rate_hz })
}

fn stream_info(
    api: &RealSenseApi,
    (profile, data): &(*const Profile, ProfileData),
    stream: &'static str,
    device: &str,
) -> Result<StreamInfo, CameraError> {
    let mut raw = Intrinsics::default();
    // SAFETY: the profile is valid, and the intrinsics are writable.
    api.call(|error| unsafe { (api.rs2_get_video_stream_intrinsics)(*profile, &mut raw, error) })
        .map_err(|error| error.of(device))?;
    let unusable = |problem| CameraError::IntrinsicsUnusable { stream, problem };
    let (camera, error_px) = pinhole_camera(&raw).map_err(unusable)?;
    if error_px > 0.0 {
        tracing::info!(device, stream, model = raw.model, error_px, "lens model fitted by Brown-Conrady");
    }
    let format = pixel_format(data.format).ok_or_else(|| unusable(format_unknown(data.format)))?;
    Ok(StreamInfo { format, camera, rate_hz: f64::from(data.rate_hz) })
}

fn format_unknown(format: c_int) -> Invalid {
    Invalid::new(
        "pixel format of librealsense",
        format,
        "",
        "z16, rgb8, bgr8, rgba8, bgra8, yuyv, uyvy, y8 or mjpeg",
    )
}

fn extrinsics(
    api: &RealSenseApi,
    from: *const Profile,
    to: *const Profile,
    device: &str,
) -> Result<Pose3, CameraError> {
    let mut raw = Extrinsics::default();
    // SAFETY: both profiles are valid, and the extrinsics are writable.
    api.call(|error| unsafe { (api.rs2_get_extrinsics)(from, to, &mut raw, error) })
        .map_err(|error| error.of(device))?;
    pose(&raw).map_err(|problem| CameraError::IntrinsicsUnusable { stream: "depth", problem })
}

/// Length of one unit of depth \[m\].
pub(super) fn depth_unit_m(api: &Arc<RealSenseApi>, device: &Handle<Device>) -> Result<f64, RealSenseError> {
    // SAFETY: the device is valid.
    let list = api
        .owned(api.rs2_delete_sensor_list, |error| unsafe { (api.rs2_query_sensors)(device.get(), error) })?;
    // SAFETY: the list is valid.
    let count = api.call(|error| unsafe { (api.rs2_get_sensors_count)(list.get(), error) })?;
    for index in 0..count {
        // SAFETY: the list is valid, and the index is below its length.
        let sensor = api.owned(api.rs2_delete_sensor, |error| unsafe {
            (api.rs2_create_sensor)(list.get(), index, error)
        })?;
        // SAFETY: the sensor is valid.
        let is_depth = api.call(|error| unsafe {
            (api.rs2_is_sensor_extendable_to)(sensor.get(), EXTENSION_DEPTH_SENSOR, error)
        })?;
        if is_depth != 0 {
            // SAFETY: the sensor is valid and measures depth.
            return api
                .call(|error| unsafe { (api.rs2_get_depth_scale)(sensor.get(), error) })
                .map(f64::from);
        }
    }
    Err(RealSenseError::without_object("depth sensor"))
}
