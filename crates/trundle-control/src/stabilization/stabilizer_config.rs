//! Gains and tolerances of point stabilisation.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Gains and tolerances of the final approach to a goal pose.
///
/// The default gains give the linearised law one double root: distance and both angles fall to 1/e in a second without overshoot. A base
/// with a response time of 0.1 s can follow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct StabilizerConfig {
    /// Speed per distance from the goal, 1/s, 0.05 to 10. A larger gain approaches faster. Default 1 (ours).
    pub k_rho: f64,
    /// Turn rate per bearing of the goal, 1/s, above `k_rho`, to 20. Default 3 (ours).
    pub k_alpha: f64,
    /// Turn rate per approach angle (goal heading against bearing), 1/s, -20 to -0.001. Default -1 (ours).
    pub k_beta: f64,
    /// Distance from the goal below which the approach angle fades out, m, 0.001 to 10. A turn on the spot then corrects the heading.
    /// Default 0.15 (ours).
    pub shaping_distance: f64,
    /// Largest approach angle in the law, rad, 0 to 1.5. It bounds the detour of the arc. Default 0.8 (ours).
    pub max_approach: f64,
    /// Highest speed of the approach, m/s, 0.01 to 10. Default 0.25 (ours).
    pub speed: f64,
    /// Lowest speed of the approach, m/s, 0 to 0.1. Slower motors stick, and the last centimetres would take seconds. Default 0.035: with
    /// 0.1 s of delay and lag the robot overruns by 3.5 mm.
    pub creep_speed: f64,
    /// Highest turn rate of the approach, rad/s, 0.05 to 20. Default 1.2 (ours).
    pub turn_rate: f64,
    /// Turn rate per heading error in turns on the spot, 1/s, 0.1 to 10. Default 2.5 (ours).
    pub k_turn: f64,
    /// Allowed distance from the goal, m, 0.001 to 1. The approach ends at 0.4 of this distance and is repeated beyond it. A smaller value
    /// takes longer. Default 0.01 (ours).
    pub position_tolerance: f64,
    /// Allowed heading error, rad, 0.001 to 1. The turn ends at half of it. Default 0.0087 (0.5 deg; ours).
    pub heading_tolerance: f64,
    /// Error at which a robot at its goal moves again, in tolerances, 1 to 100. Default 2.5 (ours).
    pub release: f64,
    /// Number of repeated approaches to one goal after which an error of `release` tolerances is accepted, 0 to 100. Default 4 (ours).
    pub attempts: u32,
}

impl Default for StabilizerConfig {
    fn default() -> Self {
        Self {
            k_rho: 1.0,
            k_alpha: 3.0,
            k_beta: -1.0,
            shaping_distance: 0.15,
            max_approach: 0.8,
            speed: 0.25,
            creep_speed: 0.035,
            turn_rate: 1.2,
            k_turn: 2.5,
            position_tolerance: 0.01,
            heading_tolerance: 0.5_f64.to_radians(),
            release: 2.5,
            attempts: 4,
        }
    }
}

impl StabilizerConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        let ranges = [
            ("k_rho", self.k_rho, "1/s", 0.05, 10.0),
            ("k_alpha", self.k_alpha, "1/s", self.k_rho, 20.0),
            ("k_beta", self.k_beta, "1/s", -20.0, -0.001),
            ("shaping_distance", self.shaping_distance, "m", 0.001, 10.0),
            ("max_approach", self.max_approach, "rad", 0.0, 1.5),
            ("speed", self.speed, "m/s", 0.01, 10.0),
            ("creep_speed", self.creep_speed, "m/s", 0.0, 0.1),
            ("turn_rate", self.turn_rate, "rad/s", 0.05, 20.0),
            ("k_turn", self.k_turn, "1/s", 0.1, 10.0),
            ("position_tolerance", self.position_tolerance, "m", 0.001, 1.0),
            ("heading_tolerance", self.heading_tolerance, "rad", 0.001, 1.0),
            ("release", self.release, "", 1.0, 100.0),
            ("attempts", f64::from(self.attempts), "", 0.0, 100.0),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("settling.{name}"), value, unit, low, high)?;
        }
        if self.k_alpha <= self.k_rho {
            let expected = format!("more than k_rho, {}", self.k_rho);
            return Err(Invalid::new("settling.k_alpha", self.k_alpha, "1/s", expected));
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_numbers_are_refused_by_name() {
        assert!(StabilizerConfig::default().validated().is_ok());
        let error = StabilizerConfig { k_alpha: 1.0, ..StabilizerConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "settling.k_alpha");
        let error = StabilizerConfig { k_beta: 1.0, ..StabilizerConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "settling.k_beta");
    }
}
