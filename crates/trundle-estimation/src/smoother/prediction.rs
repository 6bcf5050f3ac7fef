//! State and covariance after a motion without measurements.

use super::error_process::ErrorStep;
use super::factors::Unary;
use super::innovation::Innovation;
use super::preintegration::{Preintegrated, parameters, spread};
use super::state::{
    BIAS_PLACE, BORDER_SIZE, BorderState, CHAIN_SIZE, ChainState, ERROR_PLACE, JOINT_SIZE, JointMatrix,
    POSE_PLACE,
};
use crate::odometry_config::OdometryConfig;
use crate::planar::{right_jacobian, symmetric};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use trundle_core::Pose2;
use trundle_optim::ArrowCovariance;

/// A state with its covariance, and the covariance of the border.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Predicted {
    pub(crate) state: ChainState,
    pub(crate) covariance: JointMatrix,
}

impl Predicted {
    /// The estimate of a keyframe.
    pub(crate) fn of(state: ChainState, covariance: &ArrowCovariance<CHAIN_SIZE, BORDER_SIZE>) -> Self {
        let mut joint = JointMatrix::zeros();
        joint.fixed_view_mut::<CHAIN_SIZE, CHAIN_SIZE>(0, 0).copy_from(&covariance.block);
        joint.fixed_view_mut::<CHAIN_SIZE, BORDER_SIZE>(0, CHAIN_SIZE).copy_from(&covariance.cross);
        joint
            .fixed_view_mut::<BORDER_SIZE, CHAIN_SIZE>(CHAIN_SIZE, 0)
            .copy_from(&covariance.cross.transpose());
        joint
            .fixed_view_mut::<BORDER_SIZE, BORDER_SIZE>(CHAIN_SIZE, CHAIN_SIZE)
            .copy_from(&covariance.border);
        Self { state, covariance: joint }
    }

    /// The state after a motion.
    pub(crate) fn after(
        &self,
        motion: &Preintegrated,
        error: &ErrorStep,
        trust: f64,
        border: &BorderState,
        config: &OdometryConfig,
    ) -> Self {
        let (moved, by_chain, by_border) = moved_pose(&self.state, motion, border);
        let (moved_error, by_error) = error.moved(&self.state.error, motion, trust);
        let mut transition = JointMatrix::identity();
        transition.fixed_view_mut::<3, CHAIN_SIZE>(POSE_PLACE, 0).copy_from(&by_chain);
        transition.fixed_view_mut::<3, BORDER_SIZE>(POSE_PLACE, CHAIN_SIZE).copy_from(&by_border);
        transition.fixed_view_mut::<3, 3>(ERROR_PLACE, ERROR_PLACE).copy_from(&by_error);
        let mut covariance = transition * self.covariance * transition.transpose();
        let mut add = |place: usize, noise: Matrix3<f64>| {
            let mut view = covariance.fixed_view_mut::<3, 3>(place, place);
            view += noise;
        };
        add(POSE_PLACE, motion.noise());
        add(ERROR_PLACE, error.covariance(motion));
        covariance[(BIAS_PLACE, BIAS_PLACE)] += config.gyro_bias_walk.powi(2) * motion.duration;
        let state = ChainState { pose: moved, error: moved_error, bias: self.state.bias };
        Self { state, covariance }
    }

    /// The innovation of a measurement with white noise.
    pub(crate) fn innovation(&self, measured: &Unary, noise: &Matrix3<f64>) -> Innovation {
        Innovation::new(&measured.residual, &self.spread(measured, noise))
    }

    /// Removes the error of the visual poses, before its restart.
    pub(crate) fn forget_error(&mut self) {
        self.state.error = Vector3::zeros();
        self.covariance.fixed_rows_mut::<3>(ERROR_PLACE).fill(0.0);
        self.covariance.fixed_columns_mut::<3>(ERROR_PLACE).fill(0.0);
    }

    /// Covariance of the innovation.
    pub(crate) fn spread(&self, measured: &Unary, noise: &Matrix3<f64>) -> Matrix3<f64> {
        let mut jacobian = SMatrix::<f64, 3, JOINT_SIZE>::zeros();
        jacobian.fixed_columns_mut::<CHAIN_SIZE>(0).copy_from(&measured.by_chain);
        jacobian.fixed_columns_mut::<BORDER_SIZE>(CHAIN_SIZE).copy_from(&measured.by_border);
        symmetric(jacobian * self.covariance * jacobian.transpose() + noise)
    }
}

/// Pose and covariance of the base after a motion from an estimated keyframe.
pub(crate) fn pose_after(
    from: &Predicted,
    motion: &Preintegrated,
    border: &BorderState,
) -> (Pose2, Matrix3<f64>) {
    let (pose, by_chain, by_border) = moved_pose(&from.state, motion, border);
    let mut jacobian = SMatrix::<f64, 3, JOINT_SIZE>::zeros();
    jacobian.fixed_columns_mut::<CHAIN_SIZE>(0).copy_from(&by_chain);
    jacobian.fixed_columns_mut::<BORDER_SIZE>(CHAIN_SIZE).copy_from(&by_border);
    (pose, symmetric(jacobian * from.covariance * jacobian.transpose() + motion.covariance))
}

/// The pose after a motion, and its derivatives by keyframe and border.
fn moved_pose(
    from: &ChainState,
    motion: &Preintegrated,
    border: &BorderState,
) -> (Pose2, SMatrix<f64, 3, CHAIN_SIZE>, SMatrix<f64, 3, BORDER_SIZE>) {
    let off: SVector<f64, 3> = motion.by_parameters * (parameters(from.bias, border) - motion.at);
    let moved = motion.motion * Pose2::exp(off);
    let (mut by_chain, by_border) = spread(&(right_jacobian(&off) * motion.by_parameters));
    by_chain.fixed_columns_mut::<3>(POSE_PLACE).copy_from(&moved.inverse().adjoint());
    (from.pose * moved, by_chain, by_border)
}
