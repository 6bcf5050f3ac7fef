//! Configuration of the planner.

use crate::curve::fit::config::CurveConfig;
use crate::search::clearance_cost::ClearanceCostConfig;
use crate::search::potential::PotentialConfig;
use crate::timing::config::TimingConfig;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};
use trundle_grid::UnknownIs;

/// Parameters of the planner.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct PlannerConfig {
    /// Treatment of unknown space in plans. Default free: an exploring robot must enter unknown space.
    pub unknown: UnknownIs,
    /// Distance beyond grid, start and goal within which a path may leave the grid, if unknown space is free, m, 0 (never) to 100. It is
    /// used only without a path on the grid. Default 5 (ours).
    pub beyond: f64,
    /// Distance from a blocked goal within which the robot may stop instead, m, 0 to 100. Default 0: only the goal itself.
    pub goal_tolerance: f64,
    /// Cost of low clearance.
    pub room: ClearanceCostConfig,
    /// Search for waypoints.
    pub potential: PotentialConfig,
    /// The curve through the waypoints.
    pub curve: CurveConfig,
    /// Timing of the curve.
    pub timing: TimingConfig,
}

impl Default for PlannerConfig {
    fn default() -> Self {
        Self {
            unknown: UnknownIs::Free,
            beyond: 5.0,
            goal_tolerance: 0.0,
            room: ClearanceCostConfig::default(),
            potential: PotentialConfig::default(),
            curve: CurveConfig::default(),
            timing: TimingConfig::default(),
        }
    }
}

impl PlannerConfig {
    /// Returns a valid configuration unchanged.
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
