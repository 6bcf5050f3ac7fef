//! The trajectory of a sequence against ground truth.

use std::path::Path;
use trundle_core::{Pose3, Stamp, Vector3};
use trundle_eval::{
    AbsoluteConfig, AbsoluteError, RelativeConfig, RelativeError, absolute_trajectory_error,
    relative_pose_error,
};

/// How the trajectory compares with ground truth.
pub struct TruthComparison {
    /// Absolute trajectory error.
    pub absolute: AbsoluteError,
    /// Relative pose error.
    pub relative: RelativeError,
    /// Aligned estimated positions, m.
    pub aligned: Vec<Vector3>,
    /// The true positions beside them, m.
    pub truth: Vec<Vector3>,
}

impl TruthComparison {
    /// ATE and RPE; where they cannot be taken (no overlap in time), a warning says why.
    pub fn of(dir: &Path, truth: &[(Stamp, Pose3)], trajectory: &[(Stamp, Pose3)]) -> Option<Self> {
        let config = AbsoluteConfig::default();
        let absolute = absolute_trajectory_error(truth, trajectory, &config);
        let relative = relative_pose_error(truth, trajectory, &RelativeConfig::default());
        match (absolute, relative) {
            (Ok(absolute), Ok(relative)) => {
                let pairs = absolute.pairs.iter();
                let position = |e: usize| absolute.alignment.apply(&trajectory[e].1).translation;
                let aligned = pairs.clone().map(|&(_, e)| position(e)).collect();
                let truth = pairs.map(|&(t, _)| truth[t].1.translation).collect();
                Some(Self { absolute, relative, aligned, truth })
            }
            (Err(error), _) | (_, Err(error)) => {
                tracing::warn!("{}: not compared: {error}", dir.join("groundtruth.txt").display());
                None
            }
        }
    }
}
