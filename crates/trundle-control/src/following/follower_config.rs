//! Configuration of the follower.

use crate::path_tracking::path_tracking_config::PathTrackingConfig;
use crate::stabilization::stabilizer_config::StabilizerConfig;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// How the robot follows a trajectory to its goal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct FollowerConfig {
    /// The tracking law.
    pub tracking: PathTrackingConfig,
    /// Settling at the goal.
    pub settling: StabilizerConfig,
    /// The reference starts to wait when it is this far ahead of the robot, m, 0 to 1. Default 0.04: what the lag of the
    /// motors costs when starting.
    pub wait_from: f64,
    /// The reference stands still when it is this far ahead of the robot, m, above `wait_from`, to 2. Default 0.12 (ours).
    pub wait_at: f64,
    /// The reference's speed never falls below this part for an error beside the path, 0.05 to 1: that error only shrinks in
    /// motion. Default 0.4 (ours).
    pub min_rate: f64,
    /// The reference waits in the same way for a heading error, from a half of this to the whole, rad, 0.05 to 3.
    /// Default 0.5 (ours).
    pub wait_heading: f64,
    /// The reference's twist is taken this much ahead, s, 0 to 0.5: command delay and motor lag. Default 0.06 (ours).
    pub lead: f64,
    /// Farther than this from its reference the robot is reported off the trajectory, m, 0.02 to 5. Default 0.25 (ours).
    pub stray_distance: f64,
}

impl Default for FollowerConfig {
    fn default() -> Self {
        Self {
            tracking: PathTrackingConfig::default(),
            settling: StabilizerConfig::default(),
            wait_from: 0.04,
            wait_at: 0.12,
            min_rate: 0.4,
            wait_heading: 0.5,
            lead: 0.06,
            stray_distance: 0.25,
        }
    }
}

impl FollowerConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(mut self) -> Result<Self, Invalid> {
        self.tracking = self.tracking.validated()?;
        self.settling = self.settling.validated()?;
        let ranges = [
            ("wait_from", self.wait_from, "m", 0.0, 1.0),
            ("wait_at", self.wait_at, "m", self.wait_from + 0.001, 2.0),
            ("min_rate", self.min_rate, "", 0.05, 1.0),
            ("wait_heading", self.wait_heading, "rad", 0.05, 3.0),
            ("lead", self.lead, "s", 0.0, 0.5),
            ("stray_distance", self.stray_distance, "m", 0.02, 5.0),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(name, value, unit, low, high)?;
        }
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_numbers_are_refused_by_name() {
        assert!(FollowerConfig::default().validated().is_ok());
        let error = FollowerConfig { wait_at: 0.01, ..FollowerConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "wait_at");
        let settling = StabilizerConfig { speed: 0.0, ..StabilizerConfig::default() };
        let error = FollowerConfig { settling, ..FollowerConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "settling.speed");
    }
}
