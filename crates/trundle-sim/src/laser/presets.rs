//! Presets of laser range finders from their data sheets.

use super::LaserConfig;
use crate::config::Preset;
use std::f64::consts::TAU;

/// Angle between beams of Hokuyo's URG series: 1024 a turn. Source: Hokuyo's data sheets.
const URG_STEP: f64 = TAU / 1024.0;

/// Lasers according to their data sheets. The accuracy in a data sheet is a bound with a systematic part; the noise here is a third of it
/// unless the sheet gives a standard deviation.
impl LaserConfig {
    /// The lasers of a front end: name, help text, configuration.
    pub const PRESETS: [Preset<Self>; 4] = [
        ("rplidar-a1", "Slamtec RPLIDAR A1: all around, 12 m", Self::rplidar_a1),
        ("urg-04lx", "Hokuyo URG-04LX: 240 deg, 5.6 m", Self::urg_04lx),
        ("ust-10lx", "Hokuyo UST-10LX: 270 deg, 10 m", Self::ust_10lx),
        ("lds-01", "LDS-01 of the TurtleBot3: all around, 3.5 m", Self::lds_01),
    ];

    /// Slamtec RPLIDAR A1M8: 0.15 to 12 m, 5.5 Hz, 1 deg, resolution 0.5 mm near and below 1 % of the range
    /// (Introduction and Datasheet, rev. 1.0, 2016, and rev. 3.0, 2020).
    pub fn rplidar_a1() -> Self {
        Self {
            rate_hz: 5.5,
            range_min: 0.15,
            noise: 0.002,
            noise_part: 0.0033,
            quantum: 0.0005,
            drop_out: 0.005,
            max_incidence: 80_f64.to_radians(),
            sweeps: true,
            ..Self::default()
        }
    }

    /// Hokuyo URG-04LX: 0.02 to 5.6 m, 682 beams of 1024 a turn (steps 44 to 725 about 384), 10 Hz, whole millimetres (its
    /// SCIP 2.0 specification); accuracy 10 mm up to 1 m and 1 % beyond, so here a third of it.
    pub fn urg_04lx() -> Self {
        Self {
            yaw: 0.5 * URG_STEP,
            field_of_view: 681.0 * URG_STEP,
            beams: 682,
            range_min: 0.02,
            range_max: 5.6,
            noise: 0.003,
            noise_part: 0.0033,
            quantum: 0.001,
            drop_out: 0.002,
            max_incidence: 80_f64.to_radians(),
            sweeps: true,
            ..Self::default()
        }
    }

    /// Hokuyo UST-10LX: 0.06 to 10 m, 270 deg, 1081 beams every 0.25 deg, 40 Hz, whole millimetres (its specification);
    /// accuracy 40 mm, so here a standard deviation of 13 mm.
    pub fn ust_10lx() -> Self {
        Self {
            field_of_view: 270_f64.to_radians(),
            beams: 1081,
            rate_hz: 40.0,
            range_min: 0.06,
            range_max: 10.0,
            noise: 0.013,
            quantum: 0.001,
            drop_out: 0.001,
            max_incidence: 85_f64.to_radians(),
            sweeps: true,
            ..Self::default()
        }
    }

    /// LDS-01 of the TurtleBot3 (HLS-LFCD2): 0.12 to 3.5 m, 1 deg, 5 Hz, whole millimetres, precision 10 mm up to 0.5 m and
    /// 3.5 % beyond (ROBOTIS e-Manual), so here a third of it.
    pub fn lds_01() -> Self {
        Self {
            rate_hz: 5.0,
            range_min: 0.12,
            range_max: 3.5,
            noise: 0.003,
            noise_part: 0.0117,
            quantum: 0.001,
            drop_out: 0.01,
            max_incidence: 80_f64.to_radians(),
            sweeps: true,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_are_valid_and_look_straight_ahead_with_a_beam() {
        let presets = [
            LaserConfig::rplidar_a1(),
            LaserConfig::urg_04lx(),
            LaserConfig::ust_10lx(),
            LaserConfig::lds_01(),
        ];
        for laser in presets {
            let laser = laser.validated().unwrap();
            let ahead = -laser.angle_min() / laser.increment();
            assert!((ahead - ahead.round()).abs() < 1e-6, "{ahead}");
        }
        let urg = LaserConfig::urg_04lx();
        assert!((urg.angle_min() + 340.0 * URG_STEP).abs() < 1e-12, "step 44 is 340 before the front");
    }
}
