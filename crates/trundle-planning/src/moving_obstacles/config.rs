//! Configuration of the detection of moving obstacles.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Parameters of the detection and tracking of moving obstacles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct ObstacleTrackerConfig {
    /// Radius around the sensor within which moving obstacles are detected, m, 1 to 20. Default 6 (ours): a person at 1.5 m/s needs 4 s
    /// from there.
    pub reach: f64,
    /// Time for which a cell counts as newly occupied, and largest age of the preceding free observation, s, 0.1 to 60. A larger value
    /// detects slower objects. Default 3 (ours): a person of 0.6 m at 0.2 m/s is completely new.
    pub memory: f64,
    /// Smallest number of hits of a cluster, 1 to 10000. Fewer are noise. Default 3 (ours).
    pub min_hits: usize,
    /// Largest gap between hits of one object, m, 0.01 to 2. Default 0.2 (ours): the legs of a person.
    pub gap: f64,
    /// Smallest radius of an obstacle, m, 0 to 5, since only a leg may be visible. Default 0.2 (ours).
    pub smallest: f64,
    /// Largest radius of a moving obstacle's cluster, m, 0.05 to 10. A larger cluster is a change of the map. Default 1 (ours).
    pub largest: f64,
    /// Largest distance of a cluster from a track's expected position, m, 0.05 to 10. Default 0.5 (ours).
    pub gate: f64,
    /// Time over which a velocity is fitted, and for which an unobserved track is kept, s, 0.1 to 10. Default 1 (ours).
    pub window: f64,
    /// Speed below which an object counts as at rest, m/s, 0.01 to 10. Default 0.1 (ours).
    pub min_speed: f64,
    /// Distance from the first observation after which an object counts as moving, m, 0.01 to 10. Default 0.2 (ours).
    pub min_distance: f64,
    /// Number of observations that confirms a track, 2 to 1000. Default 4 (ours).
    pub sightings: usize,
}

impl Default for ObstacleTrackerConfig {
    fn default() -> Self {
        Self {
            reach: 6.0,
            memory: 3.0,
            min_hits: 3,
            gap: 0.2,
            smallest: 0.2,
            largest: 1.0,
            gate: 0.5,
            window: 1.0,
            min_speed: 0.1,
            min_distance: 0.2,
            sightings: 4,
        }
    }
}

impl ObstacleTrackerConfig {
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("tracker.reach", self.reach, "m", 1.0, 20.0)?;
        require_in("tracker.memory", self.memory, "s", 0.1, 60.0)?;
        require_in("tracker.min_hits", self.min_hits as f64, "", 1.0, 1e4)?;
        require_in("tracker.gap", self.gap, "m", 0.01, 2.0)?;
        require_in("tracker.smallest", self.smallest, "m", 0.0, 5.0)?;
        require_in("tracker.largest", self.largest, "m", 0.05, 10.0)?;
        require_in("tracker.gate", self.gate, "m", 0.05, 10.0)?;
        require_in("tracker.window", self.window, "s", 0.1, 10.0)?;
        require_in("tracker.min_speed", self.min_speed, "m/s", 0.01, 10.0)?;
        require_in("tracker.min_distance", self.min_distance, "m", 0.01, 10.0)?;
        require_in("tracker.sightings", self.sightings as f64, "", 2.0, 1e3)?;
        Ok(self)
    }
}
