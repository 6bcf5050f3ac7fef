//! Settings of the landmark map.

use serde::{Deserialize, Serialize};
use trundle_core::Invalid;
use trundle_optim::BundleConfig;

/// Growth and refinement of the landmark map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct LocalMappingConfig {
    /// Smallest number of features with depth in the first keyframe of a map, 10 or more. A larger number delays the start of a map.
    /// Default 50 (ours).
    pub min_points: usize,
    /// Number of keyframes that a local bundle adjustment moves, 1 or more. More take longer. Default 10 (ours): a landmark is in view for
    /// about as many.
    pub local_keyframes: usize,
    /// Number of keyframes that a local bundle adjustment keeps fixed around the moved ones, 0 or more. More hold them more firmly and take longer.
    /// Default 10 (ours).
    pub fixed_keyframes: usize,
    /// Number of neighbouring keyframes in which the landmarks of a new keyframe are searched, 0 or more. More find more observations and take longer.
    /// Default 10 \[MurArtal17\].
    pub fused_keyframes: usize,
    /// Number of further keyframes, 0 or more, after which a landmark seen by only one keyframe is removed. Default 3 \[MurArtal17\].
    pub trial_keyframes: usize,
    /// Number of frames, 0 or more, in which a landmark is expected before `found_ratio` is applied. Default 10 (ours).
    pub trial_frames: u32,
    /// Smallest fraction of the frames where a landmark is expected in which it is found, 0 to 1. Below it the landmark is removed. Default
    /// 0.25 \[MurArtal17\].
    pub found_ratio: f64,
    /// The solver. Default 5 steps.
    pub bundle: BundleConfig,
    /// Work on bundle adjustment per frame, in counted operations of some 20 ns, 1 or more. A larger number refines the map sooner and
    /// makes each frame slower. Default 100,000: 2 ms.
    pub work_per_frame: usize,
}

impl Default for LocalMappingConfig {
    fn default() -> Self {
        let mut bundle = BundleConfig::default();
        bundle.steps = 5;
        Self {
            min_points: 50,
            local_keyframes: 10,
            fixed_keyframes: 10,
            fused_keyframes: 10,
            trial_keyframes: 3,
            trial_frames: 10,
            found_ratio: 0.25,
            bundle,
            work_per_frame: 100_000,
        }
    }
}

impl LocalMappingConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
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
