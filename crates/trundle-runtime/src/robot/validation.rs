//! Validation of a robot's configuration, by building a robot from it.

use super::Robot;
use crate::config::RobotConfig;
use trundle_core::Invalid;

impl RobotConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// Names the first number that is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        Robot::new(self.clone()).map(|_| self)
    }
}
