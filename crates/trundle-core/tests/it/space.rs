//! Laws of SE(3): group, adjoint, exponential map, conversions, and the motion of a camera on a base.

use nalgebra::{Isometry3, Matrix3, Matrix6, UnitQuaternion, Vector6};
use proptest::prelude::*;
use trundle_core::{CameraMotion, Pose2, Pose3, Vector3};

fn any_tangent(size: f64) -> impl Strategy<Value = Vector6<f64>> {
    prop::array::uniform6(-size..size).prop_map(Vector6::from)
}

fn any_pose() -> impl Strategy<Value = Pose3> {
    any_tangent(1.7).prop_map(Pose3::exp)
}

fn any_point() -> impl Strategy<Value = Vector3> {
    prop::array::uniform3(-9.0..9.0).prop_map(Vector3::from)
}

fn gap(a: Pose3, b: Pose3) -> f64 {
    (a.inverse() * b).log().norm()
}

/// A camera that looks ahead and a little down.
fn base_from_camera() -> Pose3 {
    Pose3::new(UnitQuaternion::from_euler_angles(-1.9, 0.1, -1.5), Vector3::new(0.1, -0.02, 0.6))
}

proptest! {
    #[test]
    fn the_identity_is_neutral_and_inverses_reverse_products(a in any_pose(), b in any_pose()) {
        prop_assert!(gap(a * Pose3::identity(), a) < 1e-12 && gap(Pose3::identity() * a, a) < 1e-12);
        prop_assert!(gap((a * b).inverse(), b.inverse() * a.inverse()) < 1e-12);
        prop_assert!(gap(a.inverse() * a, Pose3::identity()) < 1e-12);
    }

    #[test]
    fn a_product_maps_points_as_its_factors_do(a in any_pose(), b in any_pose(), p in any_point(), q in any_point()) {
        prop_assert!(((a * b).transform(p) - a.transform(b.transform(p))).norm() < 1e-12);
        prop_assert!((a.transform(p) - a.transform(q) - a.rotate(p - q)).norm() < 1e-12);
        prop_assert!((a.rotate(p).norm() - p.norm()).abs() < 1e-12);
    }

    #[test]
    fn rotations_are_orthonormal_matrices_of_determinant_one(a in any_pose()) {
        let matrix = a.rotation_matrix();
        prop_assert!((matrix * matrix.transpose() - Matrix3::identity()).norm() < 1e-12);
        prop_assert!((matrix.determinant() - 1.0).abs() < 1e-12);
        prop_assert!(gap(Pose3::from_matrix(matrix, a.translation), a) < 1e-12);
    }

    #[test]
    fn the_adjoint_carries_a_perturbation_to_the_other_side(a in any_pose(), x in any_tangent(0.8)) {
        prop_assert!(gap(a * Pose3::exp(x), Pose3::exp(a.adjoint() * x) * a) < 1e-11);
    }

    #[test]
    fn the_adjoint_is_a_homomorphism(a in any_pose(), b in any_pose()) {
        prop_assert!(((a * b).adjoint() - a.adjoint() * b.adjoint()).norm() < 1e-11);
        prop_assert!((a.inverse().adjoint() * a.adjoint() - Matrix6::identity()).norm() < 1e-11);
    }

    #[test]
    fn exp_undoes_log_and_the_inverse_has_the_negative_logarithm(a in any_pose()) {
        prop_assert!(gap(Pose3::exp(a.log()), a) < 1e-9);
        prop_assume!(a.angle() < 3.1);
        prop_assert!((a.inverse().log() + a.log()).norm() < 1e-9);
    }

    #[test]
    fn the_logarithm_is_the_shortest_turn_of_a_long_one(x in any_tangent(5.0)) {
        let pose = Pose3::exp(x);
        let short = pose.log();
        prop_assert!(short.fixed_rows::<3>(3).norm() <= std::f64::consts::PI + 1e-9);
        prop_assert!((short.fixed_rows::<3>(3).norm() - pose.angle()).abs() < 1e-9);
    }

    #[test]
    fn small_perturbations_add_to_first_order(a in any_pose(), x in any_tangent(1e-5), y in any_tangent(1e-5)) {
        let both = a.inverse() * (a * Pose3::exp(x) * Pose3::exp(y));
        prop_assert!((both.log() - x - y).norm() < 1e-9);
    }

    #[test]
    fn the_lift_of_planar_poses_keeps_products(
        x in -9.0..9.0_f64, y in -9.0..9.0_f64, t in -3.0..3.0_f64, u in -9.0..9.0_f64, v in -3.0..3.0_f64,
    ) {
        let (a, b) = (Pose2::new(x, y, t), Pose2::new(u, -x, v));
        let lifted = Pose3::from_pose2(a) * Pose3::from_pose2(b);
        prop_assert!(gap(lifted, Pose3::from_pose2(a * b)) < 1e-9);
        prop_assert_eq!(lifted.translation.z, 0.0);
    }

    #[test]
    fn isometries_and_seven_numbers_come_back_as_the_same_pose(a in any_pose()) {
        prop_assert!(gap(Pose3::from(Isometry3::from(a)), a) < 1e-12);
        prop_assert!(gap(Pose3::from(<[f64; 7]>::from(a)), a) < 1e-12);
    }

    #[test]
    fn interpolation_turns_and_moves_in_proportion(a in any_pose(), b in any_pose(), f in 0.0..1.0_f64) {
        prop_assume!((a.inverse() * b).angle() < 3.1);
        let between = a.interpolate(&b, f);
        prop_assert!(((a.inverse() * between).angle() - f * (a.inverse() * b).angle()).abs() < 1e-7);
        prop_assert!((between.translation - a.translation - (b.translation - a.translation) * f).norm() < 1e-12);
        prop_assert!(gap(a.interpolate(&b, 0.0), a) < 1e-9 && gap(a.interpolate(&b, 1.0), b) < 1e-9);
    }

    #[test]
    fn a_camera_covariance_is_symmetric_and_has_no_negative_eigenvalue(
        x in -2.0..2.0_f64, t in -3.0..3.0_f64, s in 1e-4..0.1_f64, c in -0.9..0.9_f64,
    ) {
        let planar = Matrix3::new(1.0, c, 0.0, c, 1.0, 0.0, 0.0, 0.0, 0.5) * s * s;
        let motion = CameraMotion::of_base((Pose2::new(x, 0.1, t), planar), base_from_camera());
        let covariance = motion.covariance.unwrap();
        prop_assert_eq!(covariance, covariance.transpose());
        let min = covariance.symmetric_eigenvalues().min();
        prop_assert!(min > -1e-12 * covariance.norm(), "{}", min);
    }
}

