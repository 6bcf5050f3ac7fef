//! Margins, time-outs and speeds of the safety monitor.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Twist2, require_in};

/// When to slow down and when to stop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct SafetyConfig {
    /// Deceleration of the base in a stop, m/s^2, 0.05 to 20. A larger value allows faster driving near obstacles; above the base's own the
    /// robot would stop too late. Default 0.5: [`DriveLimits::KOBUKI`](trundle_core::DriveLimits::KOBUKI); the base can do more.
    pub deceleration: f64,
    /// Angular deceleration of the base in a stop, rad/s^2, 0.1 to 100. It limits turns on the spot and tight curves: the robot brakes along
    /// its curve for as long as the slower of speed and turn rate takes. Default 3: `DriveLimits::KOBUKI`.
    pub angular_deceleration: f64,
    /// Smallest time from an image to the response of the wheels, s, 0 to 2. A larger value slows the robot near obstacles. Default 0.2: an
    /// image period, processing, delay and lag.
    pub latency: f64,
    /// Distance from an obstacle ahead at which the robot stops, m, 0 to 1. Default 0.04 (ours).
    pub stop_margin: f64,
    /// Distance from an obstacle on either side within which the robot stops, m, 0 to 0.5. A cell of the map counts as a disc. Default
    /// 0.01: the noise of a scan point.
    pub side_margin: f64,
    /// Distance from an obstacle on either side within which the robot slows to `creep_speed`, m, at least `side_margin`, to 1. Default
    /// 0.05 (ours).
    pub slow_margin: f64,
    /// Speed past obstacles within `slow_margin`, m/s, 0.02 to 1. Default 0.12 (ours).
    pub creep_speed: f64,
    /// Highest speed backward, out of the camera's view, m/s, 0.02 to 2. Default 0.2 (ours).
    pub reverse_speed: f64,
    /// Highest speed of backing out while the bumper is pressed, m/s, 0.01 to 0.5. The robot backs out at 0.05 m/s. Default 0.05 (ours).
    pub back_out_speed: f64,
    /// Highest speed of commanded wheels without encoder counts, m/s, 0.02 to 2. Default 0.15 (ours): 1 cm from image to image.
    pub uncounted_speed: f64,
    /// Speed below which a command is replaced by a stop, m/s, 0.001 to 0.1. Default 0.01 (ours).
    pub min_speed: f64,
    /// Distance from the footprint within which the safety monitor also reads the map, m from the footprint, 0 to 5. Default 0.8: the
    /// camera's blind zone, and the area beside its view.
    pub memory_reach: f64,
    /// Age of the newest image above which the robot stops, s, 0.05 to 60. At smaller ages the speed limit falls with the age. Default 0.8:
    /// twelve missing images (ours).
    pub image_timeout: f64,
    /// Age of the newest wheel reading above which the robot stops, s, 0.02 to 60. Default 0.2: ten missing readings (ours).
    pub wheels_timeout: f64,
}

/// Time from a command to the response of the wheels, s. A larger time makes the robot slower with late images. Source: delay and lag of
/// the Kobuki, and a control period.
const COMMAND_RESPONSE_S: f64 = 0.12;
/// Highest speed with images older than the latency, m/s. A larger speed slows the robot less. Source: the top speed of the Kobuki.
const LATE_IMAGE_SPEED_M_PER_S: f64 = 0.7;

impl Default for SafetyConfig {
    fn default() -> Self {
        Self {
            deceleration: 0.5,
            angular_deceleration: 3.0,
            latency: 0.2,
            stop_margin: 0.04,
            side_margin: 0.01,
            slow_margin: 0.05,
            creep_speed: 0.12,
            reverse_speed: 0.2,
            back_out_speed: 0.05,
            uncounted_speed: 0.15,
            min_speed: 0.01,
            memory_reach: 0.8,
            image_timeout: 0.8,
            wheels_timeout: 0.2,
        }
    }
}

