//! Factors of the window: residuals, derivatives, and their part of the normal equations.

use super::error_process::ErrorStep;
use super::preintegration::{Preintegrated, parameters, spread};
use super::state::{
    BIAS_PLACE, BORDER_SIZE, BorderState, CHAIN_SIZE, ChainBlock, ChainState, Coupling, DELAY_PLACE,
    ERROR_PLACE, FIRST_ANCHOR_PLACE, POSE_PLACE,
};
use crate::odometry_config::OdometryConfig;
use crate::planar::{inverse_left_jacobian, inverse_right_jacobian, right_jacobian};
use nalgebra::{Matrix3, RowSVector, SMatrix, SVector, Vector3};
use trundle_core::{Pose2, wrap_angle};
use trundle_optim::ArrowSystem;

/// The normal equations of the window.
pub(crate) type WindowSystem = ArrowSystem<CHAIN_SIZE, BORDER_SIZE>;

/// A residual of one keyframe, with its derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unary {
    pub(crate) residual: Vector3<f64>,
    pub(crate) by_chain: SMatrix<f64, 3, CHAIN_SIZE>,
    pub(crate) by_border: SMatrix<f64, 3, BORDER_SIZE>,
}

/// A visual pose.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VisualFactor {
    /// `visual_from_base` in the plane.
    pub(crate) pose: Pose2,
    /// Velocity of the base at the image, per second.
    pub(crate) velocity: Vector3<f64>,
    /// Covariance of the white noise in the axes of the visual map.
    pub(crate) noise: Matrix3<f64>,
    /// Slot of the visual map's anchor.
    pub(crate) slot: usize,
}

impl VisualFactor {
    /// Position and heading of the measured pose minus those of the predicted one, in the axes of the visual map, minus the error of the
    /// visual pose. Exact for errors of any size.
    pub(crate) fn linearise(&self, state: &ChainState, border: &BorderState) -> Unary {
        let back = Pose2::exp(self.velocity * border.delay);
        let visual_from_base = border.anchors[self.slot].inverse() * state.pose * back.inverse();
        let difference = self.pose.inverse() * visual_from_base;
        let off = rotation(self.pose.theta) * Vector3::new(difference.x, difference.y, difference.theta);
        let mut residual = -off - state.error;
        residual.z = wrap_angle(residual.z);
        let turn = rotation(visual_from_base.theta);
        let mut by_chain = SMatrix::<f64, 3, CHAIN_SIZE>::zeros();
        by_chain.fixed_columns_mut::<3>(POSE_PLACE).copy_from(&-(turn * back.adjoint()));
        by_chain.fixed_columns_mut::<3>(ERROR_PLACE).copy_from(&-Matrix3::identity());
        let mut by_border = SMatrix::<f64, 3, BORDER_SIZE>::zeros();
        by_border.set_column(DELAY_PLACE, &(turn * self.velocity));
        let by_anchor = turn * visual_from_base.inverse().adjoint();
        by_border.fixed_columns_mut::<3>(FIRST_ANCHOR_PLACE + 3 * self.slot).copy_from(&by_anchor);
        Unary { residual, by_chain, by_border }
    }
}

/// A pose in the map frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScanFactor {
    /// `map_from_base`.
    pub(crate) pose: Pose2,
    /// Covariance as a right perturbation.
    pub(crate) noise: Matrix3<f64>,
}

impl ScanFactor {
    /// Measured minus predicted pose in the axes of the base.
    pub(crate) fn linearise(&self, state: &ChainState) -> Unary {
        let residual = (state.pose.inverse() * self.pose).log();
        let mut by_chain = SMatrix::<f64, 3, CHAIN_SIZE>::zeros();
        by_chain.fixed_columns_mut::<3>(POSE_PLACE).copy_from(&-inverse_left_jacobian(&residual));
        Unary { residual, by_chain, by_border: SMatrix::zeros() }
    }
}

/// A rotation of the plane that keeps angles.
pub(crate) fn rotation(angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
}

