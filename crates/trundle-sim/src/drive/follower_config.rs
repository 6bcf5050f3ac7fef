//! Parameters of the way-point follower.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Settings of a [`super::WaypointFollower`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct WaypointFollowerConfig {
    /// Cruising speed, m/s, 0.01 to 2. Default 0.3: images overlap well at 15 Hz.
    pub v: f64,
    /// Highest turn rate, rad/s, 0.05 to 5. Default 0.8.
    pub omega: f64,
    /// Change of speed, m/s^2, 0.05 to 5. Default 0.4.
    pub acceleration: f64,
    /// Change of turn rate, rad/s^2, 0.1 to 20. Default 1.5.
    pub angular_acceleration: f64,
    /// Time without progress after which the path counts as blocked, s, 0.5 to 3600. Default 10: people pass by in less.
    pub patience: f64,
}

impl Default for WaypointFollowerConfig {
    fn default() -> Self {
        Self { v: 0.3, omega: 0.8, acceleration: 0.4, angular_acceleration: 1.5, patience: 10.0 }
    }
}

impl WaypointFollowerConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("follower.v", self.v, "m/s", 0.01, 2.0)?;
        require_in("follower.omega", self.omega, "rad/s", 0.05, 5.0)?;
        require_in("follower.acceleration", self.acceleration, "m/s^2", 0.05, 5.0)?;
        require_in("follower.angular_acceleration", self.angular_acceleration, "rad/s^2", 0.1, 20.0)?;
        require_in("follower.patience", self.patience, "s", 0.5, 3600.0)?;
        Ok(self)
    }
}
