//! Configuration of the localizer.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Noise, gates and time limits of the localizer's measurements.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct LocalizerConfig {
    /// Noise of a visual position added to the covariance of the pose (one sigma), m, 0.001 to 1. A larger value trusts wheels and scans
    /// more. Default 0.02 (ours): less than half of a map cell.
    pub visual_position_sigma: f64,
    /// Noise of a visual heading added to the covariance of the pose (one sigma), deg, 0.01 to 30. Default 0.6 (ours): 0.01 m at 1 m.
    pub visual_heading_sigma_deg: f64,
    /// Factor on the sigma of a weak visual pose, from few landmarks, 1 to 100. Default 3 (ours).
    pub weak_factor: f64,
    /// Noise of a scan match's position added to its covariance (one sigma), m, 0.001 to 1. A larger value trusts scan matches less.
    /// Default 0.02 (ours): less than half of a map cell.
    pub scan_position_sigma: f64,
    /// Noise of a scan match's heading added to its covariance (one sigma), deg, 0.01 to 30. Default 0.5 (ours): half of a map cell at 3 m.
    pub scan_heading_sigma_deg: f64,
    /// Smallest sigma of the position after any number of corrections, m, 0 to 1. Default 0.015: errors of neighbouring images
    /// are correlated, and averaging them gains little.
    pub min_position_sigma: f64,
    /// Smallest sigma of the heading after any number of corrections, deg, 0 to 30. Default 0.45: three quarters of
    /// `visual_heading_sigma_deg`, as for the position.
    pub min_heading_sigma_deg: f64,
    /// Largest sigma of the position at which a new visual map is anchored in the map, m, 0.01 to 10. Default 0.5 (ours).
    pub anchor_sigma: f64,
    /// Gate of the Mahalanobis distance, sigmas, 1 to 100. Measurements beyond it are rejected. Default 4: rejects one correct measurement
    /// in 1000.
    pub gate: f64,
    /// Number of consecutive rejected visual poses after which the estimate or the visual map is moved, 2 to 1000. Default 8: half a
    /// second.
    pub recover_after: usize,
    /// Difference of the motions by camera and wheels between two visual poses that counts as a jump, m, 0.01 to 10.
    /// Default 0.1: three times the slip of 1/15 s at 0.5 m/s.
    pub jump_distance: f64,
    /// Difference of the turns by camera and wheels between two visual poses that counts as a jump, deg, 0.1 to 180. Default 6 (ours): the
    /// turn of 1/15 s at 90 deg/s.
    pub jump_turn_deg: f64,
    /// Largest delay of a measurement behind the newest odometry, s, 0.1 to 60. Older ones are rejected; a larger value takes more memory.
    /// Default 2 (ours): 100 readings at 50 Hz.
    pub history: f64,
    /// Largest lead of a measurement over the newest odometry, s, 0 to 1. Later ones are rejected. Default 0.1 (ours): 5 readings at 50 Hz.
    pub max_lead: f64,
}

impl Default for LocalizerConfig {
    fn default() -> Self {
        Self {
            visual_position_sigma: 0.02,
            visual_heading_sigma_deg: 0.6,
            weak_factor: 3.0,
            scan_position_sigma: 0.02,
            scan_heading_sigma_deg: 0.5,
            min_position_sigma: 0.015,
            min_heading_sigma_deg: 0.45,
            anchor_sigma: 0.5,
            gate: 4.0,
            recover_after: 8,
            jump_distance: 0.1,
            jump_turn_deg: 6.0,
            history: 2.0,
            max_lead: 0.1,
        }
    }
}

impl LocalizerConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("visual_position_sigma", self.visual_position_sigma, "m", 0.001, 1.0)?;
        require_in("visual_heading_sigma_deg", self.visual_heading_sigma_deg, "deg", 0.01, 30.0)?;
        require_in("weak_factor", self.weak_factor, "", 1.0, 100.0)?;
        require_in("scan_position_sigma", self.scan_position_sigma, "m", 0.001, 1.0)?;
        require_in("scan_heading_sigma_deg", self.scan_heading_sigma_deg, "deg", 0.01, 30.0)?;
        require_in("min_position_sigma", self.min_position_sigma, "m", 0.0, 1.0)?;
        require_in("min_heading_sigma_deg", self.min_heading_sigma_deg, "deg", 0.0, 30.0)?;
        require_in("anchor_sigma", self.anchor_sigma, "m", 0.01, 10.0)?;
        require_in("gate", self.gate, "", 1.0, 100.0)?;
        require_in("recover_after", self.recover_after as f64, "", 2.0, 1000.0)?;
        require_in("jump_distance", self.jump_distance, "m", 0.01, 10.0)?;
        require_in("jump_turn_deg", self.jump_turn_deg, "deg", 0.1, 180.0)?;
        require_in("history", self.history, "s", 0.1, 60.0)?;
        require_in("max_lead", self.max_lead, "s", 0.0, 1.0)?;
        Ok(self)
    }

    pub(crate) fn visual_noise(&self) -> Matrix3<f64> {
        variances(self.visual_position_sigma, self.visual_heading_sigma_deg)
    }

    pub(crate) fn scan_noise(&self) -> Matrix3<f64> {
        variances(self.scan_position_sigma, self.scan_heading_sigma_deg)
    }

    pub(crate) fn min_variances(&self) -> Vector3<f64> {
        variances(self.min_position_sigma, self.min_heading_sigma_deg).diagonal()
    }
}

fn variances(position: f64, heading_deg: f64) -> Matrix3<f64> {
    let heading = heading_deg.to_radians();
    Matrix3::from_diagonal(&Vector3::new(position * position, position * position, heading * heading))
}
