//! True parameters of the simulated Kobuki base.

use serde::{Deserialize, Serialize};
use trundle_core::{DifferentialDrive, DriveLimits, Footprint, Invalid, Vector2, require_in};

/// The true robot: its data sheet, and how this one differs from it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct KobukiConfig {
    /// Nominal geometry: that of the motor controller and the odometry. Default the Kobuki of \[Li18\].
    pub drive: DifferentialDrive,
    /// Highest speed of a wheel's circumference, m/s, 0.01 to 10; faster commands are slowed along the same curve. Default 0.70 \[Li18\].
    pub wheel_speed: f64,
    /// Highest acceleration of a wheel's circumference, m/s^2, 0.01 to 100. Default 1.2: above the limits of trundle's commands, below slipping.
    pub wheel_acceleration: f64,
    /// Time constant of the speed loop, a first-order lag, s, 0 to 2. Default 0.05, typical of small geared motors.
    pub motor_lag: f64,
    /// Delay from a command to its effect, s, 0 to 2. Default 0.02: one cycle of the Kobuki's 50 Hz serial protocol.
    pub command_delay: f64,
    /// Time without a command after which the base stops, s, 0 (never) to 60. Default 0: the Kobuki keeps its last command. Its driver
    /// kobuki_node stops it, by default after 0.6 s (`cmd_vel_timeout`).
    pub command_timeout: f64,
    /// Standard deviation of each wheel's radius over the nominal one, 0 to 0.1. Default 0.003: the unequal diameters
    /// of \[Borenstein96\] are of this size.
    pub wheel_radius_error: f64,
    /// Standard deviation of the wheelbase over the nominal one, 0 to 0.1. Default 0.003 \[Borenstein96\].
    pub wheelbase_error: f64,
    /// Standard deviation of each wheel's slip, fraction of its distance, 0 to 0.5. Default 0.005: with `slip_time` about 2 mm a wheel after
    /// 1 m at 0.3 m/s, as of a robot on a hard floor \[Chong97\].
    pub slip: f64,
    /// Correlation time of slip, s, 0.001 to 10. Default 0.3: a tenth of a metre of floor.
    pub slip_time: f64,
    /// Readings of the encoders per second, Hz, 1 to 1000. Default 50, the Kobuki's.
    pub wheel_rate_hz: f64,
    /// Readings of the gyro per second, Hz, 1 to 1000. Default 50, the Kobuki's.
    pub gyro_rate_hz: f64,
    /// White noise of a gyro reading, rad/s, 0 to 1. Default 0.0037: 0.03 deg/s/sqrt(Hz) over 50 Hz, the L3G4200D's data sheet.
    pub gyro_noise: f64,
    /// Standard deviation of the gyro's bias at the start, rad/s, 0 to 1. Default 0.005: 0.3 deg/s left by calibration.
    pub gyro_bias: f64,
    /// Random walk of the gyro's bias, rad/s/sqrt(s), 0 to 1. Default 0.0002: 0.1 deg/s after 90 s.
    pub gyro_bias_walk: f64,
    /// Standard deviation of the gyro's scale, 0 to 0.1. Default 0.003, after the Kobuki's factory calibration.
    pub gyro_scale_error: f64,
    /// Radius of the round base, m, 0.01 to 2. Default 0.1755: 0.351 m across (its data sheet).
    pub footprint_radius: f64,
    /// Corners of a convex outline instead of the round one, base frame, m. Default none.
    pub footprint: Option<Vec<[f64; 2]>>,
    /// Places of the cliff sensors, base frame, m; without any there is no cliff event. Default the Kobuki's three, as its
    /// robot description (kobuki_description, URDF) has them.
    pub cliff_sensors: Vec<[f64; 2]>,
    /// Smallest drop under a cliff sensor that is a cliff, m, 0.01 to 1. Default 0.05, the Kobuki's.
    pub cliff_depth: f64,
    /// Height of the robot with its camera, m, 0.05 to 3. Default 0.6: it passes under a table of 0.72 m, not under one of 0.45 m.
    pub height: f64,
    /// Largest height of a ridge that the base drives over, m, 0.001 to 0.04. Default 0.012, the Kobuki's step climbing.
    pub step_over: f64,
}

