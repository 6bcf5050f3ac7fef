//! Configuration of the smoother.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Window, keyframes and noise of the smoother. The noise of wheels and gyro is that of [`crate::OdometryConfig`].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct SmootherConfig {
    /// Length of the window and choice of keyframes.
    pub window: WindowConfig,
    /// Noise of visual poses and scan matches.
    pub noise: SmootherNoise,
    /// Gates and limits.
    pub limits: SmootherLimits,
}

/// Length of the window and choice of keyframes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct WindowConfig {
    /// Length of the window, s, 1 to 60. Default 15.
    pub length: f64,
    /// Largest number of keyframes in the window, 4 to 1000. Default 100.
    pub max_keyframes: usize,
    /// Distance between two keyframes, m, 0.001 to 1. Default 0.05: the error of visual poses is constant over a shorter distance.
    pub keyframe_distance: f64,
    /// Turn between two keyframes, deg, 0.1 to 90. Default 5.
    pub keyframe_turn_deg: f64,
    /// Smallest time between two keyframes, s, 0 to 10. Default 0.1: 100 keyframes then hold at least 10 s.
    pub keyframe_min_time: f64,
    /// Largest time between two keyframes of a moving robot, s, 0.05 to 10; four times as long at rest. Default 0.5: a first-order
    /// correction of the gyro's bias holds.
    pub keyframe_max_time: f64,
}

/// Noise of visual poses and scan matches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SmootherNoise {
    /// White noise of a visual position (one sigma), m, 1e-4 to 1. Default 0.001: three times that of simulated drives.
    pub visual_white_position: f64,
    /// White noise of a visual heading (one sigma), deg, 0.001 to 30. Default 0.03: twice that of simulated drives.
    pub visual_white_heading_deg: f64,
    /// Error of the visual map's parts besides the covariance of the pose (one sigma), m, 0 to 1. Default 0.001.
    pub visual_map_position: f64,
    /// Error of the heading of the visual map's parts (one sigma), deg, 0 to 30. Default 0.03.
    pub visual_map_heading_deg: f64,
    /// Factor on the sigma of the white noise of a weak visual pose, 1 to 100. Default 3.
    pub weak_factor: f64,
    /// Distance over which errors of visual poses are correlated (factor 1/e), m, 0.01 to 100. Default 10: drives
    /// in the simulator.
    pub correlation_distance: f64,
    /// Turn over which errors of visual poses are correlated, rad, 0.01 to 100. Default 4: the camera views another part of the map.
    pub correlation_turn: f64,
    /// Noise of a scan match's position added to its covariance (one sigma), m, 0.001 to 1. Default 0.02.
    pub scan_position: f64,
    /// Noise of a scan match's heading added to its covariance (one sigma), deg, 0.01 to 30. Default 0.5.
    pub scan_heading_deg: f64,
    /// Distance over which errors of scan matches are correlated (factor 1/e), m, 0.01 to 100. Default 0.3: the hits are then other parts
    /// of the walls.
    pub scan_correlation_distance: f64,
    /// Turn over which errors of scan matches are correlated, rad, 0.01 to 100. Default 0.3.
    pub scan_correlation_turn: f64,
    /// Prior sigma of the wheelbase's error, ratio, 0.0001 to 0.1. Default 0.005.
    pub wheelbase_sigma: f64,
    /// Prior sigma of the camera's delay, s, 1e-5 to 0.5. Default 0.003.
    pub delay_sigma: f64,
}

/// Gates and limits of the smoother.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SmootherLimits {
    /// Gate of an innovation, sigmas, 1 to 100. Default 5.
    pub gate: f64,
    /// Prior probability that a recognised place is wrong, 1e-6 to 0.5. Default 0.01.
    pub wrong_place_probability: f64,
    /// Largest lead of a measurement over the newest motion, s, 0 to 1. Default 0.1.
    pub max_lead: f64,
}

impl Default for WindowConfig {
    fn default() -> Self {
        Self {
            length: 15.0,
            max_keyframes: 100,
            keyframe_distance: 0.05,
            keyframe_turn_deg: 5.0,
            keyframe_min_time: 0.1,
            keyframe_max_time: 0.5,
        }
    }
}

impl Default for SmootherNoise {
    fn default() -> Self {
        Self {
            visual_white_position: 0.001,
            visual_white_heading_deg: 0.03,
            visual_map_position: 0.001,
            visual_map_heading_deg: 0.03,
            weak_factor: 3.0,
            correlation_distance: 10.0,
            correlation_turn: 4.0,
            scan_position: 0.02,
            scan_heading_deg: 0.5,
            scan_correlation_distance: 0.3,
            scan_correlation_turn: 0.3,
            wheelbase_sigma: 0.005,
            delay_sigma: 0.003,
        }
    }
}

impl Default for SmootherLimits {
    fn default() -> Self {
        Self { gate: 5.0, wrong_place_probability: 0.01, max_lead: 0.1 }
    }
}

impl SmootherConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        self.window.check()?;
        self.noise.check()?;
        self.limits.check()?;
        Ok(self)
    }
}

impl WindowConfig {
    fn check(&self) -> Result<(), Invalid> {
        require_in("window.length", self.length, "s", 1.0, 60.0)?;
        require_in("window.max_keyframes", self.max_keyframes as f64, "", 4.0, 1000.0)?;
        require_in("window.keyframe_distance", self.keyframe_distance, "m", 0.001, 1.0)?;
        require_in("window.keyframe_turn_deg", self.keyframe_turn_deg, "deg", 0.1, 90.0)?;
        require_in("window.keyframe_min_time", self.keyframe_min_time, "s", 0.0, 10.0)?;
        require_in("window.keyframe_max_time", self.keyframe_max_time, "s", 0.05, 10.0).map(drop)
    }
}

impl SmootherNoise {
    fn check(&self) -> Result<(), Invalid> {
        require_in("noise.visual_white_position", self.visual_white_position, "m", 1e-4, 1.0)?;
        require_in("noise.visual_white_heading_deg", self.visual_white_heading_deg, "deg", 0.001, 30.0)?;
        require_in("noise.visual_map_position", self.visual_map_position, "m", 0.0, 1.0)?;
        require_in("noise.visual_map_heading_deg", self.visual_map_heading_deg, "deg", 0.0, 30.0)?;
        require_in("noise.weak_factor", self.weak_factor, "", 1.0, 100.0)?;
        require_in("noise.correlation_distance", self.correlation_distance, "m", 0.01, 100.0)?;
        require_in("noise.correlation_turn", self.correlation_turn, "rad", 0.01, 100.0)?;
        require_in("noise.scan_position", self.scan_position, "m", 0.001, 1.0)?;
        require_in("noise.scan_heading_deg", self.scan_heading_deg, "deg", 0.01, 30.0)?;
        require_in("noise.scan_correlation_distance", self.scan_correlation_distance, "m", 0.01, 100.0)?;
        require_in("noise.scan_correlation_turn", self.scan_correlation_turn, "rad", 0.01, 100.0)?;
        require_in("noise.wheelbase_sigma", self.wheelbase_sigma, "", 1e-4, 0.1)?;
        require_in("noise.delay_sigma", self.delay_sigma, "s", 1e-5, 0.5).map(drop)
    }
}

impl SmootherLimits {
    fn check(&self) -> Result<(), Invalid> {
        require_in("limits.gate", self.gate, "", 1.0, 100.0)?;
        require_in("limits.wrong_place_probability", self.wrong_place_probability, "", 1e-6, 0.5)?;
        require_in("limits.max_lead", self.max_lead, "s", 0.0, 1.0).map(drop)
    }
}
