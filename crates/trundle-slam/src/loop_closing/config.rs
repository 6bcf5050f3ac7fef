//! Settings of loop closing.

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use trundle_core::{Invalid, require_in};
use trundle_optim::PoseGraphConfig;

/// Detection of loops, and correction of the map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct LoopConfig {
    /// Number of old keyframes that a new one is compared with, 0 (no loop closing) or more. More find more loops and take longer. Default
    /// 3 \[MurArtal17\].
    pub candidates: usize,
    /// Number of newest keyframes that are no loop candidates, 1 or more. Default 10: as many as a local bundle moves.
    pub min_age: usize,
    /// Largest distance between two keyframes of one place, m, above 0, to 100, besides the drift. A larger value compares more keyframes. Default
    /// 1.5: half a room.
    pub reach: f64,
    /// Largest rotation between two keyframes of one place, rad, above 0, to pi, besides the drift. Default 0.9 (50 deg): a quarter of a Kinect's
    /// image is then common.
    pub turn: f64,
    /// Smallest number of points of the old place that agree on one pose, 10 or more. A larger number misses loops; a smaller one accepts
    /// false ones. Default 40 \[MurArtal17\].
    pub min_points: usize,
    /// Number of keyframes in a row that must give the same correction before the merge of a map, or a correction that the drift does not
    /// explain, is accepted, 1 or more. Default 3 \[MurArtal17\].
    pub consistency: usize,
    /// Largest correction that the drift does not explain, m, above 0, to 100. Default 1: wheels may slip by as much, and look-alike
    /// rooms are farther apart.
    pub max_correction: f64,
    /// Largest rotation of a correction that the drift does not explain, rad, above 0, to pi. Default 0.5 (ours).
    pub max_correction_turn: f64,
    /// Smallest fraction of the matches that agree on the pose, 0 to 1. Default 0.5: chance matches stay below it.
    pub min_agreement: f64,
    /// Largest correction in standard deviations of the drift, above 0, to 1000. A larger correction counts as a look-alike place. Default 5:
    /// covariances along a chain are somewhat small.
    pub max_sigmas: f64,
    /// Standard deviation of the drift, besides the covariance, as a fraction of the length of each constraint by common landmarks or a
    /// loop, along the least uncertain path, 0 to 1. Default 0.01 (ours): a drift of 1 %.
    pub drift_part: f64,
    /// Standard deviation of the drift of an odometry constraint, as a fraction of its length, 0 to 1. Default 0.003: twice the drift of the second worst of 25 drives at its first
    /// loop. With 0.01 a look-alike room 4.3 m away closed a false loop after 80 m.
    pub drift_part_on_wheels: f64,
    /// Smallest number of common landmarks at which two keyframes get a constraint in the pose graph, 1 or more. A smaller number gives a denser,
    /// slower graph. Default 100 \[MurArtal17\].
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
    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(mut self) -> Result<Self, Invalid> {
        let counts = [
            ("loops.min_age", self.min_age, 1),
            ("loops.min_points", self.min_points, 10),
            ("loops.consistency", self.consistency, 1),
            ("loops.tied_by", self.tied_by, 1),
        ];
        for (name, value, min) in counts {
            if value < min {
                return Err(Invalid::new(name, value, "", format!("{min} or more")));
            }
        }
        for (name, value, unit, high) in [
            ("loops.reach", self.reach, "m", 100.0),
            ("loops.turn", self.turn, "rad", PI),
            ("loops.max_correction", self.max_correction, "m", 100.0),
            ("loops.max_correction_turn", self.max_correction_turn, "rad", PI),
            ("loops.max_sigmas", self.max_sigmas, "", 1e3),
        ] {
            require_in(name, value, unit, 1e-6, high)?;
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
