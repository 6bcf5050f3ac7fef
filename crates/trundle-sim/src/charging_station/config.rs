//! True parameters of the simulated charging station and of the robot's receivers.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// The station of a scene that has one: light, receivers, contacts.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct StationConfig {
    /// Half angle of the middle sector at the station, deg, 1 to 45. Default 10 (ours).
    pub middle_half_angle_deg: f64,
    /// Outer bound of the left and right sectors from the station's axis, deg, 10 to 90. Default 60 (ours).
    pub side_bound_deg: f64,
    /// Angle by which neighbouring sectors overlap, deg, 0 to 10. Default 3 (ours; the sources say that fields overlap).
    pub overlap_deg: f64,
    /// Distance up to which the near code is received, m, 0.1 to 5. Default 1 (ours).
    pub near_range: f64,
    /// Distance up to which the far code is received, m, 0.2 to 10. Default 3 (ours).
    pub far_range: f64,
    /// Radius of the circle around the base's origin on which the receivers sit, m, 0 to 2. Default 0.15 (ours).
    pub receiver_radius: f64,
    /// Bearing of the left receiver and its axis; the right one is its mirror image, deg, 0 to 120. Default 60 (ours).
    pub receiver_bearing_deg: f64,
    /// Half of a receiver's field of view, deg, 5 to 90. Default 60 (ours).
    pub receiver_half_view_deg: f64,
    /// Standard deviation of every edge of a sector or a field of view from reading to reading, deg, 0 to 10. Default 0.5 (ours).
    pub edge_noise_deg: f64,
    /// Probability that a receiver misses all light in a reading, 0 to 1. Default 0.01 (ours).
    pub miss_probability: f64,
    /// Lateral distance of the robot from the station's axis up to which the plates touch, m, 0.001 to 0.2. Default 0.01 (ours).
    pub contact_lateral: f64,
    /// Gap between robot and box below which the sprung plates touch, m, 0.001 to 0.1. Default 0.01 (ours).
    pub contact_gap: f64,
    /// Heading error up to which the plates touch, deg, 0.1 to 45. Default 3 (ours).
    pub contact_heading_deg: f64,
    /// Whether the plates charge; the light is on in any case. Default true.
    pub charges: bool,
}

impl Default for StationConfig {
    fn default() -> Self {
        Self {
            middle_half_angle_deg: 10.0,
            side_bound_deg: 60.0,
            overlap_deg: 3.0,
            near_range: 1.0,
            far_range: 3.0,
            receiver_radius: 0.15,
            receiver_bearing_deg: 60.0,
            receiver_half_view_deg: 60.0,
            edge_noise_deg: 0.5,
            miss_probability: 0.01,
            contact_lateral: 0.01,
            contact_gap: 0.01,
            contact_heading_deg: 3.0,
            charges: true,
        }
    }
}

impl StationConfig {
    /// The same station without noise.
    #[must_use]
    pub fn without_noise(self) -> Self {
        Self { edge_noise_deg: 0.0, miss_probability: 0.0, ..self }
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range or not finite.
    pub fn validated(self) -> Result<Self, Invalid> {
        let ranges = [
            ("middle_half_angle_deg", self.middle_half_angle_deg, "deg", 1.0, 45.0),
            ("side_bound_deg", self.side_bound_deg, "deg", 10.0, 90.0),
            ("overlap_deg", self.overlap_deg, "deg", 0.0, 10.0),
            ("near_range", self.near_range, "m", 0.1, 5.0),
            ("far_range", self.far_range, "m", 0.2, 10.0),
            ("receiver_radius", self.receiver_radius, "m", 0.0, 2.0),
            ("receiver_bearing_deg", self.receiver_bearing_deg, "deg", 0.0, 120.0),
            ("receiver_half_view_deg", self.receiver_half_view_deg, "deg", 5.0, 90.0),
            ("edge_noise_deg", self.edge_noise_deg, "deg", 0.0, 10.0),
            ("miss_probability", self.miss_probability, "", 0.0, 1.0),
            ("contact_lateral", self.contact_lateral, "m", 0.001, 0.2),
            ("contact_gap", self.contact_gap, "m", 0.001, 0.1),
            ("contact_heading_deg", self.contact_heading_deg, "deg", 0.1, 45.0),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("station.{name}"), value, unit, low, high)?;
        }
        Ok(self)
    }
}
