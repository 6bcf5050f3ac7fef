//! Settings of the scan from depth.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Rules that classify pixels of a depth image as obstacles or free space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct DepthScanConfig {
    /// Lower edge of the height band, m above the floor, 0 to 1. Lower objects are no obstacles: the robot drives over them. Default 0.05 (ours).
    pub band_low: f64,
    /// Upper edge of the height band, m above the floor, above `band_low`, to 5. Higher objects are no obstacles: the robot drives under
    /// them. Default 0.65: a Kobuki with its camera is 0.6 m high.
    pub band_high: f64,
    /// Smallest depth used, m, 0.05 to 5. Pixels below it are ignored. Default 0.3 (ours): the Kinect V2 measures from 0.5 m on \[Li18\].
    pub min_depth: f64,
    /// Largest depth used, m, above `min_depth`, to 100. Pixels beyond it are ignored. Default 8: the Kinect V2's range \[Li18\].
    pub max_depth: f64,
    /// Largest range of a beam over the floor, m, 0.5 to 100. A larger value maps farther with more noise. Default 6: beyond it a pixel is
    /// wider than a chair leg.
    pub max_range: f64,
    /// Depth noise (one sigma) at the camera, m, 0 to 0.1. Default 0.003 (ours).
    pub noise_base: f64,
    /// Growth of the depth noise with depth squared, m / m^2, 0 to 0.1. Default 0.0015: about the Kinects' (0.0019
    /// for the first, Khoshelham and Elberink 2012; less for the second).
    pub noise_growth: f64,
    /// Height of the lowest obstacle above the floor, in sigmas of the depth noise, 0 to 10. A smaller value detects lower obstacles and gives
    /// false ones. Default 3 (ours).
    pub floor_sigmas: f64,
    /// Largest error of the camera's tilt at which the floor is no obstacle, deg, 0 to 10. A larger value hides low obstacles far away. If
    /// a floor is fitted, the error bound of the fit applies when smaller. Default 1: a soft tyre, a hard stop.
    pub tilt_error_deg: f64,
    /// Largest tilt of a fitted floor against the mount's floor, deg, 0 (no fit) to 10. Heights are measured from the fitted floor. Default
    /// 3 (ours).
    pub floor_fit_deg: f64,
    /// Smallest depth below the floor at which a point is a hole, m, 0.02 to 1. The robot stops before a hole as before an obstacle. Default 0.1:
    /// a Kobuki's wheel drops 0.04.
    pub drop_depth: f64,
    /// Smallest number of a pixel's 8 neighbours with similar depth for an obstacle, 0 to 8. A larger value drops noise and thin objects.
    /// Default 3: a line of flying pixels along an edge, one pixel wide, has two.
    pub hit_support_px: u8,
    /// Smallest number of a pixel's 8 neighbours with similar depth for free space, 0 to 8. Default 2: of a floor at a grazing angle only
    /// the pixels of one row agree.
    pub free_support_px: u8,
}

impl Default for DepthScanConfig {
    fn default() -> Self {
        Self {
            band_low: 0.05,
            band_high: 0.65,
            min_depth: 0.3,
            max_depth: 8.0,
            max_range: 6.0,
            noise_base: 0.003,
            noise_growth: 0.0015,
            floor_sigmas: 3.0,
            tilt_error_deg: 1.0,
            floor_fit_deg: 3.0,
            drop_depth: 0.1,
            hit_support_px: 3,
            free_support_px: 2,
        }
    }
}

impl DepthScanConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("band_low", self.band_low, "m", 0.0, 1.0)?;
        require_in("band_high", self.band_high, "m", self.band_low + 0.01, 5.0)?;
        require_in("min_depth", self.min_depth, "m", 0.05, 5.0)?;
        require_in("max_depth", self.max_depth, "m", self.min_depth + 0.01, 100.0)?;
        require_in("max_range", self.max_range, "m", 0.5, 100.0)?;
        require_in("noise_base", self.noise_base, "m", 0.0, 0.1)?;
        require_in("noise_growth", self.noise_growth, "m/m^2", 0.0, 0.1)?;
        require_in("floor_sigmas", self.floor_sigmas, "", 0.0, 10.0)?;
        require_in("tilt_error_deg", self.tilt_error_deg, "deg", 0.0, 10.0)?;
        require_in("floor_fit_deg", self.floor_fit_deg, "deg", 0.0, 10.0)?;
        require_in("drop_depth", self.drop_depth, "m", 0.02, 1.0)?;
        require_in("hit_support_px", f64::from(self.hit_support_px), "px", 0.0, 8.0)?;
        require_in("free_support_px", f64::from(self.free_support_px), "px", 0.0, 8.0)?;
        Ok(self)
    }
}
