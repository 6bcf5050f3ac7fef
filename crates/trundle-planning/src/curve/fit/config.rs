//! Configuration of the curve fit.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in, require_positive};

/// The shape of the fitted curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct CurveConfig {
    /// Degree of each polynomial piece, 5 to 12. Default 5: the lowest that meets position, heading and curvature at both ends.
    pub degree: usize,
    /// Length below which the curve smooths the path instead of following it, m, above 0, at most 10. A larger value cuts corners more.
    /// Default 0.5 (ours).
    pub smoothing: f64,
    /// Longest part of the path for one piece, m, 0.1 to 100. Default 1 (ours).
    pub piece: f64,
    /// Largest distance of a free corridor's side from its path segment, m, 0.1 to 10. Default 0.8 (ours).
    pub reach: f64,
    /// Smallest tangent at the ends, as a fraction of unit speed (eps of \[Li18\]), 0.01 to 1. A smaller tangent allows sharp bends.
    /// Default 0.7 (ours).
    pub min_tangent: f64,
    /// Largest curvature, 1/m, 0.1 to 1000. Without a curve within this bound, the robot turns in place or the path is split. Default 8
    /// (ours): a Kobuki still drives 0.36 m/s there.
    pub max_curvature: f64,
    /// Largest ratio of the length of a curve with the end headings to that of the path, 1 to 10. Beyond it the robot turns in place.
    /// Default 1.03 (ours): with the path within 2 % of the shortest, 5 % in total.
    pub detour: f64,
    /// Angle between heading and path at the start above which the robot turns in place first, rad, 0 to pi. Default 1.047 (60 deg, ours).
    pub turn_first: f64,
    /// Angle between path and goal heading above which the robot turns in place at the end, rad, 0 to pi. Below it the curve bends into the
    /// heading if clearance permits. Default 1.745 (100 deg, ours).
    pub turn_last: f64,
}

impl Default for CurveConfig {
    fn default() -> Self {
        Self {
            degree: 5,
            smoothing: 0.5,
            piece: 1.0,
            reach: 0.8,
            min_tangent: 0.7,
            max_curvature: 8.0,
            detour: 1.03,
            turn_first: 60f64.to_radians(),
            turn_last: 100f64.to_radians(),
        }
    }
}

impl CurveConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("curve.degree", self.degree as f64, "", 5.0, 12.0)?;
        require_positive("curve.smoothing", self.smoothing, "m")?;
        require_in("curve.smoothing", self.smoothing, "m", 0.0, 10.0)?;
        require_in("curve.piece", self.piece, "m", 0.1, 100.0)?;
        require_in("curve.reach", self.reach, "m", 0.1, 10.0)?;
        require_in("curve.min_tangent", self.min_tangent, "", 0.01, 1.0)?;
        require_in("curve.max_curvature", self.max_curvature, "1/m", 0.1, 1000.0)?;
        require_in("curve.detour", self.detour, "", 1.0, 10.0)?;
        require_in("curve.turn_first", self.turn_first, "rad", 0.0, std::f64::consts::PI)?;
        require_in("curve.turn_last", self.turn_last, "rad", 0.0, std::f64::consts::PI)?;
        Ok(self)
    }
}
