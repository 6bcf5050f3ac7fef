//! Configuration of the driver of a base.

use super::feedback_events::GyroSource;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Configuration of a [`super::base::KobukiBase`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct KobukiBaseConfig {
    /// Time without a command after which the base is sent zero speed, s, 0.05 to 10. Default 0.2.
    pub command_timeout_s: f64,
    /// Time without a packet after which the link counts as lost, s, 0.05 to 10. Default 0.1: five packets.
    pub silence_limit_s: f64,
    /// Time that the start waits for the base, s, 0.1 to 60. Default 2.
    pub start_limit_s: f64,
    /// Wait before the first attempt to open a lost port again, s, 0.01 to 10; it doubles with each attempt. Default 0.1.
    pub min_retry_s: f64,
    /// Longest wait between two attempts, s, 0.01 to 60. Default 1.
    pub max_retry_s: f64,
    /// Smallest time from the base's stamp to the arrival, s, 0 to 0.1. Default 0.008: 81 bytes at 115200 baud take 7.0 ms, USB 1 ms.
    pub transport_delay_s: f64,
    /// Source of the gyro's events. Default the raw readings.
    pub gyro_source: GyroSource,
}

impl Default for KobukiBaseConfig {
    fn default() -> Self {
        Self {
            command_timeout_s: 0.2,
            silence_limit_s: 0.1,
            start_limit_s: 2.0,
            min_retry_s: 0.1,
            max_retry_s: 1.0,
            transport_delay_s: 0.008,
            gyro_source: GyroSource::Raw,
        }
    }
}

impl KobukiBaseConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside of its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("command_timeout_s", self.command_timeout_s, "s", 0.05, 10.0)?;
        require_in("silence_limit_s", self.silence_limit_s, "s", 0.05, 10.0)?;
        require_in("start_limit_s", self.start_limit_s, "s", 0.1, 60.0)?;
        require_in("min_retry_s", self.min_retry_s, "s", 0.01, 10.0)?;
        require_in("max_retry_s", self.max_retry_s, "s", self.min_retry_s, 60.0)?;
        require_in("transport_delay_s", self.transport_delay_s, "s", 0.0, 0.1)?;
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_valid_and_others_are_named() {
        assert!(KobukiBaseConfig::default().validated().is_ok());
        let error = KobukiBaseConfig { silence_limit_s: 0.0, ..Default::default() }.validated().unwrap_err();
        assert_eq!(error.to_string(), "silence_limit_s is 0 s, expected 0.05 to 10");
        let text = r#"{"gyro_source": "calibrated"}"#;
        let config: KobukiBaseConfig = serde_json::from_str(text).unwrap();
        assert_eq!(config.gyro_source, GyroSource::Calibrated);
    }
}
