//! A started pipeline of librealsense2.

use super::RealSenseSettings;
use super::api::RealSenseError;
use super::constants::PLAYBACK_STATUS_STOPPED;
use super::functions::{
    Config, Context, Device, DeviceHub, Frame, FrameQueue, Pipeline, PipelineProfile, RealSenseApi,
};
use super::handle::Handle;
use super::request::{Request, device_of};
use super::streams::{depth_unit_m, streams};
use crate::camera::native::DeviceEntry;
use crate::camera::{CameraError, CameraInfo};
use std::ffi::{c_int, c_uint};
use std::sync::Arc;
use std::time::Duration;

/// Maximum number of frames in the queue: the library drops older ones. Source: ours; 0.1 s of a gyro at 400 Hz with images.
const QUEUE_FRAMES: c_int = 48;

/// A started pipeline. The order of the fields is the order of their release.
#[derive(Debug)]
pub(super) struct Running {
    pipeline: Handle<Pipeline>,
    /// Sets of images and single samples of the gyro; `None` if only sets are read, from the pipeline itself.
    queue: Option<Handle<FrameQueue>>,
    device: Handle<Device>,
    hub: Option<Handle<DeviceHub>>,
    _config: Handle<Config>,
    _context: Handle<Context>,
    pub(super) api: Arc<RealSenseApi>,
}

impl Running {
    /// Starts the pipeline of `request`; `name` is the camera in errors. With `reads_gyro`, each sample of the gyro is read: a set of images
    /// contains only the newest one, whose rate is too low for an integration.
    pub(super) fn start(
        request: Request,
        is_live: bool,
        reads_gyro: bool,
        name: &str,
    ) -> Result<(Self, Handle<PipelineProfile>), CameraError> {
        let queue = reads_gyro.then(|| queue(&request.api)).transpose().map_err(|error| error.of(name))?;
        let started = start(&request, queue.as_ref()).map_err(|error| error.of(name))?;
        let Request { api, context, pipeline, config } = request;
        let device = device_of(&api, &started).map_err(|error| error.of(name))?;
        if !is_live {
            // SAFETY: the device is valid and a recording.
            api.call(|error| unsafe { (api.rs2_playback_device_resume)(device.get(), error) })
                .map_err(|error| error.of(name))?;
        }
        let hub = if is_live { Some(hub(&api, &context).map_err(|error| error.of(name))?) } else { None };
        Ok((Self { pipeline, queue, device, hub, _config: config, _context: context, api }, started))
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

    /// The next set of frames, or the next sample of the gyro; `None` if none came within `timeout`.
    pub(super) fn wait(&self, timeout: Duration) -> Result<Option<Handle<Frame>>, RealSenseError> {
        let ms = c_uint::try_from(timeout.as_millis()).unwrap_or(c_uint::MAX);
        let mut set: *mut Frame = std::ptr::null_mut();
        let is_there = match &self.queue {
            // SAFETY: the queue is valid, and the set is writable.
            Some(queue) => self.api.call(|error| unsafe {
                (self.api.rs2_try_wait_for_frame)(queue.get(), ms, &mut set, error)
            })?,
            // SAFETY: the pipeline is valid, and the set is writable.
            None => self.api.call(|error| unsafe {
                (self.api.rs2_pipeline_try_wait_for_frames)(self.pipeline.get(), &mut set, ms, error)
            })?,
        };
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

fn queue(api: &Arc<RealSenseApi>) -> Result<Handle<FrameQueue>, RealSenseError> {
    // SAFETY: the function takes a number and the place of an error.
    api.owned(api.rs2_delete_frame_queue, |error| unsafe {
        (api.rs2_create_frame_queue)(QUEUE_FRAMES, error)
    })
}

fn start(
    request: &Request,
    queue: Option<&Handle<FrameQueue>>,
) -> Result<Handle<PipelineProfile>, RealSenseError> {
    let Request { api, pipeline, config, .. } = request;
    api.owned(api.rs2_delete_pipeline_profile, |error| match queue {
        // SAFETY: the objects are valid. The library's own function takes each frame, and the queue outlives the pipeline.
        Some(queue) => unsafe {
            (api.rs2_pipeline_start_with_config_and_callback)(
                pipeline.get(),
                config.get(),
                api.rs2_enqueue_frame,
                queue.get().cast(),
                error,
            )
        },
        // SAFETY: the objects are valid.
        None => unsafe { (api.rs2_pipeline_start_with_config)(pipeline.get(), config.get(), error) },
    })
}

fn hub(api: &Arc<RealSenseApi>, context: &Handle<Context>) -> Result<Handle<DeviceHub>, RealSenseError> {
    // SAFETY: the context is valid.
    api.owned(api.rs2_delete_device_hub, |error| unsafe { (api.rs2_create_device_hub)(context.get(), error) })
}
