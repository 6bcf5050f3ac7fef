//! Settings of loop closing.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in, require_positive};
use trundle_optim::PoseGraphConfig;

/// When a place counts as seen again, and how the map is then corrected.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LoopConfig {
    /// Old keyframes that a new one is compared with, 0 (no loop is closed) or more. Default 3 \[MurArtal17\].
    pub candidates: usize,
    /// Keyframes newer than this many before are not a loop, 1 or more. Default 10: as many as a local bundle moves.
    pub min_age: usize,
    /// Largest distance between two keyframes that see the same, m, above 0. Default 1.5: half a room.
    pub reach: f64,
    /// How much they may be turned, rad, above 0. Default 0.9 (50 deg): a quarter of a Kinect's picture is then common.
    pub turn: f64,
    /// Points of the old place that must be found under one pose, 10 or more. Default 40 \[MurArtal17\].
    pub min_points: usize,
    /// Keyframes in a row that must give the same correction before one is accepted that the drift does not explain, or before
    /// another map is taken for this place, 1 or more. Default 3 \[MurArtal17\].
    pub consistency: usize,
    /// Largest correction that the drift does not explain, m, above 0. Default 1: wheels may slip by as much, and look-alike
    /// rooms are farther apart.
    pub max_correction: f64,
    /// Largest such rotation, rad, above 0. Default 0.5.
    pub max_correction_turn: f64,
    /// Part of the matches that must agree, 0 to 1. Default 0.5: chance does not reach it.
    pub min_agreement: f64,
    /// Largest correction in standard deviations of the drift, above 0. Default 5: covariances along a chain are somewhat
    /// small. A larger correction is a look-alike.
    pub max_sigmas: f64,
    /// Standard deviation of the drift, besides the covariance, as a fraction of the length of each constraint by common
    /// landmarks or a loop, along the least uncertain path, 0 to 1. Default 0.01, the drift of RGB-D odometry.
    pub drift_part: f64,
    /// Standard deviation of the drift of an odometry constraint, as a fraction of its length, 0 to 1. Default 0.003: twice the drift of the second worst of 25 drives at its first
    /// loop. With 0.01 a look-alike room 4.3 m away closed a false loop after 80 m.
    pub drift_part_on_wheels: f64,
    /// Landmarks that two keyframes share to be constrained in the pose graph, 1 or more. Default 100 \[MurArtal17\].
    pub tied_by: usize,
    /// The pose graph.
    pub graph: PoseGraphConfig,
}

impl Default for LoopConfig {
    fn default() -> Self {
        Self {
            candidates: 3,
            min_age: 10,
            reach: 1.5,
            turn: 0.9,
            min_points: 40,
            consistency: 3,
            max_correction: 1.0,
            max_correction_turn: 0.5,
            min_agreement: 0.5,
            max_sigmas: 5.0,
            drift_part: 0.01,
            drift_part_on_wheels: 0.003,
            tied_by: 100,
            graph: PoseGraphConfig::default(),
        }
    }
}

impl LoopConfig {
    /// Passes a valid configuration through.
    ///
    /// # Errors
    /// When a number is out of the range that its field names.
    pub fn validated(mut self) -> Result<Self, Invalid> {
        let counts = [
            ("loops.min_age", self.min_age, 1),
            ("loops.min_points", self.min_points, 10),
            ("loops.consistency", self.consistency, 1),
            ("loops.tied_by", self.tied_by, 1),
        ];
        for (name, value, least) in counts {
            if value < least {
                return Err(Invalid::new(name, value, "", format!("{least} or more")));
            }
        }
        for (name, value, unit) in [
            ("loops.reach", self.reach, "m"),
            ("loops.turn", self.turn, "rad"),
            ("loops.max_correction", self.max_correction, "m"),
            ("loops.max_correction_turn", self.max_correction_turn, "rad"),
            ("loops.max_sigmas", self.max_sigmas, ""),
        ] {
            require_positive(name, value, unit)?;
        }
        require_in("loops.min_agreement", self.min_agreement, "", 0.0, 1.0)?;
        require_in("loops.drift_part", self.drift_part, "", 0.0, 1.0)?;
        require_in("loops.drift_part_on_wheels", self.drift_part_on_wheels, "", 0.0, 1.0)?;
        self.graph = self.graph.validated()?;
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_checked() {
        assert!(LoopConfig::default().validated().is_ok());
        let error = LoopConfig { min_points: 3, ..Default::default() }.validated().unwrap_err();
        assert_eq!(error.to_string(), "loops.min_points is 3, expected 10 or more");
        assert!(LoopConfig { reach: f64::NAN, ..Default::default() }.validated().is_err());
    }
}
