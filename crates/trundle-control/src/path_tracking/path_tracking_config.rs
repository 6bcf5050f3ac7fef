//! Gains of the tracking law.

use crate::path_tracking::tracking_law::Gains;
use serde::{Deserialize, Serialize};
use trundle_core::{Hypotenuse, Invalid, Twist2, require_in};

/// Gains of the tracking law.
///
/// The gains follow the reference: k1 = k2 = 2 `damping` sqrt(omega_d^2 + `k_cross` v_d^2), within
/// [`gain_min`](Self::gain_min) and [`gain_max`](Self::gain_max). Linearised about a straight reference, the error
/// beside the path then follows s^2 + k2 s + k_cross v_d^2: with that gain it has the chosen damping at every speed, and
/// decays over 1 / sqrt(k_cross) metres of path at every speed \[DeLuca01\].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct PathTrackingConfig {
    /// Gain of the cross-track error, 1/m^2, 0.01 to 100. An error falls to 1/e over 1 / sqrt(`k_cross`) metres of path. A larger gain
    /// corrects sooner, with more turning. Default 16 (ours, measured in `tests/it/path_tracking.rs`); \[Li18\] prints 1.
    pub k_cross: f64,
    /// Damping ratio of the tracking error, 0.3 to 3. A smaller ratio overshoots. Default 1: no overshoot.
    pub damping: f64,
    /// Smallest feedback gain along the path and in heading, 1/s, 0.1 to 20, effective at a resting reference. Default 2 (ours).
    pub gain_min: f64,
    /// Largest feedback gain along the path and in heading, 1/s, 0.1 to 20. A larger gain oscillates with delays. Default 4: with 0.1 s
    /// from camera to wheel the phase margin stays above 60 deg.
    pub gain_max: f64,
}

impl Default for PathTrackingConfig {
    fn default() -> Self {
        Self { k_cross: 16.0, damping: 1.0, gain_min: 2.0, gain_max: 4.0 }
    }
}

impl PathTrackingConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range, or the minimum gain is above the maximum.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("tracking.k_cross", self.k_cross, "1/m^2", 0.01, 100.0)?;
        require_in("tracking.damping", self.damping, "", 0.3, 3.0)?;
        require_in("tracking.gain_max", self.gain_max, "1/s", 0.1, 20.0)?;
        require_in("tracking.gain_min", self.gain_min, "1/s", 0.1, self.gain_max)?;
        Ok(self)
    }

    /// The gains about a reference that moves with `reference`.
    pub(super) fn gains(&self, reference: Twist2) -> Gains {
        let frequency = reference.omega.hypotenuse(self.k_cross.sqrt() * reference.v);
        let k = (2.0 * self.damping * frequency).clamp(self.gain_min, self.gain_max);
        Gains { k1: k, k2: k, k_cross: self.k_cross }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_follow_the_speed_between_their_bounds() {
        let config = PathTrackingConfig::default().validated().unwrap();
        assert_eq!(config.gains(Twist2::ZERO).k2, 2.0);
        assert!((config.gains(Twist2::new(-0.4, 0.0)).k2 - 3.2).abs() < 1e-12);
        assert_eq!(config.gains(Twist2::new(0.7, 1.0)).k2, 4.0);
    }

    #[test]
    fn bad_numbers_are_refused_by_name() {
        let error =
            PathTrackingConfig { gain_min: 5.0, ..PathTrackingConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "tracking.gain_min");
        assert!(
            PathTrackingConfig { k_cross: f64::NAN, ..PathTrackingConfig::default() }.validated().is_err()
        );
    }
}
