//! Settings of the landmark map.

use serde::{Deserialize, Serialize};
use trundle_core::Invalid;
use trundle_optim::BundleConfig;

/// How the landmark map grows and is refined.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LocalMappingConfig {
    /// Features with depth that a first keyframe needs, 10 or more. Default 50: fewer do not make a map.
    pub min_points: usize,
    /// Keyframes that a local bundle adjustment moves, 1 or more. Default 10: enough to see a landmark age.
    pub local_keyframes: usize,
    /// Keyframes that hold them in place. Default 10.
    pub fixed_keyframes: usize,
    /// Keyframes in which new landmarks are searched at once. Default 10 \[MurArtal17\].
    pub fused_keyframes: usize,
    /// Number of further keyframes after which a landmark seen by only one keyframe is removed. Default 3 \[MurArtal17\].
    pub trial_keyframes: usize,
    /// Frames in which a landmark should have been seen before it is evaluated. Default 10.
    pub trial_frames: u32,
    /// Part of these in which it must have been found, 0 to 1. Default 0.25 \[MurArtal17\].
    pub found_ratio: f64,
    /// The solver. Default 5 steps.
    pub bundle: BundleConfig,
    /// How much of the refining of the map is done between one frame and the next, in operations of some 20 ns, 1 or more.
    /// Default 100,000: 2 ms. Never more than a tenth of a ms beyond it, but for taking a result over.
    pub work_per_frame: usize,
}

impl Default for LocalMappingConfig {
    fn default() -> Self {
        Self {
            min_points: 50,
            local_keyframes: 10,
            fixed_keyframes: 10,
            fused_keyframes: 10,
            trial_keyframes: 3,
            trial_frames: 10,
            found_ratio: 0.25,
            bundle: BundleConfig { steps: 5, ..BundleConfig::default() },
            work_per_frame: 100_000,
        }
    }
}

impl LocalMappingConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names.
    pub fn validated(mut self) -> Result<Self, Invalid> {
        if self.min_points < 10 {
            return Err(Invalid::new("mapping.min_points", self.min_points, "", "10 or more"));
        }
        let counts = [
            ("mapping.local_keyframes", self.local_keyframes),
            ("mapping.work_per_frame", self.work_per_frame),
        ];
        if let Some((name, _)) = counts.iter().find(|(_, count)| *count == 0) {
            return Err(Invalid::new(*name, 0, "", "1 or more"));
        }
        trundle_core::require_in("mapping.found_ratio", self.found_ratio, "", 0.0, 1.0)?;
        self.bundle = self.bundle.validated()?;
        Ok(self)
    }
}
