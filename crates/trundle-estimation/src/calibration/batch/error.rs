//! Reason why a recording gives no calibration.

use thiserror::Error;

/// Reason why a recording gives no calibration.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// A sensor has no or too few readings.
    #[error("{sensor}: {found} readings, expected {expected} or more; {advice}")]
    TooFewReadings {
        /// The sensor.
        sensor: &'static str,
        /// Readings found.
        found: usize,
        /// Readings that are needed.
        expected: usize,
        /// The remedy.
        advice: &'static str,
    },
    /// A value cannot be observed from the motion.
    #[error("{what} cannot be observed: {quantity} is {found:.3} {unit}, expected {expected}; {advice}")]
    NotObservable {
        /// Name of the value.
        what: &'static str,
        /// The quantity that decides.
        quantity: &'static str,
        /// Value of the quantity.
        found: f64,
        /// Unit of the quantity.
        unit: &'static str,
        /// The accepted range.
        expected: String,
        /// The remedy.
        advice: &'static str,
    },
    /// Two sensors contradict each other.
    #[error("{what}: {quantity} is {found:.3}, expected {expected}; {advice}")]
    Contradiction {
        /// The two sensors.
        what: &'static str,
        /// The quantity that decides.
        quantity: &'static str,
        /// Value of the quantity.
        found: f64,
        /// The accepted range.
        expected: String,
        /// The remedy.
        advice: &'static str,
    },
}
