//! The light of a charging station as the estimator expects it.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Geometry of sectors and receivers, and probabilities of wrong readings.
///
/// The vendor's documentation names sectors and receivers without numbers. The defaults are ours; measure them on the real station.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct StationLightConfig {
    /// Half angle of the middle sector at the station, deg, 1 to 45. Default 10 (ours).
    pub middle_half_angle_deg: f64,
    /// Outer bound of the left and right sectors from the station's axis, deg, 10 to 90. Default 60 (ours).
    pub side_bound_deg: f64,
    /// Distance up to which the near code is received, m, 0.1 to 5. Default 1 (ours).
    pub near_range: f64,
    /// Distance up to which the far code is received, m, 0.2 to 10. Default 3 (ours).
    pub far_range: f64,
    /// Distance of the receivers from the base's origin, m, 0 to 2. Default 0.15 (ours).
    pub receiver_radius: f64,
    /// Bearing of the left receiver and of its axis, base frame, deg, 0 to 120. The right one is its mirror image. Default 60 (ours).
    pub receiver_bearing_deg: f64,
    /// Half of a receiver's field of view, deg, 5 to 90. Default 60 (ours).
    pub receiver_half_view_deg: f64,
    /// Half width of the edge of a sector, deg, 0.1 to 20. Default 2.5 (ours): sectors overlap by some degrees.
    pub sector_edge_deg: f64,
    /// Half width of the edge of a receiver's field of view, deg, 0.1 to 45. Default 5 (ours).
    pub view_edge_deg: f64,
    /// Half width of the edges between near, far and dark, as a fraction of the distance, 0.01 to 1. Default 0.15 (ours).
    pub range_edge: f64,
    /// Probability that a receiver misses a field or reports an absent one, 0.001 to 0.5. A larger value trusts readings less. Default 0.02
    /// (ours).
    pub outlier_probability: f64,
    /// Smallest probability of a dark receiver, 0.001 to 1: an object may hide the station. Default 0.2 (ours).
    pub dark_likelihood: f64,
}

impl Default for StationLightConfig {
    fn default() -> Self {
        Self {
            middle_half_angle_deg: 10.0,
            side_bound_deg: 60.0,
            near_range: 1.0,
            far_range: 3.0,
            receiver_radius: 0.15,
            receiver_bearing_deg: 60.0,
            receiver_half_view_deg: 60.0,
            sector_edge_deg: 2.5,
            view_edge_deg: 5.0,
            range_edge: 0.15,
            outlier_probability: 0.02,
            dark_likelihood: 0.2,
        }
    }
}

impl StationLightConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        let ranges = [
            ("middle_half_angle_deg", self.middle_half_angle_deg, "deg", 1.0, 45.0),
            ("side_bound_deg", self.side_bound_deg, "deg", 10.0, 90.0),
            ("near_range", self.near_range, "m", 0.1, 5.0),
            ("far_range", self.far_range, "m", 0.2, 10.0),
            ("receiver_radius", self.receiver_radius, "m", 0.0, 2.0),
            ("receiver_bearing_deg", self.receiver_bearing_deg, "deg", 0.0, 120.0),
            ("receiver_half_view_deg", self.receiver_half_view_deg, "deg", 5.0, 90.0),
            ("sector_edge_deg", self.sector_edge_deg, "deg", 0.1, 20.0),
            ("view_edge_deg", self.view_edge_deg, "deg", 0.1, 45.0),
            ("range_edge", self.range_edge, "", 0.01, 1.0),
            ("outlier_probability", self.outlier_probability, "", 0.001, 0.5),
            ("dark_likelihood", self.dark_likelihood, "", 0.001, 1.0),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("station.{name}"), value, unit, low, high)?;
        }
        Ok(self)
    }
}