impl Unary {
    /// Adds the factor to keyframe `k`; returns its cost.
    pub(crate) fn add_to(&self, system: &mut WindowSystem, k: usize, noise: &Matrix3<f64>) -> f64 {
        let Some(information) = noise.try_inverse() else { return 0.0 };
        let weighted: SMatrix<f64, CHAIN_SIZE, 3> = self.by_chain.transpose() * information;
        let border: SMatrix<f64, BORDER_SIZE, 3> = self.by_border.transpose() * information;
        system.add_diagonal(k, &(weighted * self.by_chain));
        system.add_coupling(k, &(weighted * self.by_border));
        system.add_gradient(k, &-(weighted * self.residual));
        system.add_border(&(border * self.by_border), &-(border * self.residual));
        self.residual.dot(&(information * self.residual))
    }
}

/// Coupling of keyframe `i` with the next one: motion, comparison of wheels and gyro, gyro at rest, error of the visual poses, bias.
pub(crate) struct Link<'a> {
    pub(crate) motion: &'a Preintegrated,
    pub(crate) error: &'a ErrorStep,
    /// Probability that the error of the visual poses returns to its mean, 0 to 1.
    pub(crate) trust: f64,
    pub(crate) config: &'a OdometryConfig,
}

impl Link<'_> {
    /// Adds the link from keyframe `i` to the next one; returns its cost.
    pub(crate) fn add_to(
        &self,
        system: &mut WindowSystem,
        i: usize,
        (from, to): (&ChainState, &ChainState),
        border: &BorderState,
    ) -> f64 {
        self.add_motion(system, i, (from, to), border)
            + self.add_comparison(system, i, (from, to), border)
            + self.add_errors(system, i, (from, to))
            + self.add_bias(system, i, (from, to))
    }

    fn add_motion(
        &self,
        system: &mut WindowSystem,
        i: usize,
        (from, to): (&ChainState, &ChainState),
        border: &BorderState,
    ) -> f64 {
        let Some(information) = self.motion.noise().try_inverse() else { return 0.0 };
        let found = linearise_motion(self.motion, (from, to), border);
        let (by_bias, by_border) = spread(&found.by_parameters);
        let mut by_from = by_bias;
        by_from.fixed_columns_mut::<3>(POSE_PLACE).copy_from(&found.by_from);
        let mut by_to = SMatrix::<f64, 3, CHAIN_SIZE>::zeros();
        by_to.fixed_columns_mut::<3>(POSE_PLACE).copy_from(&found.by_to);
        add_pair(system, i, (&by_from, &by_to, &by_border), &information, &found.residual)
    }

    /// Adds the difference of the turn by the wheels and that between the poses.
    fn add_comparison(
        &self,
        system: &mut WindowSystem,
        i: usize,
        (from, to): (&ChainState, &ChainState),
        border: &BorderState,
    ) -> f64 {
        let wheels = &self.motion.wheels;
        let Some(variance) = wheels.comparison_variance() else { return 0.0 };
        let off = parameters(from.bias, border) - self.motion.at;
        let turn = wheels.turn + (wheels.by_parameters * off).x;
        let residual = SVector::<f64, 1>::new(wrap_angle(turn - (to.pose.theta - from.pose.theta)));
        let (mut by_from, by_border) = spread(&wheels.by_parameters);
        by_from[POSE_PLACE + 2] = 1.0;
        let mut by_to = RowSVector::<f64, CHAIN_SIZE>::zeros();
        by_to[POSE_PLACE + 2] = -1.0;
        let information = SMatrix::<f64, 1, 1>::new(1.0 / variance);
        add_pair(system, i, (&by_from, &by_to, &by_border), &information, &residual)
    }

    /// Adds the decay of the visual poses' error to its mean, with new noise.
    fn add_errors(&self, system: &mut WindowSystem, i: usize, (from, to): (&ChainState, &ChainState)) -> f64 {
        let Some(information) = self.error.information(self.motion) else { return 0.0 };
        let (expected, by_from) = self.error.moved(&from.error, self.motion, self.trust);
        let mut residual = to.error - expected;
        residual.z = wrap_angle(residual.z);
        let put = |block: Matrix3<f64>| {
            let mut whole = ChainBlock::zeros();
            whole.fixed_view_mut::<3, 3>(ERROR_PLACE, ERROR_PLACE).copy_from(&block);
            whole
        };
        let gradient = |part: Vector3<f64>| {
            let mut whole = SVector::<f64, CHAIN_SIZE>::zeros();
            whole.fixed_rows_mut::<3>(ERROR_PLACE).copy_from(&part);
            whole
        };
        let weighted = by_from.transpose() * information;
        system.add_diagonal(i, &put(weighted * by_from));
        system.add_diagonal(i + 1, &put(information));
        system.add_next(i, &put(-weighted));
        system.add_gradient(i, &gradient(weighted * residual));
        system.add_gradient(i + 1, &gradient(-(information * residual)));
        residual.dot(&(information * residual))
    }

    /// Adds the random walk of the bias, and its measurement by the gyro at rest.
    fn add_bias(&self, system: &mut WindowSystem, i: usize, (from, to): (&ChainState, &ChainState)) -> f64 {
        let walk = self.config.gyro_bias_walk.powi(2) * self.motion.duration + MIN_BIAS_WALK_VARIANCE;
        let off = to.bias - from.bias;
        let rest = self.motion.rest;
        let noise = self.config.gyro_rate_noise.powi(2) / rest.readings.max(1.0);
        let at_rest = if rest.readings > 0.0 { 1.0 / noise } else { 0.0 };
        let measured = if rest.time > 0.0 { rest.turn / rest.time - from.bias } else { 0.0 };
        let mut add = |j: usize, second: f64, first: f64| {
            let mut block = ChainBlock::zeros();
            block[(BIAS_PLACE, BIAS_PLACE)] = second;
            let mut gradient = SVector::<f64, CHAIN_SIZE>::zeros();
            gradient[BIAS_PLACE] = first;
            system.add_diagonal(j, &block);
            system.add_gradient(j, &gradient);
        };
        add(i, 1.0 / walk + at_rest, off / walk + measured * at_rest);
        add(i + 1, 1.0 / walk, -off / walk);
        let mut block = ChainBlock::zeros();
        block[(BIAS_PLACE, BIAS_PLACE)] = -1.0 / walk;
        system.add_next(i, &block);
        off * off / walk + measured * measured * at_rest
    }
}

