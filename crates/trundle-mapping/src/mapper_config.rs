use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// How scans become a map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MapperConfig {
    /// Side of a cell, m, 0.005 to 1. Default 0.05.
    pub resolution: f64,
    /// Log-odds that a hit adds, 0.01 to 10. Default 0.85: p = 0.7 (OctoMap, Hornung et al. 2013).
    pub hit: f64,
    /// Log-odds that passing freely takes away, 0.01 to 10. Default 0.4: p = 0.4 (as above).
    pub free: f64,
    /// Log-odds never rise above this, 0.1 to 100. Default 3.5: p = 0.97 (as above), so that what moved is forgotten.
    pub clamp_high: f64,
    /// Log-odds never fall below minus this, 0.1 to 100. Default 2: p = 0.12 (as above).
    pub clamp_low: f64,
    /// Occupied above this probability, 0.5 to 1. Default 0.65 (map_server).
    pub occupied_above: f64,
    /// Free below this probability, 0 to 0.5. Default 0.196 (map_server).
    pub free_below: f64,
    /// Beams are cut at this range, m, 0.1 to 200. Default 12.
    pub max_range: f64,
    /// Nearer than this to the sensor, a beam clears only what was not thought occupied, and nothing behind that, m, 0 to 10: there
    /// a low obstacle hides under the field of view and a seat is too near to be seen, and the map alone remembers them. Default 0.65: a Kinect V2, 0.45 m high,
    /// 8 deg down; take `DepthScanner::blind_range`. 0 for a laser.
    pub blind_range: f64,
    /// Neighbouring hits at most so far apart are one surface, and what lies between them on it is not cleared by beams that
    /// graze it, m, 0 (off) to 2. Default 0.3.
    pub surface_gap: f64,
    /// The map reaches this far from its origin along x and y, m, 1 to 2000 and at most 23000 cells; what is farther is
    /// ignored. Default 500.
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
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names, or a clamp cannot reach its threshold.
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
        let most_cells = MOST_CELLS_ACROSS / 2.0 * self.resolution;
        require_in("half_extent", self.half_extent, "m", 1.0, most_cells.min(2000.0))?;
        Ok(self)
    }
}

/// So that a grid of the whole extent, in whole tiles, has fewer than 2^31 cells.
const MOST_CELLS_ACROSS: f64 = 46_000.0;

/// p of ln(p / (1 - p)).
pub(crate) fn probability(log_odds: f64) -> f64 {
    1.0 / (1.0 + (-log_odds).exp())
}

/// ln(p / (1 - p)).
pub(crate) fn log_odds(probability: f64) -> f64 {
    (probability / (1.0 - probability)).ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_that_no_cell_can_reach_are_refused() {
        let config = MapperConfig { clamp_low: 1.0, ..MapperConfig::default() };
        assert_eq!(config.validated().unwrap_err().field, "free_below");
        assert!(MapperConfig::default().validated().is_ok());
        assert!((log_odds(probability(1.3)) - 1.3).abs() < 1e-12);
    }
}
