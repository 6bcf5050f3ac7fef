//! The rigid alignment of two point sequences (Umeyama 1991, without scale), to evaluate trajectories.

#![allow(dead_code, reason = "each program uses a part of it")]

use nalgebra::Matrix3;
use trundle_core::Vector3;

/// The estimate after the rigid motion that brings it nearest to the truth.
pub fn aligned(estimate: &[Vector3], truth: &[Vector3]) -> Vec<Vector3> {
    assert_eq!(estimate.len(), truth.len());
    let n = truth.len() as f64;
    let mean = |points: &[Vector3]| points.iter().sum::<Vector3>() / n;
    let (mean_e, mean_t) = (mean(estimate), mean(truth));
    let pairs = estimate.iter().zip(truth).map(|(e, t)| (e - mean_e, t - mean_t));
    let covariance: Matrix3<f64> = pairs.map(|(e, t)| t * e.transpose()).sum();
    let svd = covariance.svd(true, true);
    let (u, v_t) = (svd.u.unwrap(), svd.v_t.unwrap());
    let sign = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v_t).determinant().signum()));
    let rotation = u * sign * v_t;
    estimate.iter().map(|e| mean_t + rotation * (e - mean_e)).collect()
}

/// Root mean square distance, m, after the best rotation and translation.
pub fn aligned_rmse(estimate: &[Vector3], truth: &[Vector3]) -> f64 {
    let squares =
        aligned(estimate, truth).iter().zip(truth).map(|(e, t)| (e - t).norm_squared()).sum::<f64>();
    (squares / truth.len() as f64).sqrt()
}

#[test]
fn a_moved_trajectory_has_no_error_and_noise_has_its_own() {
    let truth: Vec<Vector3> =
        (0..50).map(|i| i as f64).map(|i| Vector3::new(i.sin(), (0.3 * i).cos(), 0.1 * i)).collect();
    let turn = nalgebra::UnitQuaternion::from_euler_angles(0.4, -1.2, 2.0);
    let moved: Vec<Vector3> = truth.iter().map(|p| turn * p + Vector3::new(3.0, 1.0, -2.0)).collect();
    assert!(aligned_rmse(&moved, &truth) < 1e-12);
    let shaken: Vec<Vector3> = moved
        .iter()
        .enumerate()
        .map(|(i, p)| p + Vector3::z() * if i % 2 == 0 { 0.01 } else { -0.01 })
        .collect();
    assert!((aligned_rmse(&shaken, &truth) - 0.01).abs() < 2e-4);
}
