use crate::{CurveConfig, PotentialConfig, RoomConfig, TimingConfig, UnknownIs};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Everything that the planner can be told.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PlannerConfig {
    /// What unknown space counts as. Default free: a robot that explores must enter it.
    pub unknown: UnknownIs,
    /// How far beyond the grid, the start and the goal a way may lead where unknown is free, m, 0 to 100. 0: never off
    /// the grid. Default 5 (ours). It is tried only when there is no way within.
    pub beyond: f64,
    /// How far from a goal that is blocked the robot may stop instead, m, 0 to 100. Default 0: nowhere else.
    pub goal_tolerance: f64,
    /// Room around the footprint.
    pub room: RoomConfig,
    /// Way-points.
    pub potential: PotentialConfig,
    /// The curve through them.
    pub curve: CurveConfig,
    /// Its timing.
    pub timing: TimingConfig,
}

impl Default for PlannerConfig {
    fn default() -> Self {
        Self {
            unknown: UnknownIs::Free,
            beyond: 5.0,
            goal_tolerance: 0.0,
            room: RoomConfig::default(),
            potential: PotentialConfig::default(),
            curve: CurveConfig::default(),
            timing: TimingConfig::default(),
        }
    }
}

impl PlannerConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("beyond", self.beyond, "m", 0.0, 100.0)?;
        require_in("goal_tolerance", self.goal_tolerance, "m", 0.0, 100.0)?;
        self.room.validated()?;
        self.potential.validated()?;
        self.curve.validated()?;
        self.timing.validated()?;
        Ok(self)
    }
}