/// Variance of the bias's walk between two keyframes at one stamp, (rad/s)^2. Source: ours; it keeps the equations definite.
const MIN_BIAS_WALK_VARIANCE: f64 = 1e-12;

/// A residual between two poses by the motion, with its derivatives.
pub(crate) struct MotionResidual {
    pub(crate) residual: Vector3<f64>,
    pub(crate) by_from: Matrix3<f64>,
    pub(crate) by_to: Matrix3<f64>,
    pub(crate) by_parameters: SMatrix<f64, 3, 5>,
}

/// The motion between two poses minus that by wheels and gyro.
pub(crate) fn linearise_motion(
    motion: &Preintegrated,
    (from, to): (&ChainState, &ChainState),
    border: &BorderState,
) -> MotionResidual {
    let off = motion.by_parameters * (parameters(from.bias, border) - motion.at);
    let measured = motion.motion * Pose2::exp(off);
    let residual = (measured.inverse() * from.pose.inverse() * to.pose).log();
    let by_to = inverse_right_jacobian(&residual);
    let by_from = -by_to * (to.pose.inverse() * from.pose).adjoint();
    let by_parameters = -inverse_left_jacobian(&residual) * right_jacobian(&off) * motion.by_parameters;
    MotionResidual { residual, by_from, by_to, by_parameters }
}

/// Adds a residual between keyframe `i` and the next one; returns its cost.
fn add_pair<const R: usize>(
    system: &mut WindowSystem,
    i: usize,
    (by_from, by_to, by_border): (
        &SMatrix<f64, R, CHAIN_SIZE>,
        &SMatrix<f64, R, CHAIN_SIZE>,
        &SMatrix<f64, R, BORDER_SIZE>,
    ),
    information: &SMatrix<f64, R, R>,
    residual: &SVector<f64, R>,
) -> f64 {
    let from: SMatrix<f64, CHAIN_SIZE, R> = by_from.transpose() * information;
    let to: SMatrix<f64, CHAIN_SIZE, R> = by_to.transpose() * information;
    let border: SMatrix<f64, BORDER_SIZE, R> = by_border.transpose() * information;
    system.add_diagonal(i, &(from * by_from));
    system.add_next(i, &(from * by_to));
    system.add_diagonal(i + 1, &(to * by_to));
    let coupling: Coupling = from * by_border;
    system.add_coupling(i, &coupling);
    system.add_coupling(i + 1, &(to * by_border));
    system.add_gradient(i, &-(from * residual));
    system.add_gradient(i + 1, &-(to * residual));
    system.add_border(&(border * by_border), &-(border * residual));
    residual.dot(&(information * residual))
}
