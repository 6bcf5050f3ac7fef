//! Alignment of two trajectories by Horn's closed form: rigid, or with scale.

use crate::{EvalError, Side};
use nalgebra::{Matrix3, Matrix4, Quaternion, SymmetricEigen, UnitQuaternion};
use serde::{Deserialize, Serialize};
use trundle_core::{Pose3, Vector3};

/// Alignment of an estimate with the reference before its evaluation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Alignment {
    /// No alignment: both are in one frame.
    None,
    /// By the rotation and translation that leave the smallest square error (evo's `-a`).
    #[default]
    Rigid,
    /// By rotation, translation and scale (evo's `-as`): for methods without a known scale.
    Similarity,
}

impl Alignment {
    /// The choices of a front end: name, help text, value.
    pub const CHOICES: [(&'static str, &'static str, Self); 3] = [
        ("se3", "Rotation and translation", Self::Rigid),
        ("sim3", "Rotation, translation and scale: for one camera without depth", Self::Similarity),
        ("none", "Both are in one frame", Self::None),
    ];
}

/// An element of Sim(3): `reference_from_estimate`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// Rotation and translation (m).
    pub pose: Pose3,
    /// Scale, without unit.
    pub scale: f64,
}

impl Similarity {
    /// The identity.
    pub fn identity() -> Self {
        Self { pose: Pose3::identity(), scale: 1.0 }
    }

    /// A pose of the estimate's frame, in the reference's: the position is scaled, rotated and moved.
    pub fn apply(&self, pose: &Pose3) -> Pose3 {
        self.pose * Pose3::new(pose.rotation, pose.translation * self.scale)
    }
}

/// Smallest gap between the best rotation and the next, relative: below it the rotation is noise of the arithmetic. Source: ours.
const MIN_ROTATION_GAP_RATIO: f64 = 1e-12;

/// The transform T that minimises `sum |reference[i] - T estimate[i]|^2`; positions in m, pair by pair.
///
/// Horn's closed form \[Horn87\]: the rotation is the eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix of the
/// cross-covariance, always proper. It is the minimum of Umeyama's SVD with sign correction. The eigenvalue is Umeyama's `tr(DS)`, which
/// gives the scale \[Umeyama91, eq. 42\].
///
/// # Errors
/// When the slices differ in length, have fewer than three positions or one that is not finite, or the positions are collinear.
pub fn align(
    reference: &[Vector3],
    estimate: &[Vector3],
    alignment: Alignment,
) -> Result<Similarity, EvalError> {
    check(reference, estimate)?;
    if alignment == Alignment::None {
        return Ok(Similarity::identity());
    }
    let poses = reference.len();
    if poses < 3 {
        return Err(EvalError::TooFewPoses { found: poses, needed: 3 });
    }
    let (reference_mean, estimate_mean) = (mean(reference), mean(estimate));
    let mut covariance = Matrix3::zeros();
    let mut square = 0.0;
    for (r, e) in reference.iter().zip(estimate) {
        covariance += (e - estimate_mean) * (r - reference_mean).transpose();
        square += (e - estimate_mean).norm_squared();
    }
    let (rotation, trace) = best_rotation(&covariance, poses)?;
    let scale = if alignment == Alignment::Similarity { trace / square } else { 1.0 };
    let translation = reference_mean - rotation * estimate_mean * scale;
    Ok(Similarity { pose: Pose3::new(rotation, translation), scale })
}

fn check(reference: &[Vector3], estimate: &[Vector3]) -> Result<(), EvalError> {
    if reference.len() != estimate.len() {
        return Err(EvalError::LengthsDiffer { reference: reference.len(), estimate: estimate.len() });
    }
    for (side, points) in [(Side::Reference, reference), (Side::Estimate, estimate)] {
        if let Some(index) = points.iter().position(|p| !p.iter().all(|v| v.is_finite())) {
            return Err(EvalError::NotFinite { side, index });
        }
    }
    Ok(())
}

fn mean(points: &[Vector3]) -> Vector3 {
    points.iter().sum::<Vector3>() / points.len() as f64
}

