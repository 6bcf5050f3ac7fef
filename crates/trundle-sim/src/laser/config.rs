//! Parameters of a simulated 2-D laser range finder.

use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, TAU};
use trundle_core::{Invalid, require_in};

/// A 2-D laser range finder: its mount, its field of view, and its errors.
///
/// Presets: [`LaserConfig::rplidar_a1`], [`LaserConfig::urg_04lx`], [`LaserConfig::ust_10lx`], [`LaserConfig::lds_01`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct LaserConfig {
    /// Before the base's origin, m, -5 to 5. Default 0.
    pub x: f64,
    /// Left of the base's origin, m, -5 to 5. Default 0.
    pub y: f64,
    /// Height above the floor, m, 0.01 to 5. Default 0.2: on top of a Kobuki.
    pub z: f64,
    /// Direction of the middle of the field of view, from the base's x, rad, -2 pi to 2 pi. Default 0.
    pub yaw: f64,
    /// Angle between first and last beam, rad, 0.001 to 2 pi; a full turn counts its first beam once. Default 2 pi.
    pub field_of_view: f64,
    /// Beams a scan, 1 to 100,000. Default 360.
    pub beams: usize,
    /// Scans per second, Hz, 0.1 to 200. Default 10.
    pub rate_hz: f64,
    /// Nearer things are not measured, m, 0 to 100. Default 0.1.
    pub range_min: f64,
    /// Farther things send nothing back, m, above `range_min` to 1000. Default 12.
    pub range_max: f64,
    /// Standard deviation of a range, m, 0 to 1. Default 0.
    pub noise: f64,
    /// Standard deviation of a range, part of it, 0 to 0.5; adds to `noise` as a square. Default 0.
    pub noise_part: f64,
    /// Step of the ranges, m, 0 to 1; with 0 ranges have no step. Default 0.
    pub quantum: f64,
    /// Share of beams that fail, 0 to 1. Default 0.
    pub drop_out: f64,
    /// Surfaces that the beam meets at more than this from their normal send nothing back, rad, 0 to pi/2. Default pi/2: all
    /// are seen.
    pub max_incidence: f64,
    /// Whether a beam that brings nothing back is reported as free up to `range_max`, as drivers do that publish +Inf
    /// (ROS REP 117); else as unseen. Default true.
    pub silence_is_free: bool,
    /// Whether the beams of a scan are measured one after the other, the last at the scan's stamp, while the robot moves on;
    /// else all at the stamp. Default false.
    pub sweeps: bool,
}

impl Default for LaserConfig {
    fn default() -> Self {
        Self {
            x: 0.0,
            y: 0.0,
            z: 0.2,
            yaw: 0.0,
            field_of_view: TAU,
            beams: 360,
            rate_hz: 10.0,
            range_min: 0.1,
            range_max: 12.0,
            noise: 0.0,
            noise_part: 0.0,
            quantum: 0.0,
            drop_out: 0.0,
            max_incidence: FRAC_PI_2,
            silence_is_free: true,
            sweeps: false,
        }
    }
}

impl LaserConfig {
    /// The same laser without noise, quantisation, losses and motion; range and rate stay.
    pub fn without_noise(self) -> Self {
        Self {
            noise: 0.0,
            noise_part: 0.0,
            quantum: 0.0,
            drop_out: 0.0,
            max_incidence: FRAC_PI_2,
            sweeps: false,
            ..self
        }
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        let ranges = [
            ("x", self.x, "m", -5.0, 5.0),
            ("y", self.y, "m", -5.0, 5.0),
            ("z", self.z, "m", 0.01, 5.0),
            ("yaw", self.yaw, "rad", -TAU, TAU),
            ("field_of_view", self.field_of_view, "rad", 0.001, TAU),
            ("rate_hz", self.rate_hz, "Hz", 0.1, 200.0),
            ("range_min", self.range_min, "m", 0.0, 100.0),
            ("range_max", self.range_max, "m", self.range_min + 1e-3, 1000.0),
            ("noise", self.noise, "m", 0.0, 1.0),
            ("noise_part", self.noise_part, "", 0.0, 0.5),
            ("quantum", self.quantum, "m", 0.0, 1.0),
            ("drop_out", self.drop_out, "", 0.0, 1.0),
            ("max_incidence", self.max_incidence, "rad", 0.0, FRAC_PI_2),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("laser.{name}"), value, unit, low, high)?;
        }
        if !(1..=100_000).contains(&self.beams) {
            return Err(Invalid::new("laser.beams", self.beams, "", "1 to 100000"));
        }
        Ok(self)
    }

    /// The angle between neighbouring beams, rad.
    pub fn increment(&self) -> f64 {
        let is_full_turn = self.field_of_view > TAU - 1e-9;
        let steps = if is_full_turn { self.beams } else { (self.beams - 1).max(1) };
        self.field_of_view / steps as f64
    }

    /// The bearing of the first beam, rad, base frame.
    pub fn angle_min(&self) -> f64 {
        self.yaw - self.field_of_view / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_turn_does_not_look_twice_behind() {
        let full = LaserConfig::default();
        assert!((full.increment() - 1_f64.to_radians()).abs() < 1e-12);
        let fan = LaserConfig { field_of_view: 2.0, beams: 5, yaw: 0.3, ..full };
        assert_eq!((fan.increment(), fan.angle_min()), (0.5, -0.7));
    }

    #[test]
    fn bad_numbers_are_refused_by_name() {
        let field = |config: LaserConfig| config.validated().unwrap_err().field;
        assert_eq!(field(LaserConfig { noise: f64::NAN, ..LaserConfig::default() }), "laser.noise");
        assert_eq!(field(LaserConfig { beams: 0, ..LaserConfig::default() }), "laser.beams");
        assert_eq!(field(LaserConfig { range_max: 0.05, ..LaserConfig::default() }), "laser.range_max");
        assert!(LaserConfig::default().validated().is_ok());
    }
}
