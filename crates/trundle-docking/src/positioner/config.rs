use crate::config::DockingConfig;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// How motions are carried out on measured poses.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PositionerConfig {
    /// Standing still before every decision while the pose is averaged, s, 0.02 to 10. Default 0.4, which with coming to
    /// rest is the planner's `switch_time`.
    pub measure_time: f64,
    /// Part of the tolerances that motions aim to stay within, 0.05 to 1. Default 0.7: what is measured at rest as settled
    /// is settled.
    pub aim: f64,
    /// A settled robot moves again when an error grows beyond this many tolerances, 1 to 100. Default 2.
    pub release: f64,
    /// Decisions to move again after the goal was first met within `release` tolerances, 0 to 100; then it is accepted.
    /// Default 6.
    pub attempts: u32,
    /// Slowest straight command, m/s, 0.001 to 0.2: motors stick below. Default 0.02.
    pub creep_speed: f64,
    /// Slowest turn command, rad/s, 0.001 to 1. Default 0.06.
    pub creep_rate: f64,
    /// From command to motion, s, 0 to 1: braking begins that much earlier. Default 0.08.
    pub delay: f64,
    /// Part of the acceleration that braking counts on, 0.1 to 1. Default 0.7.
    pub braking: f64,
    /// Turn rate by heading error while driving straight, 1/s, 0 to 10. Default 1.5.
    pub heading_gain: f64,
    /// Overlap with an obstacle that is taken for an error of the pose, m, 0 to 0.02. Default 0.005: twice a
    /// localisation of 2 mm, and more.
    pub overlap: f64,
    /// Standard deviations of the pose that the margin covers, 0 to 10: it is what [`crate::margin_of`] says, at least the
    /// planner's own, at most `most_margin`. Default 3.
    pub sigmas: f64,
    /// The margin that a pose known badly may ask for, m, 0 to 0.5. Default 0.05 (ours).
    pub most_margin: f64,
    /// Waiting before planning again when there is no way, s, 0.1 to 100. Default 1.
    pub patience: f64,
    /// What a step may spend on planning, about, in counted steps of some 10 ns ([`crate::Space::work`]), 10^4 to 10^11: the
    /// robot stands until the plan is complete. Default 2 * 10^6 (ours: 20 ms, a fifth of a step at 10 Hz).
    pub step_work: u64,
}

impl Default for PositionerConfig {
    fn default() -> Self {
        Self {
            measure_time: 0.4,
            aim: 0.7,
            release: 2.0,
            attempts: 6,
            creep_speed: 0.02,
            creep_rate: 0.06,
            delay: 0.08,
            braking: 0.7,
            heading_gain: 1.5,
            overlap: 0.005,
            sigmas: 3.0,
            most_margin: 0.05,
            patience: 1.0,
            step_work: 2_000_000,
        }
    }
}

impl PositionerConfig {
    /// The planner's settings as they count in closed loop: poses are noisy, so that an overlap may be an error, and less margin
    /// is kept only where there is no other way.
    pub fn planner(&self, docking: DockingConfig) -> DockingConfig {
        DockingConfig { overlap: self.overlap, margin_saving: 1.0, ..docking }
    }

    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        let ranges = [
            ("measure_time", self.measure_time, "s", 0.02, 10.0),
            ("aim", self.aim, "", 0.05, 1.0),
            ("release", self.release, "", 1.0, 100.0),
            ("attempts", f64::from(self.attempts), "", 0.0, 100.0),
            ("creep_speed", self.creep_speed, "m/s", 0.001, 0.2),
            ("creep_rate", self.creep_rate, "rad/s", 0.001, 1.0),
            ("delay", self.delay, "s", 0.0, 1.0),
            ("braking", self.braking, "", 0.1, 1.0),
            ("heading_gain", self.heading_gain, "1/s", 0.0, 10.0),
            ("overlap", self.overlap, "m", 0.0, 0.02),
            ("sigmas", self.sigmas, "", 0.0, 10.0),
            ("most_margin", self.most_margin, "m", 0.0, 0.5),
            ("patience", self.patience, "s", 0.1, 100.0),
            ("step_work", self.step_work as f64, "", 1e4, 1e11),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("positioner.{name}"), value, unit, low, high)?;
        }
        Ok(self)
    }
}
