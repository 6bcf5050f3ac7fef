//! Configuration of the mission executor.

use super::goal_options::{PATIENCE_RANGE_S, WhenBlocked};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, PoseBound, require_in};
use trundle_planning::ExploreConfig;

/// Range of the bound of an arrival's position \[m\]. Source: ours.
pub(crate) const ARRIVAL_BOUND_RANGE_M: (f64, f64) = (0.01, 10.0);
/// Range of the bound of an arrival's heading \[deg\]. Source: ours.
pub(crate) const ARRIVAL_HEADING_RANGE_DEG: (f64, f64) = (1.0, 180.0);

/// Settings of missions, and time limits.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct MissionExecutorConfig {
    /// Time at rest before the first plan, s, 0 to 60, to measure the gyro's bias and draw the first map. Default 1.5 (ours).
    pub opening: f64,
    /// Time without progress after which a goal is given up, s, 1 to 3600. Progress is a fall of the rest of the path by 15 cm, or an
    /// observation of unseen floor on it. Default 75: longer than a person stands in a door.
    pub patience: f64,
    /// Behaviour if an obstacle blocks the path: `detour`: another path of any length, and the end of the goal after the patience; `wait`:
    /// a wait without a limit of time, in place of a much longer path around an obstacle on floor that was seen free. Default `detour`
    /// (ours): each goal ends within a limited time.
    pub when_blocked: WhenBlocked,
    /// Standard deviation of the position above which the robot counts as lost and stops, m, 0.1 to 10. Default 0.7 (ours).
    pub lost_sigma: f64,
    /// Bound of the position's error (95 %) up to which an arrival at a goal is certain, m, 0.01 to 10; a goal with a wider tolerance has its
    /// own. Above it the robot turns on the spot to observe its surroundings, and ends the goal as uncertain. Default 0.1 (ours).
    pub arrival_bound: f64,
    /// Bound of the heading's error (95 %) up to which an arrival at a goal is certain, deg, 1 to 180. Default 5 (ours).
    pub arrival_heading_bound_deg: f64,
    /// Exploration.
    pub explore: ExploreConfig,
}

impl Default for MissionExecutorConfig {
    fn default() -> Self {
        Self {
            opening: 1.5,
            patience: 75.0,
            when_blocked: WhenBlocked::Detour,
            lost_sigma: 0.7,
            arrival_bound: 0.1,
            arrival_heading_bound_deg: 5.0,
            explore: ExploreConfig::default(),
        }
    }
}

impl MissionExecutorConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("mission_executor.opening", self.opening, "s", 0.0, 60.0)?;
        let (min, max) = PATIENCE_RANGE_S;
        require_in("mission_executor.patience", self.patience, "s", min, max)?;
        require_in("mission_executor.lost_sigma", self.lost_sigma, "m", 0.1, 10.0)?;
        let (min, max) = ARRIVAL_BOUND_RANGE_M;
        require_in("mission_executor.arrival_bound", self.arrival_bound, "m", min, max)?;
        let (heading, (min, max)) = (self.arrival_heading_bound_deg, ARRIVAL_HEADING_RANGE_DEG);
        require_in("mission_executor.arrival_heading_bound_deg", heading, "deg", min, max)?;
        self.explore.validated()?;
        Ok(self)
    }

    /// Largest bound of the pose at which an arrival at an exact goal is certain.
    pub(crate) fn arrival_bound(&self) -> PoseBound {
        PoseBound { distance: self.arrival_bound, heading: self.arrival_heading_bound_deg.to_radians() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_number_is_checked_by_name() {
        let field = |config: MissionExecutorConfig| config.validated().unwrap_err().field;
        let good = MissionExecutorConfig::default();
        assert_eq!(good.validated(), Ok(good));
        assert_eq!(field(MissionExecutorConfig { opening: -0.1, ..good }), "mission_executor.opening");
        assert_eq!(field(MissionExecutorConfig { patience: 0.0, ..good }), "mission_executor.patience");
        assert_eq!(field(MissionExecutorConfig { patience: f64::NAN, ..good }), "mission_executor.patience");
        assert_eq!(field(MissionExecutorConfig { lost_sigma: 11.0, ..good }), "mission_executor.lost_sigma");
        let bound = MissionExecutorConfig { arrival_bound: f64::NAN, ..good };
        assert_eq!(field(bound), "mission_executor.arrival_bound");
        let heading = MissionExecutorConfig { arrival_heading_bound_deg: 0.5, ..good };
        assert_eq!(field(heading), "mission_executor.arrival_heading_bound_deg");
    }

    #[test]
    fn a_file_names_wrong_keys() {
        let read = |text| toml::from_str::<MissionExecutorConfig>(text).map_err(|error| error.to_string());
        assert_eq!(read("patience = 5.0").unwrap().patience, 5.0);
        assert!(read("patiense = 5.0").unwrap_err().contains("patiense"));
    }
}
