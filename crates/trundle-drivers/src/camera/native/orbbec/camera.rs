//! An Orbbec camera.

use super::api::{Handle, OrbbecError};
use super::device_list::{device_list, entries};
use super::frames::{FORMAT_RGB, FORMAT_Y16, FrameSet};
use super::functions::{Config, Context, Device, Frame, OrbbecApi, Pipeline};
use crate::camera::native::{DeviceEntry, Selection};
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera};
use std::ffi::c_int;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

const STREAM_COLOR: c_int = 2;
const STREAM_DEPTH: c_int = 3;
/// Kind of the camera, in errors.
const KIND: &str = "Orbbec";
/// Longest wait for the first frame: 5 s; beyond it, opening fails. Source: ours.
const FIRST_FRAME_TIMEOUT: Duration = Duration::from_secs(5);
/// Time from the middle of the exposure to the arrival of a frame \[s\]. Source: ours, assumed as for a RealSense camera.
const DEFAULT_DELAY_S: f64 = 0.045;

/// Settings to request from an Orbbec camera. A size or rate of 0 means any.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OrbbecSettings {
    /// Columns and rows of the colour image \[px\]. Default any.
    pub color_size: (u32, u32),
    /// Columns and rows of the depth image \[px\]. Default any.
    pub depth_size: (u32, u32),
    /// Frames per second of both \[Hz\]. Default 30.
    pub rate_hz: u32,
    /// Time from the middle of the exposure to the arrival of a frame \[s\]. Default 0.045, assumed.
    pub delay_s: f64,
    /// File of the library; `None` if it is searched.
    pub library: Option<PathBuf>,
}

impl Default for OrbbecSettings {
    fn default() -> Self {
        Self { color_size: (0, 0), depth_size: (0, 0), rate_hz: 30, delay_s: DEFAULT_DELAY_S, library: None }
    }
}

/// An Orbbec camera.
#[derive(Debug)]
pub struct OrbbecCamera {
    info: CameraInfo,
    first: Option<CameraFrame>,
    running: Running,
}

/// A started pipeline. The order of the fields is the order of their release.
#[derive(Debug)]
struct Running {
    pipeline: Handle<Pipeline>,
    _device: Handle<Device>,
    _context: Handle<Context>,
    api: Arc<OrbbecApi>,
    name: String,
}

impl OrbbecCamera {
    /// Opens a camera, starts its streams, and waits for the first frame, which contains the intrinsics.
    ///
    /// # Errors
    /// When the camera is missing, in use, forbidden, silent or without these streams, its intrinsics are unusable, or `selection` is a
    /// file.
    pub fn open(
        api: &Arc<OrbbecApi>,
        selection: &Selection,
        settings: &OrbbecSettings,
    ) -> Result<Self, CameraError> {
        if let Selection::File(file) = selection {
            return Err(no_recording(&file.display().to_string()));
        }
        let (device, entry, context) = find(api, selection)?;
        let name = format!("{} {}", entry.name, entry.serial);
        let running =
            Running::start(api, context, device, settings, name.clone()).map_err(|error| error.of(&name))?;
        let set = running.wait(FIRST_FRAME_TIMEOUT)?.ok_or_else(|| silent(&name))?;
        let (color, depth, color_from_depth) = set.streams(api, &name)?;
        let info = CameraInfo {
            name: entry.name,
            serial: entry.serial,
            firmware: entry.firmware,
            usb: entry.usb,
            color,
            depth,
            depth_unit_m: set.depth_unit_m(api).map_err(|error| error.of(&name))?,
            color_from_depth: Some(color_from_depth),
            delay_s: settings.delay_s,
            is_live: true,
        };
        Ok(Self { info, first: Some(set.copy(api, &name)?), running })
    }
}

impl DepthCamera for OrbbecCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        if let Some(first) = self.first.take() {
            return Ok(Some(first));
        }
        let set = self.running.wait(timeout)?;
        set.map(|set| set.copy(&self.running.api, &self.running.name)).transpose()
    }
}

