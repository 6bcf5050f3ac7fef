//! Configuration of the positioner.

use crate::docking_config::DockingConfig;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Parameters of closed-loop positioning.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct PositionerConfig {
    /// Time at rest before every decision, in which the pose is averaged, s, 0.02 to 10. Default 0.4: with the time to come to rest, the
    /// planner's `switch_time`.
    pub measure_time: f64,
    /// Fraction of the tolerances within which motions shall end, 0.05 to 1. Default 0.7: the pose measured at rest is then within the
    /// tolerances.
    pub aim: f64,
    /// Number of tolerances beyond which a robot at its goal moves again, 1 to 100. Default 2 (ours).
    pub release: f64,
    /// Number of further motions within `release` tolerances of the goal before the pose is accepted, 0 to 100. Default 6 (ours).
    pub attempts: u32,
    /// Smallest speed command, m/s, 0.001 to 0.2. Slower motors stick. Default 0.02 (ours).
    pub creep_speed: f64,
    /// Smallest turn rate command, rad/s, 0.001 to 1. Default 0.06 (ours).
    pub creep_rate: f64,
    /// Delay from command to motion, s, 0 to 1, by which braking begins earlier. Default 0.08 (ours).
    pub delay: f64,
    /// Fraction of the acceleration used for braking, 0.1 to 1. Default 0.7 (ours).
    pub braking: f64,
    /// Turn rate per heading error during a straight move, 1/s, 0 to 10. Default 1.5 (ours).
    pub heading_gain: f64,
    /// Largest overlap with an obstacle that counts as an error of the pose, m, 0 to 0.02. Default 0.005: more than twice a localization
    /// error of 2 mm.
    pub overlap: f64,
    /// Number of standard deviations of the pose that the margin covers, 0 to 10. The margin ([`crate::margin_of`]) is at least the
    /// planner's and at most `max_margin`. Default 3 (ours): 99.7 % of a normal distribution.
    pub sigmas: f64,
    /// Largest margin for an uncertain pose, m, 0 to 0.5. Default 0.05 (ours).
    pub max_margin: f64,
    /// Time without a manoeuvre before the next plan, s, 0.1 to 100. Default 1 (ours).
    pub patience: f64,
    /// Work of planning per step, in counted steps of some 10 ns ([`crate::ContactSpace::work`]), 10^4 to 10^11. The robot is at rest until
    /// the plan is complete. Default 2 * 10^6 (ours: 20 ms, a fifth of a step at 10 Hz); in the robot file 60,000.
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
            max_margin: 0.05,
            patience: 1.0,
            step_work: 2_000_000,
        }
    }
}

impl PositionerConfig {
    /// The planner's configuration for closed loop with noisy poses: an overlap may be an error, and a smaller margin is used only without
    /// another manoeuvre.
    pub fn planner(&self, docking: DockingConfig) -> DockingConfig {
        DockingConfig { overlap: self.overlap, margin_saving: 1.0, ..docking }
    }

    /// Returns a valid configuration unchanged.
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
            ("max_margin", self.max_margin, "m", 0.0, 0.5),
            ("patience", self.patience, "s", 0.1, 100.0),
            ("step_work", self.step_work as f64, "", 1e4, 1e11),
        ];
        for (name, value, unit, low, high) in ranges {
            require_in(&format!("positioner.{name}"), value, unit, low, high)?;
        }
        Ok(self)
    }
}