#[test]
fn seven_numbers_are_translation_then_quaternion_with_its_scalar_last_and_are_normalised() {
    let quarter = Pose3::from([1.0, 2.0, 3.0, 0.0, 0.0, 5.0, 5.0]);
    assert_eq!(quarter.translation, Vector3::new(1.0, 2.0, 3.0));
    assert!((quarter.rotate(Vector3::x()) - Vector3::y()).norm() < 1e-12);
    assert!((quarter.rotation.norm() - 1.0).abs() < 1e-15);
}

#[test]
fn a_long_chain_of_products_is_a_rotation_again_after_renormalisation() {
    let step = Pose3::exp(Vector6::new(0.01, 0.0, 0.02, 0.1, -0.2, 0.3));
    let chain = (0..100_000).fold(Pose3::identity(), |pose, _| pose * step);
    let mended = chain.renormalized();
    assert!((mended.rotation.norm() - 1.0).abs() < 1e-15);
    assert_eq!(mended.translation, chain.translation);
}

#[test]
fn the_series_of_the_exponential_map_meets_its_closed_form_in_space() {
    let at = |turn: f64| Pose3::exp(Vector6::new(3.0, -2.0, 1.0, turn, 0.0, 0.0));
    assert!((at(0.999_999e-5).translation - at(1.000_001e-5).translation).norm() < 1e-9);
}

#[test]
fn one_number_that_is_not_finite_makes_a_pose_and_a_motion_not_finite() {
    let bad = Pose3::new(UnitQuaternion::identity(), Vector3::new(0.0, f64::NAN, 0.0));
    assert!(!bad.is_finite() && !CameraMotion::from(bad).is_finite());
    let planar = Matrix3::from_diagonal_element(f64::INFINITY);
    assert!(!CameraMotion::of_base((Pose2::IDENTITY, planar), base_from_camera()).is_finite());
    assert!(CameraMotion::from(Pose3::identity()).is_finite());
}

#[test]
fn a_motion_without_a_covariance_has_none_and_a_longer_distance_leads_farther_out_of_the_plane() {
    assert_eq!(CameraMotion::from(base_from_camera()).covariance, None);
    let height = |distance: f64| {
        let motion =
            CameraMotion::of_base((Pose2::new(distance, 0.0, 0.0), Matrix3::zeros()), Pose3::identity());
        motion.covariance.unwrap()[(2, 2)].sqrt()
    };
    assert_eq!(height(0.0), 0.0);
    // 1 cm over 4 m, and the square root of the distance.
    assert!((height(4.0) - 0.01).abs() < 1e-12 && (height(1.0) - 0.005).abs() < 1e-12);
}
