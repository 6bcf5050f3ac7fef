//! Wall-clock time of planning.

use trundle_planning::PlanningTimes;

/// Wall-clock time of planning, s.
#[derive(Debug, Clone, Copy)]
pub struct PlanTimes {
    /// Total time.
    pub all: f64,
    /// Times by stage.
    pub stages: PlanningTimes,
}
