//! Settings of a RealSense camera.

use std::path::PathBuf;
use trundle_core::{Invalid, require_in};

/// Columns and rows of both streams \[px\]. Source: ours; the only size that the D415, D435 and D455 offer for both streams at 30 Hz over
/// USB 2 and USB 3.
const DEFAULT_SIZE_PX: (usize, usize) = (640, 480);
/// Frames per second \[Hz\]. Source: ours, the rate of the Kinect V2.
const DEFAULT_RATE_HZ: u32 = 30;
/// Time from the middle of the exposure to the arrival of a frame \[s\]. Source: ours, assumed: half an exposure of 8 ms, one frame of
/// readout and depth computation, transfer. Measure the delay if it matters.
const DEFAULT_DELAY_S: f64 = 0.045;
/// Longest delay: 1 s. A longer one is refused. Source: ours, the limit of a camera stream.
const MAX_DELAY_S: f64 = 1.0;

/// Settings to request from a RealSense camera. A recording has its own sizes and rates.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RealSenseSettings {
    /// Columns and rows of the colour image \[px\]. Default 640 x 480.
    pub color_size: (usize, usize),
    /// Columns and rows of the depth image \[px\]. Default 640 x 480.
    pub depth_size: (usize, usize),
    /// Frames per second of both \[Hz\]. Default 30.
    pub rate_hz: u32,
    /// Whether to read the gyro of a D435i or D455, each sample of it. A recording is then played at its own pace. Default `false`.
    pub gyro: bool,
    /// Time from the middle of the exposure to the arrival of a frame \[s\], 0 to 1. Default 0.045, assumed.
    pub delay_s: f64,
    /// File of the library; `None` if it is searched.
    pub library: Option<PathBuf>,
}

impl Default for RealSenseSettings {
    fn default() -> Self {
        Self {
            color_size: DEFAULT_SIZE_PX,
            depth_size: DEFAULT_SIZE_PX,
            rate_hz: DEFAULT_RATE_HZ,
            gyro: false,
            delay_s: DEFAULT_DELAY_S,
            library: None,
        }
    }
}

impl RealSenseSettings {
    /// Passes valid settings through.
    ///
    /// # Errors
    /// When the delay is outside 0 to 1 s.
    pub fn checked(self) -> Result<Self, Invalid> {
        require_in("delay_s", self.delay_s, "s", 0.0, MAX_DELAY_S)?;
        Ok(self)
    }

    /// The streams in words.
    pub(super) fn streams(&self) -> String {
        let ((cw, ch), (dw, dh), rate) = (self.color_size, self.depth_size, self.rate_hz);
        let gyro = if self.gyro { ", and a gyro" } else { "" };
        format!("colour {cw} x {ch} rgb8 with depth {dw} x {dh} z16 at {rate} Hz{gyro}")
    }
}
