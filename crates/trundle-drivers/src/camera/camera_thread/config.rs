//! Parts of a camera thread, and its settings.

use super::StampMapFactory;
use crate::camera::{CameraError, DepthCamera};
use nalgebra::UnitQuaternion;
use std::sync::Arc;
use trundle_core::{Invalid, PinholeCamera, SensorEvent, Stamp, require_in};

/// Opens the camera. It is called again after the camera was lost.
pub type CameraFactory = Box<dyn FnMut() -> Result<Box<dyn DepthCamera>, CameraError> + Send>;
/// Receives images and link events. It is called from two threads, never at the same time.
pub type EventSink = Box<dyn FnMut(SensorEvent) + Send>;
/// The time of the host on the sensors' clock.
pub type HostClock = Arc<dyn Fn() -> Stamp + Send + Sync>;

/// The parts of a camera thread.
pub struct CameraThreadParts {
    /// Opens the camera.
    pub factory: CameraFactory,
    /// Receives images and link events.
    pub sink: EventSink,
    /// The time of the host.
    pub clock: HostClock,
    /// Maps the camera's stamps to the sensors' clock, anew for each opening of the camera. [`super::default_stamps`] is the simplest.
    pub stamps: StampMapFactory,
}

/// Settings of a camera thread.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct CameraThreadConfig {
    /// Silence after which the camera counts as lost \[s\], 0.1 to 60. Default 1. Source: ours; 30 frames at 30 Hz, and the base stops a
    /// robot whose commands fail for that long.
    pub max_silence_s: f64,
    /// Wait before the first attempt to open a lost camera \[s\], 0.001 to 60. It doubles with each attempt. Default 0.2. Source: ours.
    pub min_reopen_wait_s: f64,
    /// Longest wait between attempts \[s\], 0.001 to 60. Default 5. Source: ours; a camera takes 2 s to appear on USB.
    pub max_reopen_wait_s: f64,
    /// Whether images carry noise, so that equal bytes mean a stuck camera. Default `true`; `false` for a simulator.
    pub expects_noise: bool,
    /// The camera that the robot works with, at the place of the colour camera. Default `None`: the colour camera itself.
    pub output: Option<PinholeCamera>,
    /// Rotation of the colour camera on the base, optical frame, by which the samples of the camera's gyro become turns of the base. Default
    /// `None`: the samples are not used, as by a base with a gyro of its own.
    pub gyro: Option<UnitQuaternion<f64>>,
}

impl Default for CameraThreadConfig {
    fn default() -> Self {
        Self {
            max_silence_s: 1.0,
            min_reopen_wait_s: 0.2,
            max_reopen_wait_s: 5.0,
            expects_noise: true,
            output: None,
            gyro: None,
        }
    }
}

impl CameraThreadConfig {
    /// The settings, each in its range.
    ///
    /// # Errors
    /// Names the number that is not.
    pub fn checked(self) -> Result<Self, Invalid> {
        require_in("max_silence_s", self.max_silence_s, "s", 0.1, 60.0)?;
        require_in("min_reopen_wait_s", self.min_reopen_wait_s, "s", 0.001, 60.0)?;
        require_in("max_reopen_wait_s", self.max_reopen_wait_s, "s", self.min_reopen_wait_s, 60.0)?;
        Ok(self)
    }
}
