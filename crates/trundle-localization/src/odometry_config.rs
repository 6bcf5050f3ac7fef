use crate::odometry_noise::{Step, of_step};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose2, require_in};

/// How far wheels and gyro are trusted.
///
/// Variances grow like those of a random walk: with way, turn and time, so that they do not depend on the rate of the
/// readings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OdometryConfig {
    /// Along the way, sigma after 1 m, m / sqrt(m), 0 to 1. Default 0.02: wheel radius and floor, a usual indoor figure.
    pub way_noise: f64,
    /// Across the way, sigma after 1 m, m / sqrt(m), 0 to 1. Default 0.001: driven wheels roll, they do not slide; models of odometry
    /// (Chong and Kleeman 1997) have none. That the camera sees no sideways motion either is what tells turning from it.
    pub sideways_noise: f64,
    /// The place, sigma after a turn of 1 rad, m / sqrt(rad), 0 to 1. Default 0.002: rims that slip 2 mm in 0.1 m of way each, and
    /// wheels that touch off their middle.
    pub spot_noise: f64,
    /// Heading by the wheels, sigma after a turn of 1 rad, rad / sqrt(rad), 0 to 1. Default 0.05: the effective wheelbase
    /// depends on where the tyres touch.
    pub wheel_turn_noise: f64,
    /// Heading by the wheels, sigma after 1 m, rad / sqrt(m), 0 to 1. Default 0.02: unequal wheels.
    pub wheel_way_noise: f64,
    /// Heading by the gyro, sigma after a turn of 1 rad, rad / sqrt(rad), 0 to 1, besides what its scale may be off. Default 0.002.
    pub gyro_turn_noise: f64,
    /// Heading by the gyro, sigma after 1 s, rad / sqrt(s), 0 to 1, besides what its bias may be off. Default 0.0007: the angle random
    /// walk of a small gyro, 0.04 deg / s / sqrt(Hz).
    pub gyro_time_noise: f64,
    /// What a wheel's radius may be off its nominal one before it was learnt (one sigma, as a part), 0 (never learnt) to 0.1.
    /// Default 0.01: worn tyres.
    pub wheel_radius_sigma: f64,
    /// Noise of one gyro reading (one sigma), rad/s, above 0, to 1. Default 0.005: a third more than 0.03 deg / s / sqrt(Hz) at 50 Hz.
    pub gyro_rate_noise: f64,
    /// What the gyro's bias may be before it was measured (one sigma), rad/s, 0 (never learnt) to 1. Default 0.02.
    pub gyro_bias_sigma: f64,
    /// What the gyro's scale may be off before it was learnt (one sigma, as a part), 0 (never learnt) to 0.1. Default 0.005: a small
    /// gyro, calibrated at the factory.
    pub gyro_scale_sigma: f64,
    /// How the bias wanders, rad/s / sqrt(s), 0 to 0.1. Default 0.0002.
    pub gyro_bias_walk: f64,
    /// Wheels at rest for this long are a robot at rest, s, 0.05 to 10: then the bias is measured. Default 0.3.
    pub still_time: f64,
    /// The gyro is missing when its last reading is older than this, s, 0.02 to 2. Default 0.05: two readings at 50 Hz.
    /// So long its rate is held.
    pub gyro_timeout: f64,
    /// Wheels and gyro whose turn rates differ by more than this slip, rad/s, 0.01 to 10. Default 0.2: above the tick's
    /// step (0.02 rad/s at 50 Hz) and a wheelbase wrong by 5 % at 180 deg/s.
    pub slip_rate: f64,
    /// While slipping, the variance grows by this length for each metre that wheels and gyro disagree by, m, 0 to 10.
    /// Default 0.1: a slip lasts about that long.
    pub slip_length: f64,
    /// Rim speeds above this are broken readings, m/s, 0.05 to 20. Default 2: thrice the Kobuki's best.
    pub max_speed: f64,
    /// Readings farther apart than this leave the way between unknown, s, 0.05 to 5. Default 0.6.
    pub max_gap: f64,
    /// How fast the robot may have moved in such a gap (one sigma), m/s, 0 to 10. Default 0.3. Turns count 3 rad a metre.
    pub gap_speed: f64,
}

impl Default for OdometryConfig {
    fn default() -> Self {
        Self {
            way_noise: 0.02,
            sideways_noise: 0.001,
            spot_noise: 0.002,
            wheel_turn_noise: 0.05,
            wheel_way_noise: 0.02,
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
    /// The covariance of a small motion of the base that wheels without a gyro have told, as a right perturbation (x m, y m, theta
    /// rad).
    pub fn by_wheels(&self, motion: &Pose2) -> Matrix3<f64> {
        let way = motion.x.hypot(motion.y);
        of_step(self, &Step { way, turn: motion.theta, dt: 0.0, by_gyro: None, slip: 0.0 })
    }

    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("way_noise", self.way_noise, "m/sqrt(m)", 0.0, 1.0)?;
        require_in("sideways_noise", self.sideways_noise, "m/sqrt(m)", 0.0, 1.0)?;
        require_in("spot_noise", self.spot_noise, "m/sqrt(rad)", 0.0, 1.0)?;
        require_in("wheel_turn_noise", self.wheel_turn_noise, "rad/sqrt(rad)", 0.0, 1.0)?;
        require_in("wheel_way_noise", self.wheel_way_noise, "rad/sqrt(m)", 0.0, 1.0)?;
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