/// The rotation R that maximises `tr(R S)` for the covariance S of (estimate, reference), and that maximum.
fn best_rotation(s: &Matrix3<f64>, poses: usize) -> Result<(UnitQuaternion<f64>, f64), EvalError> {
    let z = Vector3::new(s[(1, 2)] - s[(2, 1)], s[(2, 0)] - s[(0, 2)], s[(0, 1)] - s[(1, 0)]);
    let block = s + s.transpose() - Matrix3::identity() * s.trace();
    let mut n = Matrix4::zeros(); // Horn87, section 4.A, in the order (w, x, y, z)
    n[(0, 0)] = s.trace();
    n.fixed_view_mut::<3, 1>(1, 0).copy_from(&z);
    n.fixed_view_mut::<1, 3>(0, 1).copy_from(&z.transpose());
    n.fixed_view_mut::<3, 3>(1, 1).copy_from(&block);
    let eigen = SymmetricEigen::new(n);
    let mut order = [0, 1, 2, 3];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let (largest, next) = (eigen.eigenvalues[order[0]], eigen.eigenvalues[order[1]]);
    let spread = if largest > 0.0 { (largest - next) / largest } else { 0.0 };
    if spread.partial_cmp(&MIN_ROTATION_GAP_RATIO) != Some(std::cmp::Ordering::Greater) {
        return Err(EvalError::Degenerate { poses, spread });
    }
    let q = eigen.eigenvectors.column(order[0]);
    Ok((UnitQuaternion::new_normalize(Quaternion::new(q[0], q[1], q[2], q[3])), largest))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector6;
    use proptest::prelude::*;

    fn any_points() -> impl Strategy<Value = Vec<Vector3>> {
        prop::collection::vec(prop::array::uniform3(-5.0..5.0).prop_map(Vector3::from), 4..30)
    }

    fn any_similarity() -> impl Strategy<Value = Similarity> {
        (prop::array::uniform6(-1.7..1.7), 0.1..10.0)
            .prop_map(|(t, scale)| Similarity { pose: Pose3::exp(Vector6::from(t)), scale })
    }

    fn moved(t: &Similarity, points: &[Vector3]) -> Vec<Vector3> {
        points.iter().map(|&p| t.apply(&Pose3::new(UnitQuaternion::identity(), p)).translation).collect()
    }

    fn cost(a: &[Vector3], b: &[Vector3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b).norm_squared()).sum()
    }

    proptest! {
        #[test]
        fn finds_the_transform_that_made_the_reference(points in any_points(), t in any_similarity()) {
            let found = align(&moved(&t, &points), &points, Alignment::Similarity).unwrap();
            prop_assert!((found.scale / t.scale - 1.0).abs() < 1e-9);
            prop_assert!((found.pose.inverse() * t.pose).log().norm() < 1e-8);
        }

        #[test]
        fn no_small_step_is_better(points in any_points(), noisy in any_points(), step in prop::array::uniform6(-0.01..0.01)) {
            let n = points.len().min(noisy.len());
            let (a, b) = (&points[..n], &noisy[..n]);
            let best = align(a, b, Alignment::Rigid).unwrap();
            let other = Similarity { pose: best.pose * Pose3::exp(Vector6::from(step)), scale: 1.0 };
            prop_assert!(cost(a, &moved(&best, b)) <= cost(a, &moved(&other, b)) + 1e-9);
        }
    }

    #[test]
    fn a_mirrored_estimate_is_rotated_never_mirrored() {
        let points: Vec<_> = (0..9).map(|i| Vector3::new(i as f64, (i * i) as f64, (i % 3) as f64)).collect();
        let mirrored: Vec<_> = points.iter().map(|p| Vector3::new(-p.x, p.y, p.z)).collect();
        let found = align(&points, &mirrored, Alignment::Rigid).unwrap();
        assert!((found.pose.rotation_matrix().determinant() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_line_two_points_and_nan_are_refused() {
        let line: Vec<_> = (0..9).map(|i| Vector3::new(i as f64, 2.0 * i as f64, 0.0)).collect();
        assert!(matches!(align(&line, &line, Alignment::Rigid), Err(EvalError::Degenerate { poses: 9, .. })));
        let still = vec![Vector3::new(1.0, 2.0, 3.0); 5];
        assert!(matches!(align(&still, &still, Alignment::Rigid), Err(EvalError::Degenerate { .. })));
        let error = align(&line[..2], &line[..2], Alignment::Rigid).unwrap_err();
        assert_eq!(error.to_string(), "2 associated poses, expected 3 or more");
        let mut broken = line.clone();
        broken[4].y = f64::NAN;
        let error = align(&line, &broken, Alignment::None).unwrap_err();
        assert_eq!(error.to_string(), "estimate pose 4 is not finite");
        assert!(align(&line, &line[1..], Alignment::None).is_err());
    }
}
