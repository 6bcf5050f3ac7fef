//! Covariances of planar poses.

use nalgebra::{Matrix3, Matrix3x6, Matrix6, Vector3};
use trundle_core::{Pose2, Pose3};

/// The covariance of `pose * motion` that follows from the covariance of `pose`, both as right perturbations.
pub(crate) fn transported(covariance: &Matrix3<f64>, motion: &Pose2) -> Matrix3<f64> {
    let back = motion.inverse().adjoint();
    symmetric(back * covariance * back.transpose())
}

/// The adjoint of the Lie algebra of SE(2): `ad(a) b` is the bracket of the tangents a and b (Sola et al. 2018).
pub(crate) fn small_adjoint(tangent: &Vector3<f64>) -> Matrix3<f64> {
    let (x, y, theta) = (tangent.x, tangent.y, tangent.z);
    Matrix3::new(0.0, -theta, y, theta, 0.0, -x, 0.0, 0.0, 0.0)
}

/// Angle below which series replace the closed forms, rad. Source: ours; their error below it is less than 1e-12.
const MAX_SERIES_ANGLE_RAD: f64 = 1e-3;

/// Right Jacobian of SE(2): `exp(a + b) = exp(a) exp(J b)` to first order in b. Closed form by ad^3 = -theta^2 ad.
pub(crate) fn right_jacobian(tangent: &Vector3<f64>) -> Matrix3<f64> {
    let (ad, theta) = (small_adjoint(tangent), tangent.z);
    let square = theta * theta;
    let (first, second) = if theta.abs() < MAX_SERIES_ANGLE_RAD {
        (0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0)
    } else {
        ((1.0 - theta.cos()) / square, (theta - theta.sin()) / (square * theta))
    };
    Matrix3::identity() - ad * first + ad * ad * second
}

/// Inverse of the right Jacobian of SE(2): `log(exp(a) exp(b)) = a + J^-1 b` to first order in b; the angle of `a` is within (-2 pi, 2 pi).
pub(crate) fn inverse_right_jacobian(tangent: &Vector3<f64>) -> Matrix3<f64> {
    let (ad, theta) = (small_adjoint(tangent), tangent.z);
    let second = if theta.abs() < MAX_SERIES_ANGLE_RAD {
        1.0 / 12.0 + theta * theta / 720.0
    } else {
        (1.0 - theta / 2.0 / (theta / 2.0).tan()) / (theta * theta)
    };
    Matrix3::identity() + ad * 0.5 + ad * ad * second
}

/// Inverse of the left Jacobian of SE(2): `log(exp(b) exp(a)) = a + J^-1 b` to first order in b.
pub(crate) fn inverse_left_jacobian(tangent: &Vector3<f64>) -> Matrix3<f64> {
    inverse_right_jacobian(&-tangent)
}

/// The symmetric part.
pub(crate) fn symmetric(matrix: Matrix3<f64>) -> Matrix3<f64> {
    (matrix + matrix.transpose()) * 0.5
}

/// The nearest matrix without negative variances.
pub(crate) fn without_negative_variances(matrix: Matrix3<f64>) -> Matrix3<f64> {
    let mut eigen = symmetric(matrix).symmetric_eigen();
    if eigen.eigenvalues.min() >= 0.0 {
        return symmetric(matrix);
    }
    eigen.eigenvalues.apply(|v| *v = v.max(0.0));
    symmetric(eigen.recompose())
}

/// The covariance of the base's planar pose (x m, y m, theta rad), derived from the covariance of the camera's pose (m, m, m, rad, rad,
/// rad); both are right perturbations.
pub fn planar_covariance(camera: &Matrix6<f64>, base_from_camera: &Pose3) -> Matrix3<f64> {
    let to_base = base_from_camera.adjoint();
    let planar = Matrix3x6::from_rows(&[to_base.row(0), to_base.row(1), to_base.row(5)]);
    symmetric(planar * camera * planar.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn jacobians_are_those_of_differences(
            x in -2.0..2.0, y in -2.0..2.0, t in -2.8..2.8, a in -1.0..1.0, b in -1.0..1.0, c in -1.0..1.0,
        ) {
            let (tangent, step) = (Vector3::new(x, y, t), Vector3::new(a, b, c) * 1e-6);
            let moved = (Pose2::exp(tangent).inverse() * Pose2::exp(tangent + step)).log();
            prop_assert!((moved - right_jacobian(&tangent) * step).norm() < 1e-9);
            let right = (Pose2::exp(tangent) * Pose2::exp(step)).log() - tangent;
            prop_assert!((right - inverse_right_jacobian(&tangent) * step).norm() < 1e-9);
            let left = (Pose2::exp(step) * Pose2::exp(tangent)).log() - tangent;
            prop_assert!((left - inverse_left_jacobian(&tangent) * step).norm() < 1e-9);
        }

        #[test]
        fn a_planar_wobble_of_the_camera_is_the_bases(a in -1.0..1.0, b in -1.0..1.0, c in -1.0..1.0) {
            let turn = nalgebra::UnitQuaternion::from_euler_angles(-1.9, 0.1, -1.5);
            let base_from_camera = Pose3::new(turn, Vector3::new(0.3, -0.2, 0.6));
            // A planar perturbation of the base as a perturbation of the camera.
            let planar = Vector3::new(a, b, c) * 1e-6;
            let camera = (base_from_camera.inverse() * Pose3::from_pose2(Pose2::exp(planar)) * base_from_camera).log();
            let covariance = planar_covariance(&(camera * camera.transpose()), &base_from_camera);
            prop_assert!((covariance - planar * planar.transpose()).norm() < 1e-15);
        }
    }

    #[test]
    fn negative_variances_are_cut() {
        let matrix = Matrix3::new(1.0, 0.0, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0, 2.0);
        assert!(
            (without_negative_variances(matrix) - Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 2.0)))
                .norm()
                < 1e-12
        );
    }
}