impl Running {
    fn start(
        api: &Arc<OrbbecApi>,
        context: Handle<Context>,
        device: Handle<Device>,
        settings: &OrbbecSettings,
        name: String,
    ) -> Result<Self, OrbbecError> {
        // SAFETY: the device is valid.
        let pipeline = api.owned(api.ob_delete_pipeline, |error| unsafe {
            (api.ob_create_pipeline_with_device)(device.get(), error)
        })?;
        let config = config(api, settings)?;
        // SAFETY: the pipeline is valid.
        let synced = api.call(|error| unsafe { (api.ob_pipeline_enable_frame_sync)(pipeline.get(), error) });
        if let Err(error) = synced {
            tracing::warn!(?error, name, "the camera does not synchronize colour and depth");
        }
        // SAFETY: both objects are valid.
        api.call(|error| unsafe {
            (api.ob_pipeline_start_with_config)(pipeline.get(), config.get(), error)
        })?;
        Ok(Self { pipeline, _device: device, _context: context, api: Arc::clone(api), name })
    }

    /// The next set with both images; `None` if none came within `timeout`.
    fn wait(&self, timeout: Duration) -> Result<Option<FrameSet>, CameraError> {
        let start = Instant::now();
        loop {
            let left = timeout.saturating_sub(start.elapsed());
            let Some(set) = self.next_set(left).map_err(|error| error.of(&self.name))? else {
                return Ok(None);
            };
            if let Some(set) = FrameSet::new(&self.api, &set).map_err(|error| error.of(&self.name))? {
                return Ok(Some(set));
            }
        }
    }

    fn next_set(&self, timeout: Duration) -> Result<Option<Handle<Frame>>, OrbbecError> {
        let ms = u32::try_from(timeout.as_millis()).unwrap_or(u32::MAX);
        // SAFETY: the pipeline is valid.
        self.api.owned_or_none(self.api.ob_delete_frame, |error| unsafe {
            (self.api.ob_pipeline_wait_for_frameset)(self.pipeline.get(), ms, error)
        })
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // SAFETY: the pipeline is valid; it was started.
        let stopped =
            self.api.call(|error| unsafe { (self.api.ob_pipeline_stop)(self.pipeline.get(), error) });
        if let Err(error) = stopped {
            tracing::warn!(?error, name = self.name, "an Orbbec camera did not stop");
        }
    }
}

fn config(api: &Arc<OrbbecApi>, settings: &OrbbecSettings) -> Result<Handle<Config>, OrbbecError> {
    // SAFETY: the function takes the place of an error only.
    let config = api.owned(api.ob_delete_config, |error| unsafe { (api.ob_create_config)(error) })?;
    let streams =
        [(STREAM_COLOR, settings.color_size, FORMAT_RGB), (STREAM_DEPTH, settings.depth_size, FORMAT_Y16)];
    for (stream, (width, height), format) in streams {
        // SAFETY: the object is valid.
        api.call(|error| unsafe {
            (api.ob_config_enable_video_stream)(
                config.get(),
                stream,
                width,
                height,
                settings.rate_hz,
                format,
                error,
            )
        })?;
    }
    Ok(config)
}

fn find(
    api: &Arc<OrbbecApi>,
    selection: &Selection,
) -> Result<(Handle<Device>, DeviceEntry, Handle<Context>), CameraError> {
    let name = selection.describe(KIND);
    let named = |error: OrbbecError| error.of(&name);
    let context = api.context().map_err(named)?;
    let list = device_list(api, &context).map_err(named)?;
    let entries = entries(api, &list).map_err(named)?;
    let is_wanted = |entry: &DeviceEntry| match selection {
        Selection::Serial(serial) => entry.serial == *serial,
        _ => true,
    };
    let found = entries.into_iter().zip(0_u32..).find(|(entry, _)| is_wanted(entry));
    let (entry, index) = found.ok_or_else(|| CameraError::NoDevice { kind: name.clone() })?;
    // SAFETY: the list is valid, and the index is below its length.
    let device = api.owned(api.ob_delete_device, |error| unsafe {
        (api.ob_device_list_get_device)(list.get(), index, error)
    });
    Ok((device.map_err(named)?, entry, context))
}

fn silent(name: &str) -> CameraError {
    CameraError::StreamsUnavailable {
        device: name.into(),
        wanted: "colour with depth within 5 s".into(),
        remedy: "use a blue USB port and a USB 3 cable, or choose another size and rate".into(),
    }
}

fn no_recording(file: &str) -> CameraError {
    CameraError::StreamsUnavailable {
        device: KIND.into(),
        wanted: format!("the recording {file}"),
        remedy: "convert it to a camera stream".into(),
    }
}
