//! Covariances of planar poses.

use nalgebra::{Matrix3, Matrix3x6, Matrix6};
use trundle_core::{Pose2, Pose3};

/// The adjoint of SE(2): `pose * exp(t) = exp(adjoint(pose) t) * pose`, tangents (x m, y m, theta rad)
/// (Sola et al. 2018, eq. 159).
pub(crate) fn adjoint(pose: &Pose2) -> Matrix3<f64> {
    let (s, c) = pose.theta.sin_cos();
    Matrix3::new(c, -s, pose.y, s, c, -pose.x, 0.0, 0.0, 1.0)
}

/// The covariance of `pose * motion` that follows from the covariance of `pose`, both as right perturbations.
pub(crate) fn transported(covariance: &Matrix3<f64>, motion: &Pose2) -> Matrix3<f64> {
    let back = adjoint(&motion.inverse());
    symmetric(back * covariance * back.transpose())
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

/// The covariance of the base's planar pose (x m, y m, theta rad) that follows from the covariance of the camera's pose
/// (m, m, m, rad, rad, rad), both as right perturbations.
pub fn planar_covariance(camera: &Matrix6<f64>, base_from_camera: &Pose3) -> Matrix3<f64> {
    let to_base = base_from_camera.adjoint();
    let planar = Matrix3x6::from_rows(&[to_base.row(0), to_base.row(1), to_base.row(5)]);
    symmetric(planar * camera * planar.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use trundle_core::Vector3;

    proptest! {
        #[test]
        fn the_adjoint_moves_a_perturbation_to_the_left(
            x in -5.0..5.0, y in -5.0..5.0, t in -3.0..3.0, a in -0.5..0.5, b in -0.5..0.5, c in -0.5..0.5,
        ) {
            let (pose, tangent) = (Pose2::new(x, y, t), Vector3::new(a, b, c));
            let right = pose * Pose2::exp(tangent);
            let left = Pose2::exp(adjoint(&pose) * tangent) * pose;
            prop_assert!(right.distance(&left) < 1e-9);
        }

        #[test]
        fn a_planar_wobble_of_the_camera_is_the_bases(a in -1.0..1.0, b in -1.0..1.0, c in -1.0..1.0) {
            let turn = nalgebra::UnitQuaternion::from_euler_angles(-1.9, 0.1, -1.5);
            let base_from_camera = Pose3::new(turn, Vector3::new(0.3, -0.2, 0.6));
            // A planar perturbation of the base, seen as one of the camera.
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
