//! Gains and tolerances of point stabilisation.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// How the robot settles on a goal pose.
///
/// The default gains give the linearised law one double root: the distance and both angles fall by 1/e per second, without
/// overshoot, and slowly enough for a base that answers within 0.1 s.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct StabilizerConfig {
    /// Speed by distance, 1/s, 0.05 to 10. Default 1 (ours).
    pub k_rho: f64,
    /// Turn rate by bearing, 1/s, above `k_rho`, to 20. Default 3 (ours).
    pub k_alpha: f64,
    /// Turn rate by approach angle, 1/s, -20 to -0.001. Default -1 (ours).
    pub k_beta: f64,
    /// Distance from the goal below which the approach angle fades and the turn on the spot corrects the heading, m, 0.001 to
    /// 10. Default 0.15 (ours).
    pub shaping_distance: f64,
    /// Largest approach angle that the law uses, rad, 0 to 1.5: it bounds the detour. Default 0.8 (ours).
    pub max_approach: f64,
    /// Highest speed, m/s, 0.01 to 10. Default 0.25 (ours).
    pub speed: f64,
    /// Lowest speed while approaching, m/s, 0 to 0.1: motors stick below, and the last
    /// centimetres would take seconds. Default 0.035: at 0.1 s of delay and lag the robot rolls on for 3.5 mm.
    pub creep_speed: f64,
    /// Highest turn rate, rad/s, 0.05 to 20. Default 1.2 (ours).
    pub turn_rate: f64,
    /// Turn rate by heading error when turning on the spot, 1/s, 0.1 to 10. Default 2.5 (ours).
    pub k_turn: f64,
    /// Allowed distance from the goal, m, 0.001 to 1. Default 0.01. The approach ends at 0.4 of it and is repeated when the
    /// error exceeds it.
    pub position_tolerance: f64,
    /// Allowed heading error, rad, 0.001 to 1. Default 0.5 deg. The turn ends at half of it.
    pub heading_tolerance: f64,
    /// A settled robot moves again when an error grows beyond this many tolerances, 1 to 100. Default 2.5 (ours).
    pub release: f64,
    /// Number of repeated approaches to one goal before an error of `release` times the tolerance is accepted, 0 to 100.
    /// Default 4 (ours).
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
