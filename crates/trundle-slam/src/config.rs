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

/// Smallest limit of an image's longest side: 320 px. Smaller images hold too few features. Source: ours.
const MIN_SIDE_PX: usize = 320;

/// All settings of the RGB-D SLAM.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct SlamConfig {
    /// Features.
    pub orb: OrbConfig,
    /// Longest side of an image that is tracked at full size, px, 320 or more. Larger images are reduced by a whole factor: a smaller
    /// number takes less time, a larger one uses finer detail. Default 960: search windows and numbers of features are those of 640 x 480.
    pub max_side_px: usize,
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
    /// Seed of the random samples, 0 or more. Default 0 (ours): any number serves.
    pub seed: u64,
    /// Number of newest frames whose poses are kept, 1 or more. A larger number keeps a longer trajectory, of some 100 bytes per frame.
    /// Default 108,000: an hour at 30 Hz.
    pub kept_frames: usize,
}

impl Default for SlamConfig {
    fn default() -> Self {
        Self {
            orb: OrbConfig::default(),
            max_side_px: 960,
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
        if self.max_side_px < MIN_SIDE_PX {
            let expected = format!("{MIN_SIDE_PX} or more");
            return Err(Invalid::new("slam.max_side_px", self.max_side_px, "px", expected));
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
