//! Settings of the scan matcher.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Alignment of a scan with the map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct ScanMatchConfig {
    /// Largest error of the guess along x and along y, m, 0 to 1. A larger window corrects larger errors, takes longer, and is less safe
    /// among similar walls. Default 0.15 (ours).
    pub window: f64,
    /// Largest error of the guess's heading, deg, 0 to 45. Default 6 (ours).
    pub window_deg: f64,
    /// Step of the coarse search in position, m, 0.005 to 0.5. A smaller step takes longer. Default 0.05: the map's resolution.
    pub step: f64,
    /// Step of the coarse search in heading, deg, 0.05 to 10. Default 2: 0.1 m at 3 m.
    pub step_deg: f64,
    /// Sigma of the likelihood field of the search, m, 0.01 to 1. Default 0.1: two steps.
    pub search_sigma: f64,
    /// Sigma of the kernels of the refinement, m, 0.01 to 1. Default 0.06: a little more than a cell, so that a row of
    /// cells makes a smooth wall.
    pub kernel_sigma: f64,
    /// Smallest distance of two hits that both count, m, 0.001 to 1. Default 0.05 (ours).
    pub spacing: f64,
    /// Smallest number of hits on known ground, 3 to 10000. With fewer the scan is not matched. Default 30 (ours).
    pub min_points: usize,
    /// Smallest fraction of the hits on known ground that the map explains, 0 to 1. Below it the match is refused. Default 0.6 (ours): two
    /// thirds of a perfect fit, which has 0.9.
    pub min_score: f64,
    /// Fraction of the hits' information below which a direction is degenerate, 0 to 1. A degenerate direction keeps the guess. Default
    /// 0.05 (ours).
    pub degenerate_below: f64,
    /// Factor on the sigmas of a match, relative to independent hits with the kernel's sigma, 1 to 100. A larger factor gives matches less
    /// weight in localization. Default 3: errors of one wall's hits are correlated.
    pub inflation: f64,
    /// Sigma of a degenerate direction, m, 0.1 to 100. Default 1: the scan does not determine it.
    pub unknown_sigma: f64,
}

impl Default for ScanMatchConfig {
    fn default() -> Self {
        Self {
            window: 0.15,
            window_deg: 6.0,
            step: 0.05,
            step_deg: 2.0,
            search_sigma: 0.1,
            kernel_sigma: 0.06,
            spacing: 0.05,
            min_points: 30,
            min_score: 0.6,
            degenerate_below: 0.05,
            inflation: 3.0,
            unknown_sigma: 1.0,
        }
    }
}

impl ScanMatchConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("window", self.window, "m", 0.0, 1.0)?;
        require_in("window_deg", self.window_deg, "deg", 0.0, 45.0)?;
        require_in("step", self.step, "m", 0.005, 0.5)?;
        require_in("step_deg", self.step_deg, "deg", 0.05, 10.0)?;
        require_in("search_sigma", self.search_sigma, "m", 0.01, 1.0)?;
        require_in("kernel_sigma", self.kernel_sigma, "m", 0.01, 1.0)?;
        require_in("spacing", self.spacing, "m", 0.001, 1.0)?;
        require_in("min_points", self.min_points as f64, "", 3.0, 10_000.0)?;
        require_in("min_score", self.min_score, "", 0.0, 1.0)?;
        require_in("degenerate_below", self.degenerate_below, "", 0.0, 1.0)?;
        require_in("inflation", self.inflation, "", 1.0, 100.0)?;
        require_in("unknown_sigma", self.unknown_sigma, "m", 0.1, 100.0)?;
        Ok(self)
    }
}
