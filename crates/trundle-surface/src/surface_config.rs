//! Size of the voxels, range of the camera, and trust in its depth.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Settings of a [`SurfaceMap`](crate::SurfaceMap).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct SurfaceConfig {
    /// Side of a voxel, m, 0.004 to 0.5. Default 0.02. Half of it needs four times the memory.
    pub voxel: f64,
    /// Distance from a surface up to which voxels are updated, in voxels, 2 to 16; 0.06 m at least. Default 4. Larger: thin walls lose one side.
    pub truncation_voxels: f64,
    /// Smallest depth that counts, m, 0.05 to 5. Default 0.4 (ours): nearer, depth cameras err.
    pub min_depth: f64,
    /// Largest depth that counts, m, above `min_depth`, to 30. Default 5 (ours): the noise of a Kinect is 2 cm there.
    pub max_depth: f64,
    /// Smallest weight of a surface point, 1 to 100. An image at 2 m or farther weighs 1, one at 0.5 m 16. Default 2 (ours).
    pub min_weight: u16,
}

/// Smallest distance from a surface up to which voxels are updated \[m\]: three sigmas of a Kinect's depth at 5 m. Source:
/// \[Khoshelham12\].
const MIN_TRUNCATION_M: f64 = 0.06;

impl Default for SurfaceConfig {
    fn default() -> Self {
        Self { voxel: 0.02, truncation_voxels: 4.0, min_depth: 0.4, max_depth: 5.0, min_weight: 2 }
    }
}

impl SurfaceConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("voxel", self.voxel, "m", 0.004, 0.5)?;
        require_in("truncation_voxels", self.truncation_voxels, "voxels", 2.0, 16.0)?;
        require_in("min_depth", self.min_depth, "m", 0.05, 5.0)?;
        require_in("max_depth", self.max_depth, "m", self.min_depth, 30.0)?;
        require_in("min_weight", f64::from(self.min_weight), "", 1.0, 100.0)?;
        Ok(self)
    }

    /// Distance from a surface up to which voxels are updated, m.
    pub(crate) fn truncation(&self) -> f64 {
        (self.voxel * self.truncation_voxels).max(MIN_TRUNCATION_M)
    }
}
