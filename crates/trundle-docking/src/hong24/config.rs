//! Parameters of the method of \[Hong24\].

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Parameters of the method of \[Hong24\]. The paper gives no numbers; all are ours.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct Hong24Config {
    /// Weight w1 of the time in the cost f = w1 t + w2 d, 1/s, 0 to 1000. Default 1 (ours): the cost is in seconds.
    pub time_weight: f64,
    /// Weight w2 of the lateral deviation in that cost, 1/m, 0 to 10^6. Default 60 (ours): a centimetre costs 0.6 s.
    pub lateral_weight: f64,
    /// Step at which turns are sampled, rad, 0.001 to 0.5. Default 0.0175 (1 deg; ours).
    pub angle_step: f64,
    /// Step at which straights are sampled, m, 0.001 to 0.5. Default 0.01 (ours): the position tolerance.
    pub distance_step: f64,
    /// Length of a straight candidate, m, 0.01 to 10. Default 0.8 (ours).
    pub reach: f64,
    /// Tolerance of the lateral deviation, m, 0.001 to 0.1. Default 0.01 (ours): that of `docking.planner`.
    pub lateral_threshold: f64,
    /// Tolerance of the longitudinal deviation, m, 0.001 to 0.1. Default 0.01 (ours): that of `docking.planner`.
    pub longitudinal_threshold: f64,
    /// Tolerance of the angular deviation, rad, 0.001 to 0.2. Default 0.0175 (1 deg; ours).
    pub angle_threshold: f64,
    /// Distance of a recovery move, m, 0.01 to 1. Default 0.1 (ours).
    pub recovery: f64,
    /// Largest number of motions, 1 to 1000. Default 40 (ours): 20 turns, each with a straight move.
    pub max_motions: usize,
}

impl Default for Hong24Config {
    fn default() -> Self {
        Self {
            time_weight: 1.0,
            lateral_weight: 60.0,
            angle_step: 1_f64.to_radians(),
            distance_step: 0.01,
            reach: 0.8,
            lateral_threshold: 0.01,
            longitudinal_threshold: 0.01,
            angle_threshold: 1_f64.to_radians(),
            recovery: 0.1,
            max_motions: 40,
        }
    }
}

impl Hong24Config {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        let ranges = [
            ("time_weight", self.time_weight, "1/s", 0.0, 1000.0),
            ("lateral_weight", self.lateral_weight, "1/m", 0.0, 1e6),
            ("angle_step", self.angle_step, "rad", 0.001, 0.5),
            ("distance_step", self.distance_step, "m", 0.001, 0.5),
            ("reach", self.reach, "m", 0.01, 10.0),
            ("lateral_threshold", self.lateral_threshold, "m", 0.001, 0.1),
            ("longitudinal_threshold", self.longitudinal_threshold, "m", 0.001, 0.1),
            ("angle_threshold", self.angle_threshold, "rad", 0.001, 0.2),
            ("recovery", self.recovery, "m", 0.01, 1.0),
            ("max_motions", self.max_motions as f64, "", 1.0, 1000.0),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("docking.paper.{name}"), value, unit, low, high)?;
        }
        Ok(self)
    }
}