impl SafetyConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        let ranges = [
            ("deceleration", self.deceleration, "m/s^2", 0.05, 20.0),
            ("angular_deceleration", self.angular_deceleration, "rad/s^2", 0.1, 100.0),
            ("latency", self.latency, "s", 0.0, 2.0),
            ("stop_margin", self.stop_margin, "m", 0.0, 1.0),
            ("side_margin", self.side_margin, "m", 0.0, 0.5),
            ("slow_margin", self.slow_margin, "m", self.side_margin, 1.0),
            ("creep_speed", self.creep_speed, "m/s", 0.02, 1.0),
            ("reverse_speed", self.reverse_speed, "m/s", 0.02, 2.0),
            ("back_out_speed", self.back_out_speed, "m/s", 0.01, 0.5),
            ("uncounted_speed", self.uncounted_speed, "m/s", 0.02, 2.0),
            ("min_speed", self.min_speed, "m/s", 0.001, 0.1),
            ("memory_reach", self.memory_reach, "m", 0.0, 5.0),
            ("image_timeout", self.image_timeout, "s", 0.05, 60.0),
            ("wheels_timeout", self.wheels_timeout, "s", 0.02, 60.0),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("safety.{name}"), value, unit, low, high)?;
        }
        Ok(self)
    }

    /// Time from an image of this age to the response of the wheels, s. Late images reduce speed, not safety.
    pub(super) fn latency_for(&self, age: f64) -> f64 {
        self.latency.max(age + COMMAND_RESPONSE_S)
    }

    /// Highest speed with an image of `age` s, m/s: unlimited up to the latency, then from [`LATE_IMAGE_SPEED_M_PER_S`] down
    /// to zero at the
    /// time-out. It is a limit and not a factor on the command, because a factor would compound from command to command.
    pub(super) fn speed_at_age(&self, age: f64) -> f64 {
        let span = (self.image_timeout - self.latency).max(1e-3);
        if age <= self.latency {
            f64::INFINITY
        } else {
            LATE_IMAGE_SPEED_M_PER_S * ((self.image_timeout - age) / span).max(0.0)
        }
    }

    /// The highest speed, m/s, from which the robot stops within `distance` m on the curve of `twist`, `latency` s after the image.
    pub(super) fn speed_for(&self, twist: Twist2, distance: f64, latency: f64) -> f64 {
        let curvature = (twist.omega / twist.v).abs();
        let deceleration = self.deceleration.min(self.angular_deceleration / curvature);
        braking_speed(deceleration, latency, distance)
    }

    /// Distance from the command to rest, m: reaction, then braking along the curve. The slower of speed and turn rate sets the duration.
    pub(super) fn braking_distance(&self, twist: Twist2, latency: f64) -> f64 {
        let (v, omega) = (twist.v.abs(), twist.omega.abs());
        let duration = (v / self.deceleration).max(omega / self.angular_deceleration);
        v * (latency + duration / 2.0)
    }

    /// The highest turn rate from which it stops within `angle` rad, `latency` s after the image.
    pub(super) fn turn_rate_for(&self, angle: f64, latency: f64) -> f64 {
        braking_speed(self.angular_deceleration, latency, angle)
    }
}

fn braking_speed(deceleration: f64, latency: f64, distance: f64) -> f64 {
    let reaction = deceleration * latency;
    (reaction * reaction + 2.0 * deceleration * distance.max(0.0)).sqrt() - reaction
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reaction_and_braking_use_exactly_the_free_distance() {
        let config = SafetyConfig::default().validated().unwrap();
        // Straight, a wide curve, and a curve so tight that the turn rate takes longer to brake than the speed.
        for curvature in [0.0, 2.0, 20.0] {
            let speed =
                |distance, latency| config.speed_for(Twist2::new(0.3, 0.3 * curvature), distance, latency);
            let v = speed(0.8, config.latency);
            let twist = Twist2::new(v, v * curvature);
            assert!((config.braking_distance(twist, config.latency) - 0.8).abs() < 1e-12, "{curvature}");
            assert_eq!((speed(0.0, 0.2), speed(-1.0, 0.2)), (0.0, 0.0));
            assert!(speed(0.8, config.latency_for(0.5)) < v, "a late image");
        }
        assert_eq!(config.latency_for(0.05), 0.2, "a fresh image");
        assert_eq!((config.speed_at_age(0.1), config.speed_at_age(0.8)), (f64::INFINITY, 0.0));
        assert!((config.speed_at_age(0.5) - 0.35).abs() < 1e-12);
    }

    #[test]
    fn bad_numbers_are_refused_by_name() {
        let error = SafetyConfig { latency: -0.1, ..SafetyConfig::default() }.validated().unwrap_err();
        assert_eq!(error.field, "safety.latency");
    }
}
