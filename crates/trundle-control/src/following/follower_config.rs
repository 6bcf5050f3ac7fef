//! Configuration of the follower.

use crate::path_tracking::path_tracking_config::PathTrackingConfig;
use crate::stabilization::stabilizer_config::StabilizerConfig;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Settings of trajectory following and of the final approach.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct FollowerConfig {
    /// The tracking law.
    pub tracking: PathTrackingConfig,
    /// Final approach to the goal.
    pub settling: StabilizerConfig,
    /// Distance of the reference ahead of the robot from which the reference slows down, m, 0 to 1. A larger value tolerates more lag.
    /// Default 0.04: the lag of the motors at a start.
    pub wait_from: f64,
    /// Distance of the reference ahead of the robot at which the reference stops, m, above `wait_from`, to 2. Default 0.12 (ours).
    pub wait_at: f64,
    /// Smallest fraction of the reference's speed with a cross-track error, 0.05 to 1. The error only shrinks in motion. Default 0.4
    /// (ours).
    pub min_rate: f64,
    /// Heading error at which the reference stops, rad, 0.05 to 3. It slows down from half of the error on. Default 0.5 (ours).
    pub wait_heading: f64,
    /// Lead of the reference's twist, s, 0 to 0.5, which compensates command delay and motor lag. Default 0.06 (ours).
    pub lead: f64,
    /// Distance from the reference beyond which the robot is off the trajectory and plans again, m, 0.02 to 5. Default 0.25 (ours).
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
