use crate::Huber;
use crate::observation::{CHI2_95_6, CHI2_999_6};
use crate::pose_graph::inverse_right_jacobian;
use nalgebra::{Matrix6, Vector6};
use trundle_core::Pose3;

/// A pose that is known besides what the image says: where wheels have brought the camera, say.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosePrior {
    /// The pose.
    pub world_from_camera: Pose3,
    /// Inverse covariance of a right perturbation of it (m, rad).
    pub information: Matrix6<f64>,
}

impl PosePrior {
    /// Whether it agrees at 99.9 % with a pose that was found without it, of that covariance (right perturbation; m, rad).
    pub fn agrees_with(&self, pose: Pose3, covariance: &Matrix6<f64>) -> bool {
        let Some(own) = self.information.cholesky().map(|c| c.inverse()) else { return false };
        let off = self.residual(pose);
        let spread = (own + covariance).cholesky();
        spread.is_some_and(|spread| off.dot(&spread.solve(&off)) <= CHI2_999_6)
    }

    /// Under the Huber loss as a whole.
    pub(crate) fn cost(&self, pose: Pose3) -> f64 {
        Huber::beyond(CHI2_95_6).cost(self.chi2(self.residual(pose)))
    }

    /// Adds J'WJ and J'Wr at `pose`.
    pub(crate) fn add_to(&self, pose: Pose3, hessian: &mut Matrix6<f64>, gradient: &mut Vector6<f64>) {
        let residual = self.residual(pose);
        let jacobian = inverse_right_jacobian(residual);
        let weight = Huber::beyond(CHI2_95_6).weight(self.chi2(residual));
        let weighted = jacobian.transpose() * self.information * weight;
        *hessian += weighted * jacobian;
        *gradient += weighted * residual;
    }

    fn residual(&self, pose: Pose3) -> Vector6<f64> {
        (self.world_from_camera.inverse() * pose).log()
    }

    fn chi2(&self, residual: Vector6<f64>) -> f64 {
        residual.dot(&(self.information * residual))
    }
}