impl Default for KobukiConfig {
    fn default() -> Self {
        Self {
            drive: DifferentialDrive::KOBUKI,
            wheel_speed: DriveLimits::KOBUKI.wheel_speed,
            wheel_acceleration: 1.2,
            motor_lag: 0.05,
            command_delay: 0.02,
            command_timeout: 0.0,
            wheel_radius_error: 0.003,
            wheelbase_error: 0.003,
            slip: 0.005,
            slip_time: 0.3,
            wheel_rate_hz: 50.0,
            gyro_rate_hz: 50.0,
            gyro_noise: 0.0037,
            gyro_bias: 0.005,
            gyro_bias_walk: 0.0002,
            gyro_scale_error: 0.003,
            footprint_radius: 0.1755,
            footprint: None,
            cliff_sensors: vec![[0.156, 0.0], [0.087, 0.136], [0.085, -0.136]],
            cliff_depth: 0.05,
            height: 0.6,
            step_over: 0.012,
        }
    }
}

impl KobukiConfig {
    /// The same body with the numbers of its data sheet and without noise; dynamics stay.
    pub fn without_noise(self) -> Self {
        Self {
            wheel_radius_error: 0.0,
            wheelbase_error: 0.0,
            slip: 0.0,
            gyro_noise: 0.0,
            gyro_bias: 0.0,
            gyro_bias_walk: 0.0,
            gyro_scale_error: 0.0,
            ..self
        }
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        self.drive.validated()?;
        let ranges = [
            ("wheel_speed", self.wheel_speed, "m/s", 0.01, 10.0),
            ("wheel_acceleration", self.wheel_acceleration, "m/s^2", 0.01, 100.0),
            ("motor_lag", self.motor_lag, "s", 0.0, 2.0),
            ("command_delay", self.command_delay, "s", 0.0, 2.0),
            ("command_timeout", self.command_timeout, "s", 0.0, 60.0),
            ("wheel_radius_error", self.wheel_radius_error, "", 0.0, 0.1),
            ("wheelbase_error", self.wheelbase_error, "", 0.0, 0.1),
            ("slip", self.slip, "", 0.0, 0.5),
            ("slip_time", self.slip_time, "s", 0.001, 10.0),
            ("wheel_rate_hz", self.wheel_rate_hz, "Hz", 1.0, 1000.0),
            ("gyro_rate_hz", self.gyro_rate_hz, "Hz", 1.0, 1000.0),
            ("gyro_noise", self.gyro_noise, "rad/s", 0.0, 1.0),
            ("gyro_bias", self.gyro_bias, "rad/s", 0.0, 1.0),
            ("gyro_bias_walk", self.gyro_bias_walk, "rad/s/sqrt(s)", 0.0, 1.0),
            ("gyro_scale_error", self.gyro_scale_error, "", 0.0, 0.1),
            ("footprint_radius", self.footprint_radius, "m", 0.01, 2.0),
            ("cliff_depth", self.cliff_depth, "m", 0.01, 1.0),
            ("height", self.height, "m", 0.05, 3.0),
            ("step_over", self.step_over, "m", 0.001, 0.04),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("kobuki.{name}"), value, unit, low, high)?;
        }
        for (i, place) in self.cliff_sensors.iter().enumerate() {
            for x in place {
                require_in(&format!("kobuki.cliff_sensors[{i}]"), *x, "m", -5.0, 5.0)?;
            }
        }
        self.outline()?;
        Ok(self)
    }

    /// The outline of the base: the polygon if there is one, else the disc.
    ///
    /// # Errors
    /// When the polygon is not one: fewer than three corners, not convex, not finite; or the radius is not positive.
    pub fn outline(&self) -> Result<Footprint, Invalid> {
        match &self.footprint {
            Some(corners) => Footprint::polygon(corners.iter().map(|c| Vector2::new(c[0], c[1])).collect()),
            None => Footprint::disc(self.footprint_radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_numbers_are_refused_by_name() {
        let error = KobukiConfig { slip: f64::NAN, ..KobukiConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "kobuki.slip");
        assert!(KobukiConfig::default().validated().is_ok());
        assert!(KobukiConfig::default().without_noise().validated().is_ok());
        let flat = KobukiConfig { footprint: Some(vec![[0.0, 0.0], [1.0, 1.0]]), ..KobukiConfig::default() };
        assert_eq!(flat.validated().unwrap_err().field, "footprint corners");
        let far = KobukiConfig { cliff_sensors: vec![[0.1, f64::NAN]], ..KobukiConfig::default() };
        assert_eq!(far.validated().unwrap_err().field, "kobuki.cliff_sensors[0]");
    }
}
