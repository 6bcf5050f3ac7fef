//! The errors of a trajectory, as table, summary and folder.

use super::named_error::named_error;
use super::unrounded_trajectory;
use crate::AppError;
use std::path::Path;
use trundle_core::{Pose3, Stamp, Vector3};
use trundle_eval::{
    AbsoluteConfig, AbsoluteError, ErrorStatistics, EvalError, RelativeConfig, RelativeError,
    absolute_trajectory_error, relative_pose_error,
};
use trundle_io::Summary;

/// The errors of a trajectory against a reference.
#[derive(Debug, Clone, PartialEq)]
pub struct TrajectoryEvaluation {
    /// Absolute trajectory error.
    pub absolute: AbsoluteError,
    /// Relative pose error.
    pub relative: RelativeError,
    /// Settings of the absolute error.
    pub absolute_config: AbsoluteConfig,
    /// Settings of the relative error.
    pub relative_config: RelativeConfig,
    /// The estimate, aligned with the reference.
    pub aligned: Vec<(Stamp, Pose3)>,
    /// Position of the reference at each compared pose, m.
    pub truth: Vec<Vector3>,
}

impl TrajectoryEvaluation {
    /// Evaluates `estimate` against `reference`.
    ///
    /// # Errors
    /// Those of [`absolute_trajectory_error`] and [`relative_pose_error`].
    pub fn of(
        reference: &[(Stamp, Pose3)],
        estimate: &[(Stamp, Pose3)],
        absolute_config: &AbsoluteConfig,
        relative_config: &RelativeConfig,
    ) -> Result<Self, EvalError> {
        let absolute = absolute_trajectory_error(reference, estimate, absolute_config)?;
        let relative = relative_pose_error(reference, estimate, relative_config)?;
        let aligned = |(stamp, pose): &(Stamp, Pose3)| (*stamp, absolute.alignment.apply(pose));
        Ok(Self {
            aligned: estimate.iter().map(aligned).collect(),
            truth: absolute.pairs.iter().map(|&(r, _)| reference[r].1.translation).collect(),
            absolute,
            relative,
            absolute_config: absolute_config.clone(),
            relative_config: relative_config.clone(),
        })
    }

    /// Evaluates the trajectory of one file against the reference of another one.
    ///
    /// # Errors
    /// When a file cannot be read, or as [`TrajectoryEvaluation::of`], with the name of the file.
    pub fn of_files(
        reference: &Path,
        estimate: &Path,
        absolute: &AbsoluteConfig,
        relative: &RelativeConfig,
    ) -> Result<Self, AppError> {
        let (truth, poses) = (unrounded_trajectory(reference)?, unrounded_trajectory(estimate)?);
        Self::of(&truth, &poses, absolute, relative).map_err(|error| named_error(&error, reference, estimate))
    }

    /// The compared positions of the estimate, aligned with the reference, m.
    pub(crate) fn compared(&self) -> Vec<Vector3> {
        self.absolute.pairs.iter().map(|&(_, e)| self.aligned[e].1.translation).collect()
    }

    /// The absolute errors (cm) over the time since the first pose of the estimate (s).
    pub(crate) fn absolute_errors_cm(&self) -> Vec<(f64, f64)> {
        let pairs = self.absolute.pairs.iter().zip(&self.absolute.errors);
        pairs.map(|(&(_, e), error)| (self.seconds(e), error * 1e2)).collect()
    }

    /// Time of a pose of the estimate since the first, s.
    pub(crate) fn seconds(&self, pose: usize) -> f64 {
        let start = self.aligned.first().map(|(stamp, _)| *stamp).unwrap_or_default();
        self.aligned[pose].0 - start
    }

    /// The errors, one row each.
    #[must_use]
    pub fn rows(&self) -> Vec<Vec<String>> {
        let delta = self.relative_config.delta;
        let head = ["error", "number", "rmse", "mean", "median", "std", "min", "max", ""].map(str::to_owned);
        vec![
            head.to_vec(),
            row("ATE, position", &self.absolute.statistics, 1.0, "m"),
            row("ATE, rotation", &self.absolute.rotation, DEGREES_A_RADIAN, "deg"),
            row(&format!("RPE over {delta}, translation"), &self.relative.translation, 1.0, "m"),
            row(&format!("RPE over {delta}, rotation"), &self.relative.rotation, DEGREES_A_RADIAN, "deg"),
        ]
    }

    /// The numbers for scripts.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let mut summary = Summary::new("eval trajectory");
        summary
            .set("success", true)
            .set("alignment", self.absolute_config.alignment)
            .set("scale", self.absolute.alignment.scale)
            .set("compared_poses", self.absolute.pairs.len())
            .set("delta", self.relative_config.delta)
            .set("ate_translation_m", self.absolute.statistics)
            .set("ate_rotation_rad", self.absolute.rotation)
            .set("rpe_translation_m", self.relative.translation)
            .set("rpe_rotation_rad", self.relative.rotation);
        summary
    }
}

/// Degrees per radian.
const DEGREES_A_RADIAN: f64 = 180.0 / std::f64::consts::PI;

fn row(name: &str, s: &ErrorStatistics, factor: f64, unit: &str) -> Vec<String> {
    let values =
        [s.rmse, s.mean, s.median, s.std, s.min, s.max].map(|value| format!("{:.6}", value * factor));
    [name.to_owned(), s.count.to_string()].into_iter().chain(values).chain([unit.to_owned()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_eval::Alignment;

    /// A helix at 10 Hz, scaled and moved.
    fn helix(scale: f64, x: f64) -> Vec<(Stamp, Pose3)> {
        let position = |t: f64| Vector3::new(t.cos(), t.sin(), 0.1 * t) * scale + Vector3::new(x, 0.0, 0.0);
        (0..60_i64).map(|i| (Stamp::from_nanos(i * 100_000_000), pose_at(position(i as f64 * 0.1)))).collect()
    }

    fn pose_at(position: Vector3) -> Pose3 {
        Pose3 { translation: position, ..Pose3::identity() }
    }

    fn rmse(alignment: Alignment) -> f64 {
        let mut config = AbsoluteConfig::default();
        config.alignment = alignment;
        let found =
            TrajectoryEvaluation::of(&helix(1.0, 0.0), &helix(0.5, 3.0), &config, &RelativeConfig::default());
        found.unwrap().absolute.statistics.rmse
    }

    #[test]
    fn each_alignment_leaves_less_error() {
        assert!(rmse(Alignment::None) > 2.9);
        assert!(rmse(Alignment::Rigid) < 0.6 && rmse(Alignment::Rigid) > 0.4);
        assert!(rmse(Alignment::Similarity) < 1e-9);
    }
}
