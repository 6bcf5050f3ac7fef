//! Settings of the inverse sensor model and of the extent of a map.

use crate::log_odds::probability;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Inverse sensor model, classification thresholds and extent of an occupancy map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct MapperConfig {
    /// Side of a cell, m, 0.005 to 1. Smaller cells show more detail and take more memory and time. Default 0.05 (ours).
    pub resolution: f64,
    /// Log-odds added by a hit, 0.01 to 10. A larger value draws new obstacles sooner, also false ones. Default 0.85: p = 0.7 (OctoMap,
    /// Hornung et al. 2013).
    pub hit: f64,
    /// Log-odds subtracted by a free ray, 0.01 to 10. A larger value clears moved obstacles sooner, also thin ones. Default 0.4: p = 0.4
    /// (OctoMap).
    pub free: f64,
    /// Maximum of the log-odds, 0.1 to 100. The clamp lets the map drop obstacles that moved; a smaller value drops them sooner. Default
    /// 3.5: p = 0.97 (OctoMap).
    pub clamp_high: f64,
    /// Minimum of the log-odds, negated, 0.1 to 100. Default 2: p = 0.12 (OctoMap).
    pub clamp_low: f64,
    /// Probability above which a cell is published as occupied, 0.5 to 1. Default 0.65 (map_server).
    pub occupied_above: f64,
    /// Probability below which a cell is published as free, 0 to 0.5. Default 0.196 (map_server).
    pub free_below: f64,
    /// Maximum range of a ray, m, 0.1 to 200. Longer rays are truncated. Default 12 (ours).
    pub max_range: f64,
    /// Blind range about the sensor, m, 0 to 10. Within the blind range a ray clears no cell with positive log-odds, and no cell behind
    /// such a cell: a low obstacle hides below the field of view there. Default 0.65: a Kinect V2, 0.45 m high, 8 deg down.
    /// `DepthScanner::blind_range` computes the value of a camera mount; a laser has 0.
    pub blind_range: f64,
    /// Maximum distance of two neighbouring hits on one surface, m, 0 (off) to 2. Cells between the two hits are not cleared by
    /// grazing rays. Default 0.3 (ours).
    pub surface_gap: f64,
    /// Maximum extent of the map from its origin along x and along y, m, 1 to 2000 and at most 23000 cells. Rays that end beyond it
    /// are ignored. Default 500 (ours).
    pub half_extent: f64,
}

impl Default for MapperConfig {
    fn default() -> Self {
        Self {
            resolution: 0.05,
            hit: 0.85,
            free: 0.4,
            clamp_high: 3.5,
            clamp_low: 2.0,
            occupied_above: 0.65,
            free_below: 0.196,
            max_range: 12.0,
            blind_range: 0.65,
            surface_gap: 0.3,
            half_extent: 500.0,
        }
    }
}

impl MapperConfig {
    /// The same map with cells of another side, m, and the extent that such cells allow.
    #[must_use]
    pub fn with_resolution(self, resolution: f64) -> Self {
        let half_extent = self.half_extent.min(MAX_CELLS_ACROSS / 2.0 * resolution);
        Self { resolution, half_extent, ..self }
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a value is outside the range documented at its field, or a clamp does not reach its threshold.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("resolution", self.resolution, "m", 0.005, 1.0)?;
        require_in("hit", self.hit, "", 0.01, 10.0)?;
        require_in("free", self.free, "", 0.01, 10.0)?;
        require_in("clamp_high", self.clamp_high, "", 0.1, 100.0)?;
        require_in("clamp_low", self.clamp_low, "", 0.1, 100.0)?;
        require_in("occupied_above", self.occupied_above, "", 0.5, probability(self.clamp_high))?;
        require_in("free_below", self.free_below, "", probability(-self.clamp_low), 0.5)?;
        require_in("max_range", self.max_range, "m", 0.1, 200.0)?;
        require_in("blind_range", self.blind_range, "m", 0.0, 10.0)?;
        require_in("surface_gap", self.surface_gap, "m", 0.0, 2.0)?;
        let max_half_extent_m = MAX_CELLS_ACROSS / 2.0 * self.resolution;
        require_in("half_extent", self.half_extent, "m", 1.0, max_half_extent_m.min(2000.0))?;
        Ok(self)
    }
}

/// Maximum width of a map \[cells\]. A wider map could have 2^31 cells or more, beyond `GridGeometry`'s limit. Source: ours.
const MAX_CELLS_ACROSS: f64 = 46_000.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_that_no_cell_can_reach_are_refused() {
        let low = MapperConfig { clamp_low: 1.0, ..MapperConfig::default() };
        assert_eq!(low.validated().unwrap_err().field, "free_below");
        let high = MapperConfig { clamp_high: 0.5, ..MapperConfig::default() };
        assert_eq!(high.validated().unwrap_err().field, "occupied_above");
        assert!(MapperConfig::default().validated().is_ok());
    }

    #[test]
    fn fine_cells_are_accepted_with_the_extent_that_they_allow() {
        let fine = MapperConfig::default().with_resolution(0.01).validated().unwrap();
        assert_eq!((fine.resolution, fine.half_extent), (0.01, 230.0));
        assert_eq!(MapperConfig::default().with_resolution(0.05), MapperConfig::default());
    }

    #[test]
    fn a_map_of_more_cells_than_can_be_counted_is_refused() {
        let wide = MapperConfig { resolution: 0.005, half_extent: 500.0, ..MapperConfig::default() };
        assert_eq!(wide.validated().unwrap_err().field, "half_extent");
    }
}
