use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// How movers are found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TrackerConfig {
    /// How far around the sensor it looks, m, 1 to 20. Default 6 (ours): who walks 1.5 m/s needs 4 s from there.
    pub reach: f64,
    /// For how long a place counts as newly occupied, and how long ago it must have been seen free at the most, s, 0.1 to 60.
    /// Default 3 (ours): at 0.2 m/s all of a person (0.6 m) is new. What stands longer is no mover any more, but for who walked up to there: they may go on for 10 s.
    pub memory: f64,
    /// Hits of a cluster below which it is noise, 1 to 10000. Default 3 (ours).
    pub least_hits: usize,
    /// Gap between hits that are one thing, m, 0.01 to 2. Default 0.2 (ours): a walker's legs.
    pub gap: f64,
    /// Radius that a mover has at least, m, 0 to 5: what is seen may be a leg. Default 0.2 (ours).
    pub smallest: f64,
    /// Radius above which a cluster is a change of the room, not a mover, m, 0.05 to 10. Default 1 (ours).
    pub largest: f64,
    /// How far from where it is expected a cluster may be taken for a track, m, 0.05 to 10. Default 0.5 (ours).
    pub gate: f64,
    /// Time over which a velocity is fitted, and for which a track is believed unseen, s, 0.1 to 10. Default 1 (ours).
    pub window: f64,
    /// Speed below which a thing counts as standing, m/s, 0.01 to 10. Default 0.1 (ours).
    pub least_speed: f64,
    /// Way from where it was first seen before a thing counts as moving, m, 0.01 to 10. Default 0.2 (ours).
    pub least_way: f64,
    /// Sightings before a track is believed, 2 to 1000. Default 4 (ours).
    pub sightings: usize,
}

impl Default for TrackerConfig {
    fn default() -> Self {
        Self {
            reach: 6.0,
            memory: 3.0,
            least_hits: 3,
            gap: 0.2,
            smallest: 0.2,
            largest: 1.0,
            gate: 0.5,
            window: 1.0,
            least_speed: 0.1,
            least_way: 0.2,
            sightings: 4,
        }
    }
}

impl TrackerConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("tracker.reach", self.reach, "m", 1.0, 20.0)?;
        require_in("tracker.memory", self.memory, "s", 0.1, 60.0)?;
        require_in("tracker.least_hits", self.least_hits as f64, "", 1.0, 1e4)?;
        require_in("tracker.gap", self.gap, "m", 0.01, 2.0)?;
        require_in("tracker.smallest", self.smallest, "m", 0.0, 5.0)?;
        require_in("tracker.largest", self.largest, "m", 0.05, 10.0)?;
        require_in("tracker.gate", self.gate, "m", 0.05, 10.0)?;
        require_in("tracker.window", self.window, "s", 0.1, 10.0)?;
        require_in("tracker.least_speed", self.least_speed, "m/s", 0.01, 10.0)?;
        require_in("tracker.least_way", self.least_way, "m", 0.01, 10.0)?;
        require_in("tracker.sightings", self.sightings as f64, "", 2.0, 1e3)?;
        Ok(self)
    }
}
