//! The streams requested from librealsense2.

use super::RealSenseSettings;
use super::api::RealSenseError;
use super::constants::{
    FORMAT_ANY, FORMAT_MOTION_XYZ32F, FORMAT_RGB8, FORMAT_Z16, STREAM_COLOR, STREAM_DEPTH, STREAM_GYRO,
};
use super::functions::{Config, Context, Device, Pipeline, PipelineProfile, RealSenseApi};
use super::handle::Handle;
use crate::camera::CameraError;
use crate::camera::native::Selection;
use std::ffi::{CString, c_int};
use std::path::Path;
use std::sync::Arc;

/// Any index, size or rate of a stream.
const ANY: c_int = 0;
const ANY_INDEX: c_int = -1;

/// A pipeline before its start, and its request.
pub(super) struct Request {
    pub(super) api: Arc<RealSenseApi>,
    pub(super) context: Handle<Context>,
    pub(super) pipeline: Handle<Pipeline>,
    pub(super) config: Handle<Config>,
}

impl Request {
    /// A request for the streams of `settings` from the camera or recording `selection`.
    pub(super) fn new(
        api: &Arc<RealSenseApi>,
        selection: &Selection,
        settings: &RealSenseSettings,
    ) -> Result<Self, CameraError> {
        let request = Self::empty(api).map_err(|error| error.of("any camera"))?;
        match selection {
            Selection::File(file) => request.select_file(file, settings)?,
            Selection::Serial(serial) => {
                let text = c_string(serial)?;
                request.enable_live(settings).map_err(|error| error.of(serial))?;
                // SAFETY: the request and the text are valid.
                let enabled = request.api.call(|error| unsafe {
                    (api.rs2_config_enable_device)(request.config.get(), text.as_ptr(), error)
                });
                enabled.map_err(|error| error.of(serial))?;
            }
            Selection::First => request.enable_live(settings).map_err(|error| error.of("RealSense"))?,
        }
        Ok(request)
    }

    /// Whether a camera or recording offers these streams.
    pub(super) fn can_resolve(&self) -> Result<bool, RealSenseError> {
        // SAFETY: both objects are valid.
        let found = self.api.call(|error| unsafe {
            (self.api.rs2_config_can_resolve)(self.config.get(), self.pipeline.get(), error)
        })?;
        Ok(found != 0)
    }

    /// The device that the request leads to.
    pub(super) fn resolved_device(&self) -> Result<Handle<Device>, RealSenseError> {
        let api = &self.api;
        // SAFETY: both objects are valid.
        let profile = api.owned(api.rs2_delete_pipeline_profile, |error| unsafe {
            (api.rs2_config_resolve)(self.config.get(), self.pipeline.get(), error)
        })?;
        device_of(api, &profile)
    }

    fn empty(api: &Arc<RealSenseApi>) -> Result<Self, RealSenseError> {
        let context = api.context()?;
        // SAFETY: the context is valid.
        let pipeline = api.owned(api.rs2_delete_pipeline, |error| unsafe {
            (api.rs2_create_pipeline)(context.get(), error)
        })?;
        // SAFETY: the function takes the place of an error only.
        let config = api.owned(api.rs2_delete_config, |error| unsafe { (api.rs2_create_config)(error) })?;
        Ok(Self { api: Arc::clone(api), context, pipeline, config })
    }

    fn enable_live(&self, settings: &RealSenseSettings) -> Result<(), RealSenseError> {
        let rate = c_int::try_from(settings.rate_hz).unwrap_or(c_int::MAX);
        self.enable(STREAM_COLOR, settings.color_size, FORMAT_RGB8, rate)?;
        self.enable(STREAM_DEPTH, settings.depth_size, FORMAT_Z16, rate)?;
        self.enable_gyro(settings)
    }

    /// The streams of a recording, in the recorded format. The recording is played once.
    fn select_file(&self, file: &Path, settings: &RealSenseSettings) -> Result<(), CameraError> {
        let place = file.display().to_string();
        std::fs::File::open(file).map_err(|source| CameraError::Io { place: place.clone(), source })?;
        let text = c_string(&place)?;
        let api = &self.api;
        // SAFETY: the request and the text are valid.
        api.call(|error| unsafe {
            (api.rs2_config_enable_device_from_file_repeat_option)(self.config.get(), text.as_ptr(), 0, error)
        })
        .and_then(|()| self.enable(STREAM_COLOR, (0, 0), FORMAT_ANY, ANY))
        .and_then(|()| self.enable(STREAM_DEPTH, (0, 0), FORMAT_Z16, ANY))
        .and_then(|()| self.enable_gyro(settings))
        .map_err(|error| error.of(&place))
    }

    fn enable_gyro(&self, settings: &RealSenseSettings) -> Result<(), RealSenseError> {
        if settings.gyro { self.enable(STREAM_GYRO, (0, 0), FORMAT_MOTION_XYZ32F, ANY) } else { Ok(()) }
    }

    fn enable(
        &self,
        stream: c_int,
        (width, height): (usize, usize),
        format: c_int,
        rate: c_int,
    ) -> Result<(), RealSenseError> {
        let number = |pixels: usize| c_int::try_from(pixels).unwrap_or(c_int::MAX);
        let (width, height) = (number(width), number(height));
        // SAFETY: the request is valid.
        self.api.call(|error| unsafe {
            (self.api.rs2_config_enable_stream)(
                self.config.get(),
                stream,
                ANY_INDEX,
                width,
                height,
                format,
                rate,
                error,
            )
        })
    }
}

/// The device of a started or resolved pipeline.
pub(super) fn device_of(
    api: &Arc<RealSenseApi>,
    profile: &Handle<PipelineProfile>,
) -> Result<Handle<Device>, RealSenseError> {
    // SAFETY: the profile is valid.
    api.owned(api.rs2_delete_device, |error| unsafe {
        (api.rs2_pipeline_profile_get_device)(profile.get(), error)
    })
}

fn c_string(text: &str) -> Result<CString, CameraError> {
    CString::new(text).map_err(|_| CameraError::NoDevice { kind: text.replace('\0', "?") })
}
