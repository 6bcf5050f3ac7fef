//! A pose known from another sensor, and its fusion with the pose of the image.

use crate::observation::{CHI2_95_6, CHI2_999_6};
use nalgebra::{Matrix6, Vector6};
use trundle_core::Pose3;

/// A prior of the pose from another source than the image, such as the wheels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosePrior {
    /// The pose.
    pub world_from_camera: Pose3,
    /// Covariance of the prior as a right perturbation (m, rad).
    pub covariance: Matrix6<f64>,
}

impl PosePrior {
    /// The most probable pose between this prior and `pose`, which was found without the prior: a Kalman update. `covariance` (right
    /// perturbation; m, rad) is that of `pose`. The update multiplies this covariance by `alike`, because it may be too small. Also returns
    /// the covariance of the result: `covariance`, plus the share of the prior. The returned covariance is never below `covariance`,
    /// because the caller may use the prior too. `None` if the two contradict each other at 99.9 %.
    pub fn fused_with(
        &self,
        pose: Pose3,
        covariance: &Matrix6<f64>,
        alike: f64,
    ) -> Option<(Pose3, Matrix6<f64>)> {
        let off = (self.world_from_camera.inverse() * pose).log();
        let counted = covariance * alike;
        let chi2 = off.dot(&(self.covariance + counted).cholesky()?.solve(&off));
        // Between the two bounds the weight decreases with the distance (Huber).
        let own = self.covariance * (chi2 / CHI2_95_6).max(1.0);
        let gain = own * (own + counted).cholesky()?.inverse();
        let rest = Matrix6::identity() - gain;
        let fused = covariance + rest * own * rest.transpose();
        let pose = (self.world_from_camera * Pose3::exp(gain * off)).renormalized();
        (chi2 <= CHI2_999_6 && pose.is_finite()).then_some((pose, fused))
    }
}

/// A pose that counts as a measurement.
pub(crate) struct Hold {
    pub(crate) pose: Pose3,
    /// Inverse covariance of a right perturbation of it (m, rad).
    pub(crate) information: Matrix6<f64>,
}

impl Hold {
    /// Right perturbation that leads from here to `pose` (m, rad).
    pub(crate) fn offset(&self, pose: Pose3) -> Vector6<f64> {
        (self.pose.inverse() * pose).log()
    }

    pub(crate) fn cost(&self, pose: Pose3) -> f64 {
        let offset = self.offset(pose);
        offset.dot(&(self.information * offset))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_more_certain_pose_counts_more_axis_by_axis() {
        let sure = Matrix6::from_diagonal(&Vector6::new(1e-6, 4e-4, 1e-4, 1e-4, 1e-4, 1e-4));
        let prior = PosePrior { world_from_camera: Pose3::identity(), covariance: sure };
        let pose = Pose3::exp(Vector6::new(0.02, 0.03, 0.0, 0.0, 0.0, 0.01));
        let (fused, covariance) = prior.fused_with(pose, &(Matrix6::identity() * 1e-4), 1.0).unwrap();
        let expected = Pose3::exp(Vector6::new(0.02 / 101.0, 0.03 * 0.8, 0.0, 0.0, 0.0, 0.005));
        assert!((expected.inverse() * fused).log().norm() < 2e-4, "{fused:?}");
        let brought_in = 0.2_f64.powi(2) * 4e-4;
        assert!((covariance[(1, 1)] - 1e-4 - brought_in).abs() < 1e-12, "{covariance}");
        let (nearer, _) = prior.fused_with(pose, &(Matrix6::identity() * 1e-4), 4.0).unwrap();
        let off = |pose: Pose3| (prior.world_from_camera.inverse() * pose).log().norm();
        assert!(off(nearer) < off(fused));
        let far = PosePrior { covariance: sure * f64::INFINITY, ..prior };
        assert_eq!(far.fused_with(pose, &(Matrix6::identity() * 1e-4), 1.0), None);
        let far = Pose3::exp(Vector6::new(0.0, 0.0, 0.0, 0.0, 0.1, 0.0));
        assert_eq!(prior.fused_with(far, &(Matrix6::identity() * 1e-4), 1.0), None);
    }
}
