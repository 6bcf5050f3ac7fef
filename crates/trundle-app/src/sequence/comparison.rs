//! The trajectory of a sequence against ground truth.

use crate::evaluation::TrajectoryEvaluation;
use std::path::Path;
use trundle_core::{Pose3, Stamp};
use trundle_eval::{AbsoluteConfig, RelativeConfig};

/// ATE and RPE. If the errors are undefined (no overlap in time), a warning gives the cause.
pub fn against_truth(
    path: &Path,
    truth: &[(Stamp, Pose3)],
    trajectory: &[(Stamp, Pose3)],
) -> Option<TrajectoryEvaluation> {
    let (absolute, relative) = (AbsoluteConfig::default(), RelativeConfig::default());
    TrajectoryEvaluation::of(truth, trajectory, &absolute, &relative)
        .inspect_err(|error| {
            tracing::warn!("{}: not compared with its ground truth: {error}", path.display());
        })
        .ok()
}
