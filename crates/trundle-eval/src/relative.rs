//! The relative pose error (RPE) of an estimate against a reference.

use crate::absolute::{associated, of_finite, require_max_difference};
use crate::{Delta, ErrorStatistics, EvalError};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose3, Stamp};

/// Settings of the relative pose error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct RelativeConfig {
    /// Largest time difference of compared poses, s; 0 or more; 0.01 as in evo.
    pub max_difference: f64,
    /// Distance between the two poses of a pair; one frame as in evo.
    pub delta: Delta,
    /// Whether pairs overlap: one from every pose. Off as in evo: each pair begins at the end of the previous one.
    pub all_pairs: bool,
}

impl Default for RelativeConfig {
    fn default() -> Self {
        Self { max_difference: 0.01, delta: Delta::Frames(1), all_pairs: false }
    }
}

impl RelativeConfig {
    /// These settings.
    pub const fn new(max_difference: f64, delta: Delta, all_pairs: bool) -> Self {
        Self { max_difference, delta, all_pairs }
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When `max_difference` is not finite or below 0, or `delta` is not above 0.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_max_difference(self.max_difference)?;
        self.delta.validated()?;
        Ok(self)
    }
}

/// Drift of an estimate.
#[derive(Debug, Clone, PartialEq)]
pub struct RelativeError {
    /// Length of the motion error's translation, m.
    pub translation: ErrorStatistics,
    /// Angle of the motion error's rotation, rad.
    pub rotation: ErrorStatistics,
    /// The compared motions: (index of the first pose in the estimate, index of the second).
    pub pairs: Vec<(usize, usize)>,
    /// Length and angle of each motion error, m and rad.
    pub errors: Vec<(f64, f64)>,
}

/// The relative pose error of `estimate` against `reference`: for poses Q (true) and P (estimated) at i and j, the
/// motion error `(Q_i^-1 Q_j)^-1 (P_i^-1 P_j)`. Source: \[Sturm12\], eq. 1. No alignment is needed.
///
/// # Errors
/// When stamps decrease, no pose can be associated, a pose is not finite, no two poses are `delta` apart, or the configuration is invalid.
pub fn relative_pose_error(
    reference: &[(Stamp, Pose3)],
    estimate: &[(Stamp, Pose3)],
    config: &RelativeConfig,
) -> Result<RelativeError, EvalError> {
    let config = config.clone().validated()?;
    let (indices, truth, found) = associated(reference, estimate, config.max_difference)?;
    let stamped: Vec<_> = indices.iter().zip(&found).map(|(&(_, e), &pose)| (estimate[e].0, pose)).collect();
    let pairs = config.delta.pairs(&stamped, config.all_pairs);
    if pairs.is_empty() {
        return Err(EvalError::NoPairs { poses: found.len(), delta: config.delta });
    }
    let motion = |poses: &[Pose3], i: usize, j: usize| poses[i].inverse() * poses[j];
    let gaps: Vec<Pose3> =
        pairs.iter().map(|&(i, j)| motion(&truth, i, j).inverse() * motion(&found, i, j)).collect();
    let lengths: Vec<f64> = gaps.iter().map(|gap| gap.translation.norm()).collect();
    let angles: Vec<f64> = gaps.iter().map(Pose3::angle).collect();
    Ok(RelativeError {
        translation: of_finite(&lengths),
        rotation: of_finite(&angles),
        pairs: pairs.iter().map(|&(i, j)| (indices[i].1, indices[j].1)).collect(),
        errors: lengths.into_iter().zip(angles).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Pose2, Vector3};

    /// A straight drive at 1 m/s and 10 Hz, with the estimate 2 % long and turning 0.01 rad per second.
    fn drive(scale: f64, turn: f64) -> Vec<(Stamp, Pose3)> {
        let pose = |i: i64| {
            let t = i as f64 * 0.1;
            let yaw = Pose3::from_pose2(Pose2::new(0.0, 0.0, turn * t)).rotation;
            (Stamp::from_nanos(i * 100_000_000), Pose3::new(yaw, Vector3::new(t * scale, 0.0, 0.0)))
        };
        (0..101).map(pose).collect()
    }

    #[test]
    fn drift_is_what_was_put_in() {
        let (truth, estimate) = (drive(1.0, 0.0), drive(1.02, 0.0));
        for (delta, drift, count) in [
            (Delta::Frames(1), 0.002, 100),
            (Delta::Frames(10), 0.02, 10),
            (Delta::Seconds(2.0), 0.04, 5),
            (Delta::Metres(1.019), 0.02, 10),
        ] {
            let config = RelativeConfig { delta, ..Default::default() };
            let error = relative_pose_error(&truth, &estimate, &config).unwrap();
            assert!((error.translation.rmse - drift).abs() < 1e-9, "{delta}: {error:?}");
            assert_eq!(error.translation.count, count, "{delta}");
            assert_eq!((error.pairs.len(), error.errors.len()), (count, count), "{delta}");
        }
        let turning = relative_pose_error(&truth, &drive(1.0, 0.01), &RelativeConfig::default()).unwrap();
        assert!((turning.rotation.mean - 0.001).abs() < 1e-9);
    }

    #[test]
    fn all_pairs_start_everywhere() {
        let truth = drive(1.0, 0.0);
        for (delta, count) in [(Delta::Frames(10), 91), (Delta::Seconds(1.0), 91), (Delta::Metres(0.95), 91)]
        {
            let config = RelativeConfig { delta, all_pairs: true, ..Default::default() };
            let error = relative_pose_error(&truth, &truth, &config).unwrap();
            assert_eq!((error.translation.count, error.translation.max < 1e-12), (count, true), "{delta}");
        }
    }

    #[test]
    fn too_long_and_zero_deltas_are_refused() {
        let truth = drive(1.0, 0.0);
        let with = |delta| {
            let config = RelativeConfig { delta, ..Default::default() };
            relative_pose_error(&truth, &truth, &config).unwrap_err().to_string()
        };
        assert_eq!(with(Delta::Metres(50.0)), "no two of the 101 associated poses are 50 m apart");
        assert_eq!(with(Delta::Frames(0)), "delta is 0 frames, expected 1 or more");
        assert!(with(Delta::Seconds(f64::NAN)).starts_with("delta is NaN s"));
    }
}
