//! Configuration of the timing.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Speed limits in addition to the drive's own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct TimingConfig {
    /// Time between samples of the trajectory, s, 0.001 to 1. Default 0.02: the control period.
    pub period: f64,
    /// Largest speed without clearance, m/s, 0.01 to 10. Default 0.15 (ours).
    pub slow_speed: f64,
    /// Clearance above which full speed is allowed, m, 0 to 10. Below it the limit falls linearly to `slow_speed`. Default 0.3 (ours).
    pub full_speed_clearance: f64,
    /// Largest speed into unknown space, m/s, 0.01 to 10. Default 0.35 (ours): a Kobuki stops from it within 0.13 m.
    pub unknown_speed: f64,
    /// Largest jerk, m/s^3, 0.01 to 1000. Default none: unlimited.
    pub jerk: Option<f64>,
}

impl Default for TimingConfig {
    fn default() -> Self {
        Self { period: 0.02, slow_speed: 0.15, full_speed_clearance: 0.3, unknown_speed: 0.35, jerk: None }
    }
}

impl TimingConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("timing.period", self.period, "s", 0.001, 1.0)?;
        require_in("timing.slow_speed", self.slow_speed, "m/s", 0.01, 10.0)?;
        require_in("timing.full_speed_clearance", self.full_speed_clearance, "m", 0.0, 10.0)?;
        require_in("timing.unknown_speed", self.unknown_speed, "m/s", 0.01, 10.0)?;
        if let Some(jerk) = self.jerk {
            require_in("timing.jerk", jerk, "m/s^3", 0.01, 1000.0)?;
        }
        Ok(self)
    }
}
