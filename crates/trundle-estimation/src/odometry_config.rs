//! Configuration of the wheel odometry: noise of wheels and gyro, limits of readings.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Noise of wheels and gyro, and limits of their readings.
///
/// Variances grow like those of a random walk, with distance, turn and time: they do not depend on the rate of the readings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct OdometryConfig {
    /// Noise of the position along the motion: sigma after 1 m, m / sqrt(m), 0 to 1. A larger value trusts images and scans more. Default
    /// 0.02: wheel radius and floor.
    pub distance_noise: f64,
    /// Noise of the position across the motion: sigma after 1 m, m / sqrt(m), 0 to 1. Default 0.001: driven wheels hardly slide sideways;
    /// models of odometry (Chong and Kleeman 1997) have no such noise.
    pub sideways_noise: f64,
    /// Noise of the position by turns: sigma after a turn of 1 rad, m / sqrt(rad), 0 to 1. Default 0.002: each wheel slips 2 mm in 0.1 m,
    /// and the contact points of the tyres move.
    pub spot_noise: f64,
    /// Noise of the heading by the wheels: sigma after a turn of 1 rad, rad / sqrt(rad), 0 to 1. Default 0.05: the effective wheelbase
    /// depends on the contact points of the tyres.
    pub wheel_turn_noise: f64,
    /// Noise of the heading by the wheels: sigma after 1 m, rad / sqrt(m), 0 to 1. Default 0.02: unequal wheels.
    pub wheel_distance_noise: f64,
    /// Noise of the heading by the gyro, besides the error of its scale: sigma after a turn of 1 rad, rad / sqrt(rad), 0 to 1. Default
    /// 0.002 (ours): 2 mrad, or 0.1 deg, per turn of 1 rad.
    pub gyro_turn_noise: f64,
    /// Noise of the heading by the gyro, besides the error of its bias: sigma after 1 s, rad / sqrt(s), 0 to 1. Default 0.0007: the angle
    /// random walk of a small gyro, 0.04 deg / s / sqrt(Hz).
    pub gyro_time_noise: f64,
    /// Prior sigma of a wheel's radius, as a fraction of the nominal one, 0 (never estimated) to 0.1. Default 0.01: worn tyres.
    pub wheel_radius_sigma: f64,
    /// Noise of one gyro reading (one sigma), rad/s, above 0, to 1. Default 0.005: a third more than 0.03 deg / s / sqrt(Hz) at 50 Hz.
    pub gyro_rate_noise: f64,
    /// Prior sigma of the gyro's bias at the start, rad/s, 0 (never estimated) to 1. Default 0.02 (ours): 1.1 deg/s.
    pub gyro_bias_sigma: f64,
    /// Prior sigma of the gyro's scale, ratio, 0 (never estimated) to 0.1. Default 0.005: a small gyro with a factory
    /// calibration.
    pub gyro_scale_sigma: f64,
    /// Random walk of the gyro's bias, rad/s / sqrt(s), 0 to 0.1. A larger value follows a changing bias sooner. Default 0.0002 (ours):
    /// 0.0015 rad/s after a minute.
    pub gyro_bias_walk: f64,
    /// Time of wheels at rest after which the robot counts as at rest, s, 0.05 to 10. The gyro's bias is then measured. Default 0.3 (ours):
    /// 15 readings at 50 Hz.
    pub still_time: f64,
    /// Largest age of the gyro's last reading, s, 0.02 to 2. Up to this age its rate is extrapolated; beyond it the wheels give the turn.
    /// Default 0.05: two readings at 50 Hz.
    pub gyro_timeout: f64,
    /// Largest difference of the turn rates by wheels and gyro without slip, rad/s, 0.01 to 10. A smaller value detects weaker slips, and
    /// false ones. Default 0.2: above the tick's step (0.02 rad/s at 50 Hz) and a wheelbase error of 5 % at 180 deg/s.
    pub slip_rate: f64,
    /// Growth of the variance during a slip, per metre of difference between wheels and gyro, m, 0 to 10. Default 0.1: the length of a
    /// slip.
    pub slip_length: f64,
    /// Largest speed of a wheel, m/s, 0.05 to 20. Faster readings are rejected. Default 2: three times the Kobuki's maximum.
    pub max_speed: f64,
    /// Largest time between two readings, s, 0.05 to 5. The motion in a longer gap counts as unknown. Default 0.6 (ours): 30 readings at 50
    /// Hz.
    pub max_gap: f64,
    /// Speed of the unknown motion in a gap (one sigma), m/s, 0 to 10. The turn has 3 rad per metre. Default 0.3 (ours): less than half of
    /// the Kobuki's maximum.
    pub gap_speed: f64,
}

impl Default for OdometryConfig {
    fn default() -> Self {
        Self {
            distance_noise: 0.02,
            sideways_noise: 0.001,
            spot_noise: 0.002,
            wheel_turn_noise: 0.05,
            wheel_distance_noise: 0.02,
            gyro_turn_noise: 0.002,
            gyro_time_noise: 0.0007,
            wheel_radius_sigma: 0.01,
            gyro_rate_noise: 0.005,
            gyro_bias_sigma: 0.02,
            gyro_scale_sigma: 0.005,
            gyro_bias_walk: 0.0002,
            still_time: 0.3,
            gyro_timeout: 0.05,
            slip_rate: 0.2,
            slip_length: 0.1,
            max_speed: 2.0,
            max_gap: 0.6,
            gap_speed: 0.3,
        }
    }
}

impl OdometryConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("distance_noise", self.distance_noise, "m/sqrt(m)", 0.0, 1.0)?;
        require_in("sideways_noise", self.sideways_noise, "m/sqrt(m)", 0.0, 1.0)?;
        require_in("spot_noise", self.spot_noise, "m/sqrt(rad)", 0.0, 1.0)?;
        require_in("wheel_turn_noise", self.wheel_turn_noise, "rad/sqrt(rad)", 0.0, 1.0)?;
        require_in("wheel_distance_noise", self.wheel_distance_noise, "rad/sqrt(m)", 0.0, 1.0)?;
        require_in("gyro_turn_noise", self.gyro_turn_noise, "rad/sqrt(rad)", 0.0, 1.0)?;
        require_in("gyro_time_noise", self.gyro_time_noise, "rad/sqrt(s)", 0.0, 1.0)?;
        require_in("wheel_radius_sigma", self.wheel_radius_sigma, "", 0.0, 0.1)?;
        require_in("gyro_rate_noise", self.gyro_rate_noise, "rad/s", 1e-6, 1.0)?;
        require_in("gyro_bias_sigma", self.gyro_bias_sigma, "rad/s", 0.0, 1.0)?;
        require_in("gyro_scale_sigma", self.gyro_scale_sigma, "", 0.0, 0.1)?;
        require_in("gyro_bias_walk", self.gyro_bias_walk, "rad/s/sqrt(s)", 0.0, 0.1)?;
        require_in("still_time", self.still_time, "s", 0.05, 10.0)?;
        require_in("gyro_timeout", self.gyro_timeout, "s", 0.02, 2.0)?;
        require_in("slip_rate", self.slip_rate, "rad/s", 0.01, 10.0)?;
        require_in("slip_length", self.slip_length, "m", 0.0, 10.0)?;
        require_in("max_speed", self.max_speed, "m/s", 0.05, 20.0)?;
        require_in("max_gap", self.max_gap, "s", 0.05, 5.0)?;
        require_in("gap_speed", self.gap_speed, "m/s", 0.0, 10.0)?;
        Ok(self)
    }
}
