//! A started pipeline of librealsense2.

use super::RealSenseSettings;
use super::api::RealSenseError;
use super::constants::PLAYBACK_STATUS_STOPPED;
use super::functions::{Config, Context, Device, DeviceHub, Frame, Pipeline, PipelineProfile, RealSenseApi};
use super::handle::Handle;
use super::request::{Request, device_of};
use super::streams::{depth_unit_m, streams};
use crate::camera::native::DeviceEntry;
use crate::camera::{CameraError, CameraInfo};
use std::ffi::c_uint;
use std::sync::Arc;
use std::time::Duration;

/// A started pipeline. The order of the fields is the order of their release.
#[derive(Debug)]
pub(super) struct Running {
    pipeline: Handle<Pipeline>,
    device: Handle<Device>,
    hub: Option<Handle<DeviceHub>>,
    _config: Handle<Config>,
    _context: Handle<Context>,
    pub(super) api: Arc<RealSenseApi>,
}

impl Running {
    /// Starts the pipeline of `request`; `name` is the camera in errors.
    pub(super) fn start(
        request: Request,
        is_live: bool,
        name: &str,
    ) -> Result<(Self, Handle<PipelineProfile>), CameraError> {
        let Request { api, context, pipeline, config } = request;
        // SAFETY: the objects are valid.
        let started = api.owned(api.rs2_delete_pipeline_profile, |error| unsafe {
            (api.rs2_pipeline_start_with_config)(pipeline.get(), config.get(), error)
        });
        let started = started.map_err(|error| error.of(name))?;
        let device = device_of(&api, &started).map_err(|error| error.of(name))?;
        if !is_live {
            // SAFETY: the device is valid and a recording.
            api.call(|error| unsafe { (api.rs2_playback_device_resume)(device.get(), error) })
                .map_err(|error| error.of(name))?;
        }
        let hub = if is_live { Some(hub(&api, &context).map_err(|error| error.of(name))?) } else { None };
        Ok((Self { pipeline, device, hub, _config: config, _context: context, api }, started))
    }

    /// The camera's own description.
    pub(super) fn info(
        &self,
        about: DeviceEntry,
        started: &Handle<PipelineProfile>,
        settings: &RealSenseSettings,
        is_live: bool,
        name: &str,
    ) -> Result<CameraInfo, CameraError> {
        let streams = streams(&self.api, started, name)?;
        Ok(CameraInfo {
            name: about.name,
            serial: about.serial,
            firmware: about.firmware,
            usb: about.usb,
            color: streams.color,
            depth: streams.depth,
            depth_unit_m: depth_unit_m(&self.api, &self.device).map_err(|error| error.of(name))?,
            color_from_depth: Some(streams.color_from_depth),
            delay_s: settings.delay_s,
            is_live,
        })
    }

    /// The next set of frames; `None` if none came within `timeout`.
    pub(super) fn wait(&self, timeout: Duration) -> Result<Option<Handle<Frame>>, RealSenseError> {
        let ms = c_uint::try_from(timeout.as_millis()).unwrap_or(c_uint::MAX);
        let mut set: *mut Frame = std::ptr::null_mut();
        // SAFETY: the pipeline is valid, and the set is writable.
        let is_there = self.api.call(|error| unsafe {
            (self.api.rs2_pipeline_try_wait_for_frames)(self.pipeline.get(), &mut set, ms, error)
        })?;
        let set = if is_there == 0 { std::ptr::null_mut() } else { set };
        Ok(Handle::new(set, self.api.rs2_release_frame, &self.api))
    }

    /// Whether a live camera was unplugged.
    pub(super) fn is_unplugged(&self) -> Result<bool, RealSenseError> {
        let Some(hub) = &self.hub else { return Ok(false) };
        // SAFETY: both objects are valid.
        let is_connected = self.api.call(|error| unsafe {
            (self.api.rs2_device_hub_is_device_connected)(hub.get(), self.device.get(), error)
        })?;
        Ok(is_connected == 0)
    }

    /// Whether a recording has ended.
    pub(super) fn is_played(&self) -> Result<bool, RealSenseError> {
        // SAFETY: the device is valid and a recording.
        let status = self.api.call(|error| unsafe {
            (self.api.rs2_playback_device_get_current_status)(self.device.get(), error)
        })?;
        Ok(status == PLAYBACK_STATUS_STOPPED)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // SAFETY: the pipeline is valid and started.
        let stopped =
            self.api.call(|error| unsafe { (self.api.rs2_pipeline_stop)(self.pipeline.get(), error) });
        if let Err(error) = stopped {
            tracing::warn!(?error, "a RealSense camera did not stop");
        }
    }
}

fn hub(api: &Arc<RealSenseApi>, context: &Handle<Context>) -> Result<Handle<DeviceHub>, RealSenseError> {
    // SAFETY: the context is valid.
    api.owned(api.rs2_delete_device_hub, |error| unsafe { (api.rs2_create_device_hub)(context.get(), error) })
}
