//! All settings of the RGB-D SLAM.

use crate::frame::depth::DepthConfig;
use crate::local_mapping::config::LocalMappingConfig;
use crate::local_mapping::keyframe_policy::KeyframeConfig;
use crate::loop_closing::config::LoopConfig;
use crate::motion::motion_model::MotionModelConfig;
use crate::tracking::config::TrackingConfig;
use serde::{Deserialize, Serialize};
use trundle_core::Invalid;
use trundle_vision::OrbConfig;

/// Everything that can be set about the RGB-D SLAM.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SlamConfig {
    /// Features.
    pub orb: OrbConfig,
    /// Depth camera.
    pub depth: DepthConfig,
    /// Finding the pose of a frame.
    pub tracking: TrackingConfig,
    /// Uncertainty of what is not seen.
    pub motion: MotionModelConfig,
    /// When a frame becomes a keyframe.
    pub keyframes: KeyframeConfig,
    /// The landmark map.
    pub mapping: LocalMappingConfig,
    /// Places seen again.
    pub loops: LoopConfig,
    /// Seed of the random samples. Default 0.
    pub seed: u64,
    /// Frames whose poses are kept, the newest ones, 1 or more. Default 108,000: an hour at 30 Hz, some 10 MB.
    pub kept_frames: usize,
}

impl Default for SlamConfig {
    fn default() -> Self {
        Self {
            orb: OrbConfig::default(),
            depth: DepthConfig::default(),
            tracking: TrackingConfig::default(),
            motion: MotionModelConfig::default(),
            keyframes: KeyframeConfig::default(),
            mapping: LocalMappingConfig::default(),
            loops: LoopConfig::default(),
            seed: 0,
            kept_frames: 108_000,
        }
    }
}

impl SlamConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names.
    pub fn validated(self) -> Result<Self, Invalid> {
        if self.kept_frames == 0 {
            return Err(Invalid::new("slam.kept_frames", 0, "", "1 or more"));
        }
        Ok(Self {
            orb: self.orb.validated()?,
            depth: self.depth.validated()?,
            tracking: self.tracking.validated()?,
            motion: self.motion.validated()?,
            keyframes: self.keyframes.validated()?,
            mapping: self.mapping.validated()?,
            loops: self.loops.validated()?,
            ..self
        })
    }
}
