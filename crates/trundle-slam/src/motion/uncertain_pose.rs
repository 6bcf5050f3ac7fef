//! A relative pose with its covariance, and the composition of two.

use nalgebra::{Matrix6, Vector6};
use trundle_core::Pose3;

/// A relative pose `a_from_b` with its covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UncertainPose {
    /// `a_from_b`.
    pub pose: Pose3,
    /// Covariance of the pose as a right perturbation (m, m, m, rad, rad, rad).
    pub covariance: Matrix6<f64>,
}

impl UncertainPose {
    /// The identity, known exactly.
    pub fn identity() -> Self {
        Self { pose: Pose3::identity(), covariance: Matrix6::zeros() }
    }

    /// `a_from_c`, where this is `a_from_b` and `next` is `b_from_c`; errors of the two are independent.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        let covariance = propagated(&self.covariance, next.pose) + next.covariance;
        Self { pose: (self.pose * next.pose).renormalized(), covariance }
    }
}

/// A covariance of independent errors with the same standard deviation on all axes: m, and rad.
pub(crate) fn of_sigmas(translation_sigma: f64, rotation_sigma: f64) -> Matrix6<f64> {
    let (t, r) = (translation_sigma * translation_sigma, rotation_sigma * rotation_sigma);
    Matrix6::from_diagonal(&Vector6::new(t, t, t, r, r, r))
}

/// The covariance of `a_from_b * motion` when that of `a_from_b` is `covariance` and the motion is exact; both as right
/// perturbations.
pub(crate) fn propagated(covariance: &Matrix6<f64>, motion: Pose3) -> Matrix6<f64> {
    let backward = motion.inverse().adjoint();
    backward * covariance * backward.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn uncertain(tangent: [f64; 6], sigma: f64) -> UncertainPose {
        UncertainPose { pose: Pose3::exp(Vector6::from(tangent)), covariance: of_sigmas(sigma, 2.0 * sigma) }
    }

    #[test]
    fn composition_is_associative_and_the_identity_is_neutral() {
        let a = uncertain([0.1, -0.2, 0.3, 0.4, 0.1, -0.3], 0.02);
        let b = uncertain([0.5, 0.0, -0.1, -0.2, 0.3, 0.1], 0.01);
        let c = uncertain([-0.3, 0.2, 0.0, 0.1, -0.1, 0.2], 0.03);
        let (left, right) = (a.then(&b).then(&c), a.then(&b.then(&c)));
        assert!((left.pose.inverse() * right.pose).log().norm() < 1e-12);
        assert!((left.covariance - right.covariance).amax() < 1e-12);
        let same = UncertainPose::identity().then(&a);
        assert!((same.pose.inverse() * a.pose).log().norm() < 1e-12 && same.covariance == a.covariance);
        let still = a.then(&UncertainPose::identity());
        assert!((still.covariance - a.covariance).amax() < 1e-15);
    }

    proptest! {
        #[test]
        fn the_adjoint_moves_a_perturbation_through_a_pose(
            a in prop::array::uniform6(-1.0..1.0), b in prop::array::uniform6(-1e-4..1e-4),
        ) {
            let (pose, small) = (Pose3::exp(Vector6::from(a)), Vector6::from(b));
            let through = (pose * Pose3::exp(small) * pose.inverse()).log();
            prop_assert!((through - pose.adjoint() * small).norm() < 1e-10);
        }
    }
}
