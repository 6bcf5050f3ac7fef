//! Settings of the pose monitor.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Settings of the pose monitor: how often a robot is carried away, and how sure it must be of a place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PoseMonitorConfig {
    /// Mean time from one time that the robot is carried away without a sign of it to the next, s, 60 to 10000000. Default 3600. A smaller
    /// number notices it sooner, and raises more false alarms.
    pub displacement_interval: f64,
    /// Probability above which the robot takes a found pose over, 0.5 to 0.999999. Default 0.999.
    pub accept_probability: f64,
}

impl Default for PoseMonitorConfig {
    fn default() -> Self {
        Self { displacement_interval: 3600.0, accept_probability: 0.999 }
    }
}

impl PoseMonitorConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("displacement_interval", self.displacement_interval, "s", 60.0, 1e7)?;
        require_in("accept_probability", self.accept_probability, "", 0.5, 0.999_999)?;
        Ok(self)
    }
}
