//! Gaussian priors of a pose: fusion, rotation, and failed odometry.

use crate::scan_match::motion_prior::MotionPrior;
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use trundle_core::{Pose2, wrap_angle};

fn any_pose() -> impl Strategy<Value = Pose2> {
    (-20.0..20.0_f64, -20.0..20.0_f64, -3.0..3.0_f64).prop_map(|(x, y, theta)| Pose2::new(x, y, theta))
}

/// A positive definite covariance.
fn any_covariance() -> impl Strategy<Value = Matrix3<f64>> {
    prop::array::uniform9(-1.0..1.0_f64).prop_map(|v| {
        let root = Matrix3::from_row_slice(&v);
        root * root.transpose() + Matrix3::identity() * 0.1
    })
}

/// Squared distance of a pose from a prior, in sigmas.
fn squared(prior: &MotionPrior, pose: Pose2) -> f64 {
    let off = Vector3::new(
        pose.x - prior.guess.x,
        pose.y - prior.guess.y,
        wrap_angle(pose.theta - prior.guess.theta),
    );
    off.dot(&(prior.information * off))
}

proptest! {
    #[test]
    fn information_and_determinant_are_those_of_the_covariance(
        pose in any_pose(), covariance in any_covariance(), heading in -3.0..3.0_f64,
    ) {
        let prior = MotionPrior::new(pose, heading, &covariance);
        prop_assert!((prior.information * prior.covariance - Matrix3::identity()).norm() < 1e-6);
        prop_assert!((prior.log_determinant + covariance.determinant().ln()).abs() < 1e-6, "a turn keeps it");
        prop_assert!((prior.covariance[(2, 2)] - covariance[(2, 2)]).abs() < 1e-9);
        prop_assert!((prior.covariance.trace() - covariance.trace()).abs() < 1e-9);
    }

    /// The product of two Gaussians: information adds up, and no pose is nearer to both than the fused one.
    #[test]
    fn a_fused_prior_minimises_the_sum_of_both_distances(
        pose in any_pose(), a in any_covariance(), b in any_covariance(),
        off in (-2.0..2.0_f64, -2.0..2.0_f64, -0.5..0.5_f64), nudge in prop::array::uniform3(-0.3..0.3_f64),
    ) {
        let other = Pose2::new(pose.x + off.0, pose.y + off.1, pose.theta + off.2);
        let (one, two) = (MotionPrior::with(pose, a), MotionPrior::with(other, b));
        let fused = one.fused(other, &b);
        prop_assert!((fused.information - one.information - two.information).norm() < 1e-6 * fused.information.norm());
        let sum = |pose: Pose2| squared(&one, pose) + squared(&two, pose);
        let g = fused.guess;
        let near = Pose2::new(g.x + nudge[0], g.y + nudge[1], g.theta + nudge[2]);
        prop_assert!(sum(g) <= sum(near) + 1e-9);
        let back = two.fused(pose, &a);
        prop_assert!(back.guess.distance(&g) < 1e-6 && wrap_angle(back.guess.theta - g.theta).abs() < 1e-6);
    }

    /// Failed odometry: start and end of the reported step, and rest, are all within two sigmas.
    #[test]
    fn the_prior_of_failed_odometry_contains_both_ends_of_the_step(
        before in any_pose(), step in (-30.0..30.0_f64, -30.0..30.0_f64, -2.0..2.0_f64),
    ) {
        let guess = before * Pose2::new(step.0, step.1, step.2);
        let prior = MotionPrior::slipped(before, guess, 6.0, 0.5);
        prop_assert!(squared(&prior, before) < 4.0 && squared(&prior, guess) < 4.0);
        let wider = MotionPrior::slipped(before, guess, 9.0, 0.8);
        prop_assert!(wider.log_determinant < prior.log_determinant);
    }
}
