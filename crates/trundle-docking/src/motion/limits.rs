//! Speeds, accelerations and pauses of docking motions.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Speeds of docking motions: every motion begins and ends at rest, with a trapezoidal speed profile.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionLimits {
    /// Largest speed of a straight move, m/s, 0.01 to 2. Default 0.25 (ours).
    pub speed: f64,
    /// Acceleration and deceleration of a straight move, m/s^2, 0.01 to 5. Default 0.5, as `DriveLimits::KOBUKI`.
    pub acceleration: f64,
    /// Largest turn rate, rad/s, 0.01 to 10. Default 1.2 (ours, as for point stabilisation in trundle-control).
    pub turn_rate: f64,
    /// Angular acceleration and deceleration, rad/s^2, 0.01 to 50. Default 3, as `DriveLimits::KOBUKI`.
    pub angular_acceleration: f64,
    /// Pause between two motions, to come to rest and measure the pose, s, 0 to 10. Default 0.5 (ours).
    pub switch_time: f64,
}

impl Default for MotionLimits {
    fn default() -> Self {
        Self { speed: 0.25, acceleration: 0.5, turn_rate: 1.2, angular_acceleration: 3.0, switch_time: 0.5 }
    }
}

impl MotionLimits {
    /// Returns valid limits unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("docking.limits.speed", self.speed, "m/s", 0.01, 2.0)?;
        require_in("docking.limits.acceleration", self.acceleration, "m/s^2", 0.01, 5.0)?;
        require_in("docking.limits.turn_rate", self.turn_rate, "rad/s", 0.01, 10.0)?;
        require_in("docking.limits.angular_acceleration", self.angular_acceleration, "rad/s^2", 0.01, 50.0)?;
        require_in("docking.limits.switch_time", self.switch_time, "s", 0.0, 10.0)?;
        Ok(self)
    }

    /// Time of a straight move over the distance `distance` (m, either sign) from rest to rest, s.
    pub fn drive_time(&self, distance: f64) -> f64 {
        rest_to_rest(distance.abs(), self.speed, self.acceleration)
    }

    /// Time of a turn in place by `angle` (rad, either sign) from rest to rest, s.
    pub fn turn_time(&self, angle: f64) -> f64 {
        rest_to_rest(angle.abs(), self.turn_rate, self.angular_acceleration)
    }

    /// Signed distance and speed `time` seconds after the start of a straight move over `distance`, m and m/s.
    pub fn drive_at(&self, distance: f64, time: f64) -> (f64, f64) {
        at_time(distance, time, self.speed, self.acceleration)
    }

    /// Signed angle and rate `time` seconds after the start of a turn by `angle`, rad and rad/s.
    pub fn turn_at(&self, angle: f64, time: f64) -> (f64, f64) {
        at_time(angle, time, self.turn_rate, self.angular_acceleration)
    }
}

/// Minimum time over the distance `distance` with bounded speed and acceleration: a trapezoidal speed profile, triangular for short distances.
fn rest_to_rest(distance: f64, speed: f64, acceleration: f64) -> f64 {
    if distance * acceleration >= speed * speed {
        distance / speed + speed / acceleration
    } else {
        2.0 * (distance / acceleration).sqrt()
    }
}

fn at_time(distance: f64, time: f64, speed: f64, acceleration: f64) -> (f64, f64) {
    let total = rest_to_rest(distance.abs(), speed, acceleration);
    let time = time.clamp(0.0, total);
    let ramp = (speed / acceleration).min(total / 2.0);
    let top = ramp * acceleration;
    let (done, rate) = if time < ramp {
        (0.5 * acceleration * time * time, acceleration * time)
    } else if time <= total - ramp {
        (top * (time - ramp / 2.0), top)
    } else {
        let left = total - time;
        (distance.abs() - 0.5 * acceleration * left * left, acceleration * left)
    };
    (done.copysign(distance), rate.copysign(distance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn profiles_end_exactly_and_keep_their_limits(distance in -3.0..3.0_f64, part in 0.0..1.0_f64) {
            let limits = MotionLimits::default();
            let total = limits.drive_time(distance);
            prop_assert!((limits.drive_at(distance, total).0 - distance).abs() < 1e-12);
            let (before, speed) = limits.drive_at(distance, total * part);
            let (after, _) = limits.drive_at(distance, total * part + 1e-6);
            prop_assert!(speed.abs() <= limits.speed + 1e-12);
            prop_assert!(((after - before) / 1e-6 - speed).abs() < 1e-5);
        }

        #[test]
        fn two_motions_are_never_faster_than_one(a in 0.0..3.0_f64, b in 0.0..3.0_f64) {
            let limits = MotionLimits::default();
            prop_assert!(limits.turn_time(a + b) <= limits.turn_time(a) + limits.turn_time(b) + 1e-12);
        }
    }
}
