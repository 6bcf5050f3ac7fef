//! The absolute trajectory error (ATE) of an estimate against a reference.

use crate::{Alignment, ErrorStatistics, EvalError, Similarity, align, associate};
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, Pose3, Stamp, Vector3, require_finite};

/// Settings of the absolute trajectory error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct AbsoluteConfig {
    /// Largest time difference of compared poses, s; 0 or more; 0.01 as in evo.
    pub max_difference: f64,
    /// Alignment of the estimate with the reference; [`Alignment::Rigid`] as in the TUM benchmark.
    pub alignment: Alignment,
}

impl Default for AbsoluteConfig {
    fn default() -> Self {
        Self { max_difference: 0.01, alignment: Alignment::Rigid }
    }
}

impl AbsoluteConfig {
    /// These settings.
    pub const fn new(max_difference: f64, alignment: Alignment) -> Self {
        Self { max_difference, alignment }
    }

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When `max_difference` is not finite or below 0.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_max_difference(self.max_difference)?;
        Ok(self)
    }
}

pub(crate) fn require_max_difference(seconds: f64) -> Result<f64, Invalid> {
    require_finite("max_difference", seconds, "s")?;
    if seconds < 0.0 {
        return Err(Invalid::new("max_difference", seconds, "s", "0 or more"));
    }
    Ok(seconds)
}

/// Absolute error of an estimate.
#[derive(Debug, Clone, PartialEq)]
pub struct AbsoluteError {
    /// Distances between positions, m: `rmse` is the ATE of the TUM benchmark.
    pub statistics: ErrorStatistics,
    /// Angles between orientations, rad.
    pub rotation: ErrorStatistics,
    /// `reference_from_estimate` of the alignment.
    pub alignment: Similarity,
    /// The compared poses: (index in the reference, index in the estimate).
    pub pairs: Vec<(usize, usize)>,
    /// Distance of each pair, m.
    pub errors: Vec<f64>,
}

/// The absolute trajectory error (evo's APE) of `estimate` against `reference`. Poses are associated by time and aligned by position; the
/// errors are the distance and the angle of each pair. Source: \[Sturm12\], eq. 3.
///
/// # Errors
/// When stamps decrease, no pose can be associated, a pose is not finite, or the alignment fails ([`align`]).
pub fn absolute_trajectory_error(
    reference: &[(Stamp, Pose3)],
    estimate: &[(Stamp, Pose3)],
    config: &AbsoluteConfig,
) -> Result<AbsoluteError, EvalError> {
    require_max_difference(config.max_difference)?;
    let (pairs, truth, found) = associated(reference, estimate, config.max_difference)?;
    let positions = |poses: &[Pose3]| poses.iter().map(|p| p.translation).collect::<Vec<Vector3>>();
    let alignment = align(&positions(&truth), &positions(&found), config.alignment)?;
    let gaps: Vec<Pose3> = truth.iter().zip(&found).map(|(t, f)| t.inverse() * alignment.apply(f)).collect();
    let errors: Vec<f64> = gaps.iter().map(|gap| gap.translation.norm()).collect();
    let angles: Vec<f64> = gaps.iter().map(Pose3::angle).collect();
    Ok(AbsoluteError {
        statistics: of_finite(&errors),
        rotation: of_finite(&angles),
        alignment,
        pairs,
        errors,
    })
}

pub(crate) fn of_finite(errors: &[f64]) -> ErrorStatistics {
    ErrorStatistics::of(errors).expect("invariant: finite poses have finite errors")
}

/// The pairs of two trajectories and their poses, checked to be finite.
type Associated = (Vec<(usize, usize)>, Vec<Pose3>, Vec<Pose3>);

pub(crate) fn associated(
    reference: &[(Stamp, Pose3)],
    estimate: &[(Stamp, Pose3)],
    max_difference: f64,
) -> Result<Associated, EvalError> {
    let stamps = |poses: &[(Stamp, Pose3)]| poses.iter().map(|p| p.0).collect::<Vec<_>>();
    let pairs = associate(&stamps(reference), &stamps(estimate), max_difference)?;
    for (side, poses) in [(crate::Side::Reference, reference), (crate::Side::Estimate, estimate)] {
        if let Some(index) = poses.iter().position(|(_, pose)| !usable(pose)) {
            return Err(EvalError::NotFinite { side, index });
        }
    }
    let truth = pairs.iter().map(|&(r, _)| reference[r].1).collect();
    let found = pairs.iter().map(|&(_, e)| estimate[e].1).collect();
    Ok((pairs, truth, found))
}

/// Whether the pose is finite and small enough (below 1e100 m) for finite squares and sums.
fn usable(pose: &Pose3) -> bool {
    pose.is_finite() && pose.translation.amax() < 1e100
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;

    fn spiral() -> Vec<(Stamp, Pose3)> {
        let pose = |i: i64| {
            let t = i as f64 * 0.1;
            Pose3::exp(Vector6::new(t, t * t * 0.1, t.sin(), 0.1 * t, 0.2, 0.05 * t))
        };
        (0..60).map(|i| (Stamp::from_nanos(i * 33_333_333), pose(i))).collect()
    }

    proptest! {
        #[test]
        fn a_moved_trajectory_has_no_error(step in prop::array::uniform6(-1.5..1.5)) {
            let truth = spiral();
            let moved: Vec<_> = truth.iter().map(|&(s, p)| (s, Pose3::exp(Vector6::from(step)) * p)).collect();
            let error = absolute_trajectory_error(&truth, &moved, &AbsoluteConfig::default()).unwrap();
            prop_assert!(error.statistics.max < 1e-9 && error.rotation.max < 1e-7);
            prop_assert_eq!(error.statistics.count, 60);
        }
    }

    #[test]
    fn without_alignment_an_offset_is_the_error() {
        let truth = spiral();
        let mut moved = truth.clone();
        moved.iter_mut().for_each(|(_, p)| p.translation.z += 0.5);
        let config = AbsoluteConfig { alignment: Alignment::None, ..Default::default() };
        let error = absolute_trajectory_error(&truth, &moved, &config).unwrap();
        assert!((error.statistics.rmse - 0.5).abs() < 1e-12 && error.rotation.max < 1e-7);
    }

    #[test]
    fn refuses_nan_huge_numbers_and_negative_limits() {
        let truth = spiral();
        for bad in [f64::NAN, f64::INFINITY, 1e200] {
            let mut broken = truth.clone();
            broken[7].1.translation.x = bad;
            let error = absolute_trajectory_error(&truth, &broken, &AbsoluteConfig::default()).unwrap_err();
            assert_eq!(error.to_string(), "estimate pose 7 is not finite");
        }
        let config = AbsoluteConfig { max_difference: -0.1, ..Default::default() };
        assert!(absolute_trajectory_error(&truth, &truth, &config).is_err());
        assert!(config.validated().is_err());
    }
}
