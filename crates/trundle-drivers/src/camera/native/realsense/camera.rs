//! A RealSense camera.

use super::RealSenseSettings;
use super::api::RealSenseError;
use super::device_list::entry;
use super::frames::{Content, content, parts};
use super::functions::{Frame, RealSenseApi};
use super::handle::Handle;
use super::motion::GyroSamples;
use super::pairing::Pairing;
use super::request::Request;
use super::running::Running;
use crate::camera::native::{DeviceEntry, Selection};
use crate::camera::{CameraError, CameraFrame, CameraInfo, DepthCamera, GyroSample, UsbSpeed};
use std::ffi::c_int;
use std::sync::Arc;
use std::time::{Duration, Instant};
use trundle_core::Invalid;

/// Duration without frames after which a stopped recording has ended: 0.5 s. The library reports a recording as stopped before its thread
/// has started, and again before the last frames are delivered. Source: ours.
const END_SILENCE: Duration = Duration::from_millis(500);
/// Period at which the state of a recording without frames is queried. Source: ours.
const STATUS_PERIOD: Duration = Duration::from_millis(20);

/// A RealSense camera, or a recording of one.
#[derive(Debug)]
pub struct RealSenseCamera {
    info: CameraInfo,
    running: Running,
    pairing: Pairing,
    gyro: GyroSamples,
    quiet_since: Option<Instant>,
    has_ended: bool,
}

impl RealSenseCamera {
    /// Opens a camera or a recording and starts its streams. A recording is a file `.db3`, as librealsense 2.59 writes it, or `.bag`,
    /// as 2.55 does.
    ///
    /// # Errors
    /// When the camera is missing, in use, forbidden, too slow or without these streams, or its intrinsics are unusable.
    pub fn open(
        api: &Arc<RealSenseApi>,
        selection: &Selection,
        settings: &RealSenseSettings,
    ) -> Result<Self, CameraError> {
        let settings = settings.clone().checked()?;
        let request = Request::new(api, selection, &settings)?;
        let is_live = !matches!(selection, Selection::File(_));
        let about = if is_live {
            find_live(&request, selection, &settings)?
        } else {
            prepare_file(&request, selection, settings.gyro)?
        };
        let name = format!("{} {}", about.name, about.serial);
        let (running, started) = Running::start(request, is_live, settings.gyro, &name)?;
        let info = running.info(about, &started, &settings, is_live, &name)?;
        let pairing = Pairing::new(info.color.rate_hz.min(info.depth.rate_hz));
        let gyro = GyroSamples::default();
        Ok(Self { info, running, pairing, gyro, quiet_since: None, has_ended: false })
    }

    /// The next frame that is not a repetition, within `timeout`; `None` also for a sample of the gyro.
    fn wait(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        let (start, newest) = (Instant::now(), self.gyro.newest());
        loop {
            let left = timeout.saturating_sub(start.elapsed());
            let Some(set) = self.running.wait(left).map_err(|error| error.of(&self.name()))? else {
                return Ok(None);
            };
            let contents = contents(&self.running.api, set).map_err(|error| error.of(&self.name()))?;
            if let Some(frame) = self.take_contents(contents) {
                return frame.map(Some).map_err(CameraError::BrokenFrame);
            }
            if self.gyro.newest() != newest {
                return Ok(None);
            }
        }
    }

    fn take_contents(&mut self, contents: Vec<Content>) -> Option<Result<CameraFrame, Invalid>> {
        for content in &contents {
            if let Content::Gyro(sample) = content {
                self.gyro.push(*sample);
            }
        }
        self.pairing.pair(contents)
    }

    fn next_recorded(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        let start = Instant::now();
        while !self.has_ended {
            let (left, newest) = (timeout.saturating_sub(start.elapsed()), self.gyro.newest());
            if let Some(frame) = self.wait(left.min(STATUS_PERIOD))? {
                self.quiet_since = None;
                return Ok(Some(frame));
            }
            if self.gyro.newest() != newest {
                self.quiet_since = None;
                return Ok(None);
            }
            let is_stopped = self.running.is_played().map_err(|error| error.of(&self.name()))?;
            self.quiet_since = is_stopped.then(|| self.quiet_since.unwrap_or_else(Instant::now));
            self.has_ended = self.quiet_since.is_some_and(|since| since.elapsed() >= END_SILENCE);
            if left.is_zero() {
                break;
            }
        }
        Ok(None)
    }

    fn name(&self) -> String {
        format!("{} {}", self.info.name, self.info.serial)
    }
}

impl DepthCamera for RealSenseCamera {
    fn info(&self) -> &CameraInfo {
        &self.info
    }

    fn next_frame(&mut self, timeout: Duration) -> Result<Option<CameraFrame>, CameraError> {
        if !self.info.is_live {
            return self.next_recorded(timeout);
        }
        let newest = self.gyro.newest();
        match self.wait(timeout)? {
            Some(frame) => Ok(Some(frame)),
            None if self.gyro.newest() != newest => Ok(None),
            None if self.running.is_unplugged().map_err(|error| error.of(&self.name()))? => {
                Err(CameraError::Unplugged { device: self.name() })
            }
            None => Ok(None),
        }
    }

    fn take_gyro(&mut self) -> Vec<GyroSample> {
        self.gyro.take()
    }

    fn has_ended(&self) -> bool {
        self.has_ended
    }
}

/// Copies of the frames in a set.
fn contents(api: &Arc<RealSenseApi>, set: Handle<Frame>) -> Result<Vec<Content>, RealSenseError> {
    parts(api, set)?.iter().map(|part| content(api, part)).collect()
}

/// Finds a connected camera that offers the streams.
fn find_live(
    request: &Request,
    selection: &Selection,
    settings: &RealSenseSettings,
) -> Result<DeviceEntry, CameraError> {
    let devices = super::list_devices(&request.api)?;
    let found = match selection {
        Selection::Serial(serial) => devices.into_iter().find(|device| device.serial == *serial),
        _ => devices.into_iter().next(),
    };
    let device = found.ok_or_else(|| CameraError::NoDevice { kind: selection.describe("RealSense") })?;
    if request.can_resolve().map_err(|error| error.of(&device.name))? {
        return Ok(device);
    }
    Err(unavailable(device, settings))
}

fn unavailable(device: DeviceEntry, settings: &RealSenseSettings) -> CameraError {
    let name = format!("{} {}", device.name, device.serial);
    match device.usb {
        Some(speed) if speed < UsbSpeed::Super => CameraError::UsbTooSlow { device: name, speed },
        _ => CameraError::StreamsUnavailable {
            device: name,
            wanted: settings.streams(),
            remedy: "choose a size and rate that 'rs-enumerate-devices' lists".into(),
        },
    }
}

/// Makes a recording wait for its reader, and for the start of all its sensors: the library drops earlier data. With `own_pace`, it is
/// played at the pace of its stamps, and a busy computer loses images and samples: waiting for the reader of single frames stops the
/// library's synchronisation for good.
fn prepare_file(
    request: &Request,
    selection: &Selection,
    own_pace: bool,
) -> Result<DeviceEntry, CameraError> {
    let name = selection.describe("RealSense");
    let prepared = request.resolved_device().and_then(|device| {
        // SAFETY: the device is valid and a recording.
        request.api.call(|error| unsafe {
            (request.api.rs2_playback_device_set_real_time)(device.get(), c_int::from(own_pace), error)
        })?;
        // SAFETY: as above.
        request.api.call(|error| unsafe { (request.api.rs2_playback_device_pause)(device.get(), error) })?;
        entry(&request.api, &device)
    });
    prepared.map_err(|error| error.of(&name))
}
