//! Settings of RANSAC.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in, require_positive};

/// How [`estimate_rigid_motion`](crate::estimate_rigid_motion) separates right pairs from wrong ones.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct RansacConfig {
    /// Chance to have drawn a sample of right pairs only at which the search ends, above 0, below 1. Default 0.999.
    pub confidence: f64,
    /// Samples at most, 1 or more. Default 1000: sure enough (0.999) down to one right pair in five.
    pub max_iterations: usize,
    /// Fewest inliers of a motion, 3 or more. Default 12: chance matches agree less often.
    pub min_inliers: usize,
    /// Standard deviation of a keypoint moved into the other image, px, positive. Default 1.5: a corner of the middle
    /// octaves.
    pub pixel_sigma: f64,
    /// Standard deviation of a depth close by, m, positive. Default 0.004: an uneven surface under a corner.
    pub depth_sigma: f64,
    /// Growth of the standard deviation of a depth with the square of the depth, 1/m, 0 or more. Default 0.002:
    /// 1.4e-3 \[Khoshelham12\] for the Kinect, and some for what else is wrong.
    pub depth_sigma_per_m2: f64,
}

impl Default for RansacConfig {
    fn default() -> Self {
        Self {
            confidence: 0.999,
            max_iterations: 1000,
            min_inliers: 12,
            pixel_sigma: 1.5,
            depth_sigma: 0.004,
            depth_sigma_per_m2: 0.002,
        }
    }
}

impl RansacConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        if !(self.confidence > 0.0 && self.confidence < 1.0) {
            return Err(Invalid::new("ransac.confidence", self.confidence, "", "above 0, below 1"));
        }
        require_in("ransac.max_iterations", self.max_iterations as f64, "", 1.0, 1e9)?;
        require_in("ransac.min_inliers", self.min_inliers as f64, "", 3.0, 1e9)?;
        require_positive("ransac.pixel_sigma", self.pixel_sigma, "px")?;
        require_positive("ransac.depth_sigma", self.depth_sigma, "m")?;
        require_in("ransac.depth_sigma_per_m2", self.depth_sigma_per_m2, "1/m", 0.0, 1.0)?;
        Ok(self)
    }

    /// Standard deviation of a `depth` (m), m.
    pub(crate) fn sigma_of_depth(&self, depth: f64) -> f64 {
        self.depth_sigma + self.depth_sigma_per_m2 * depth * depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn broken_configurations_are_refused_by_name() {
        let refused = |config: RansacConfig| config.validated().unwrap_err().field;
        let good = RansacConfig::default;
        assert_eq!(refused(RansacConfig { confidence: 1.0, ..good() }), "ransac.confidence");
        assert_eq!(refused(RansacConfig { max_iterations: 0, ..good() }), "ransac.max_iterations");
        assert_eq!(refused(RansacConfig { min_inliers: 2, ..good() }), "ransac.min_inliers");
        assert_eq!(refused(RansacConfig { pixel_sigma: -1.0, ..good() }), "ransac.pixel_sigma");
        assert_eq!(refused(RansacConfig { depth_sigma: f64::NAN, ..good() }), "ransac.depth_sigma");
        assert_eq!(refused(RansacConfig { depth_sigma_per_m2: -1.0, ..good() }), "ransac.depth_sigma_per_m2");
        assert!(good().validated().is_ok());
    }
}
