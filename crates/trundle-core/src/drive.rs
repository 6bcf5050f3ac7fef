//! Geometry and limits of a differential drive: wheel speeds from a twist, and saturation of a twist.

use crate::{Invalid, Twist2, require_positive};
use serde::{Deserialize, Serialize};

/// The geometry of a two-wheeled base.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DifferentialDrive {
    /// Radius of the driven wheels, m, above 0, in a robot file at most 0.5. Calibration estimates the remaining error. Without the table 0.035: the Kobuki.
    pub wheel_radius: f64,
    /// Distance between the driven wheels, m, above 0, in a robot file at most 2. Without the table 0.23: the Kobuki.
    pub wheelbase: f64,
    /// Number of encoder ticks per wheel turn, above 0. Without the table 2578.33: the Kobuki.
    pub ticks_per_turn: f64,
}

impl Default for DifferentialDrive {
    fn default() -> Self {
        Self::KOBUKI
    }
}

impl DifferentialDrive {
    /// The Kobuki of \[Li18\]: wheel radius 0.035 m, wheelbase 0.230 m, 2578.33 ticks per turn.
    pub const KOBUKI: Self = Self { wheel_radius: 0.035, wheelbase: 0.230, ticks_per_turn: 2578.33 };

    /// Checks the values and returns them.
    ///
    /// # Errors
    /// When a number is not finite and positive.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_positive("wheel_radius", self.wheel_radius, "m")?;
        require_positive("wheelbase", self.wheelbase, "m")?;
        require_positive("ticks_per_turn", self.ticks_per_turn, "")?;
        Ok(self)
    }

    /// Distance that the wheel's surface travels per tick, m.
    pub fn metres_per_tick(&self) -> f64 {
        std::f64::consts::TAU * self.wheel_radius / self.ticks_per_turn
    }

    /// Speeds of the circumferences of the wheels (left, right), m/s, for a twist of the base.
    pub fn wheel_speeds(&self, twist: Twist2) -> (f64, f64) {
        let turn = twist.omega * self.wheelbase / 2.0;
        (twist.v - turn, twist.v + turn)
    }

    /// The base's twist for wheel speeds (left, right), m/s.
    pub fn twist(&self, left: f64, right: f64) -> Twist2 {
        Twist2::new((left + right) / 2.0, (right - left) / self.wheelbase)
    }
}

/// Limits of speed and acceleration of the base.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DriveLimits {
    /// Highest speed of each wheel, m/s, above 0, in a robot file at most 5. It bounds |v| + wheelbase / 2 |omega|. Without the table 0.7: the Kobuki.
    pub wheel_speed: f64,
    /// Highest forward speed, m/s, above 0, in a robot file at most 5. Without the table 0.7: the Kobuki.
    pub v: f64,
    /// Highest turn rate, rad/s, above 0, in a robot file at most 15. Without the table 3.14 (180 deg/s): the Kobuki.
    pub omega: f64,
    /// Highest acceleration and deceleration, m/s^2, above 0, in a robot file at most 20. Without the table 0.5 (ours): gentle enough for a robot of 1 m height.
    pub acceleration: f64,
    /// Highest angular acceleration and deceleration, rad/s^2, above 0, in a robot file at most 100. Without the table 3 (ours).
    pub angular_acceleration: f64,
}

impl Default for DriveLimits {
    fn default() -> Self {
        Self::KOBUKI
    }
}

impl DriveLimits {
    /// The Kobuki of \[Li18\]: 0.70 m/s, 180 deg/s. The accelerations are ours: gentle enough for a 1 m high robot.
    pub const KOBUKI: Self = Self {
        wheel_speed: 0.70,
        v: 0.70,
        omega: std::f64::consts::PI,
        acceleration: 0.5,
        angular_acceleration: 3.0,
    };

    /// Returns valid limits unchanged.
    ///
    /// # Errors
    /// When a number is not finite and positive.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_positive("limits.wheel_speed", self.wheel_speed, "m/s")?;
        require_positive("limits.v", self.v, "m/s")?;
        require_positive("limits.omega", self.omega, "rad/s")?;
        require_positive("limits.acceleration", self.acceleration, "m/s^2")?;
        require_positive("limits.angular_acceleration", self.angular_acceleration, "rad/s^2")?;
        Ok(self)
    }

    /// The twist of the same curvature that keeps every speed limit, for a base of this `wheelbase` (m).
    pub fn saturate(&self, twist: Twist2, wheelbase: f64) -> Twist2 {
        let rim = twist.v.abs() + wheelbase / 2.0 * twist.omega.abs();
        let excess = (rim / self.wheel_speed).max(twist.v.abs() / self.v).max(twist.omega.abs() / self.omega);
        if excess > 1.0 { Twist2::new(twist.v / excess, twist.omega / excess) } else { twist }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twist_and_wheel_speeds_invert_each_other() {
        let twist = Twist2::new(0.4, -1.2);
        let (left, right) = DifferentialDrive::KOBUKI.wheel_speeds(twist);
        let back = DifferentialDrive::KOBUKI.twist(left, right);
        assert!((back.v - twist.v).abs() < 1e-15 && (back.omega - twist.omega).abs() < 1e-14);
    }

    #[test]
    fn saturation_keeps_the_curvature() {
        let fast = Twist2::new(1.4, 2.0);
        let slow = DriveLimits::KOBUKI.saturate(fast, 0.23);
        assert!((slow.omega / slow.v - fast.omega / fast.v).abs() < 1e-12);
        assert!((slow.v + 0.115 * slow.omega - 0.70).abs() < 1e-12);
    }
}
