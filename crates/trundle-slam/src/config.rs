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

/// All settings of the RGB-D SLAM.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SlamConfig {
    /// Features.
    pub orb: OrbConfig,
    /// Depth camera.
    pub depth: DepthConfig,
    /// Pose of a frame.
    pub tracking: TrackingConfig,
    /// Uncertainty of unobserved motion.
    pub motion: MotionModelConfig,
    /// Selection of keyframes.
    pub keyframes: KeyframeConfig,
    /// The landmark map.
    pub mapping: LocalMappingConfig,
    /// Loop closing.
    pub loops: LoopConfig,
    /// Seed of the random samples. Default 0.
    pub seed: u64,
    /// Number of newest frames whose poses are kept, 1 or more. A larger number keeps a longer trajectory, of some 100 bytes per frame.
    /// Default 108,000: an hour at 30 Hz.
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
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
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
