//! Measurements that have left the window, as a Gaussian over the oldest keyframe and the border.

use super::factors::WindowSystem;
use super::state::{
    BIAS_PLACE, BORDER_SIZE, BorderBlock, BorderState, CHAIN_SIZE, ChainState, Coupling, DELAY_PLACE,
    ERROR_PLACE, FIRST_ANCHOR_PLACE, JOINT_SIZE, JointMatrix, JointVector, POSE_PLACE, SCALE_PLACE,
    WHEELS_PLACE,
};
use nalgebra::{Matrix3, SMatrix, SVector};
use trundle_core::Pose2;
use trundle_optim::ArrowMarginal;

/// The prior: information and right side at a fixed point.
///
/// A keyframe that leaves the window is removed by a Schur complement at its last linearisation point. The prior keeps this point: later
/// steps change the residual but not the derivatives (a prior of fixed linearisation). The first keyframe fixes the map frame. All
/// directions are therefore observable, and mixed linearisation points add no false information (Huang et al. 2010).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Prior {
    information: JointMatrix,
    gradient: JointVector,
    chain: ChainState,
    border: BorderState,
}

/// Sigmas of the unknowns before any measurement.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PriorSigmas {
    /// Covariance of the pose.
    pub(crate) pose: Matrix3<f64>,
    /// Bias of the gyro, rad/s.
    pub(crate) bias: f64,
    /// Scale of the gyro, ratio.
    pub(crate) scale: f64,
    /// Radius of a wheel, ratio.
    pub(crate) radius: f64,
    /// Wheelbase, ratio.
    pub(crate) wheelbase: f64,
    /// Delay of the camera, s.
    pub(crate) delay: f64,
}

/// Smallest sigma of an unknown, in its unit. A calibration value that is never estimated has this sigma. Source: ours; it keeps the
/// equations definite.
const MIN_SIGMA: f64 = 1e-7;
/// Sigma of the pose at power-on, m and rad: it defines the map frame. Source: ours; it keeps the equations definite.
const START_SIGMA: f64 = 1e-5;
/// Sigma of an anchor before any measurement, m and rad. Source: ours; larger than any building.
const UNKNOWN_ANCHOR_SIGMA: f64 = 1e3;
/// Random walks, ratio per sqrt(s): gyro's scale, wheels' radii and base; s per sqrt(s): delay; m and rad per sqrt(s): anchors. Source:
/// ours; they let the unknowns follow changes.
const SCALE_WALK: f64 = 3e-5;
const WHEEL_WALK: f64 = 1e-5;
const DELAY_WALK: f64 = 1e-6;
const ANCHOR_WALK: f64 = 1e-6;

impl Prior {
    /// The prior of a window that begins at `chain`.
    pub(crate) fn new(chain: ChainState, border: BorderState, sigmas: &PriorSigmas) -> Self {
        let mut information = JointMatrix::zeros();
        let pose = sigmas.pose + Matrix3::identity() * (START_SIGMA * START_SIGMA);
        let known = pose.try_inverse().unwrap_or_else(Matrix3::zeros);
        information.fixed_view_mut::<3, 3>(POSE_PLACE, POSE_PLACE).copy_from(&known);
        let mut set = |place: usize, sigma: f64| {
            information[(place, place)] = sigma.max(MIN_SIGMA).powi(-2);
        };
        (ERROR_PLACE..ERROR_PLACE + 3).for_each(|place| set(place, START_SIGMA));
        set(BIAS_PLACE, sigmas.bias);
        set(CHAIN_SIZE + SCALE_PLACE, sigmas.scale);
        (0..2).for_each(|wheel| set(CHAIN_SIZE + WHEELS_PLACE + wheel, sigmas.radius));
        set(CHAIN_SIZE + WHEELS_PLACE + 2, sigmas.wheelbase);
        set(CHAIN_SIZE + DELAY_PLACE, sigmas.delay);
        (FIRST_ANCHOR_PLACE..BORDER_SIZE).for_each(|place| set(CHAIN_SIZE + place, UNKNOWN_ANCHOR_SIGMA));
        Self { information, gradient: JointVector::zeros(), chain, border }
    }

    /// The prior from a removed keyframe at these values, after `time` s.
    pub(crate) fn after(
        marginal: &ArrowMarginal<CHAIN_SIZE, BORDER_SIZE>,
        chain: ChainState,
        border: BorderState,
        time: f64,
    ) -> Self {
        let mut information = JointMatrix::zeros();
        information.fixed_view_mut::<CHAIN_SIZE, CHAIN_SIZE>(0, 0).copy_from(&marginal.block);
        information.fixed_view_mut::<CHAIN_SIZE, BORDER_SIZE>(0, CHAIN_SIZE).copy_from(&marginal.coupling);
        information
            .fixed_view_mut::<BORDER_SIZE, CHAIN_SIZE>(CHAIN_SIZE, 0)
            .copy_from(&marginal.coupling.transpose());
        information
            .fixed_view_mut::<BORDER_SIZE, BORDER_SIZE>(CHAIN_SIZE, CHAIN_SIZE)
            .copy_from(&marginal.border);
        let mut gradient = JointVector::zeros();
        gradient.fixed_rows_mut::<CHAIN_SIZE>(0).copy_from(&marginal.gradient);
        gradient.fixed_rows_mut::<BORDER_SIZE>(CHAIN_SIZE).copy_from(&marginal.border_gradient);
        let mut prior = Self { information, gradient, chain, border };
        prior.walk(time);
        prior
    }

    /// Adds the random walk of the border over `time` s.
    fn walk(&mut self, time: f64) {
        let mut inverse_noise = SVector::<f64, BORDER_SIZE>::repeat(ANCHOR_WALK);
        inverse_noise[SCALE_PLACE] = SCALE_WALK;
        inverse_noise.fixed_rows_mut::<3>(WHEELS_PLACE).fill(WHEEL_WALK);
        inverse_noise[DELAY_PLACE] = DELAY_WALK;
        let time = time.max(1e-3);
        inverse_noise.apply(|walk| *walk = 1.0 / (*walk * *walk * time));
        let rows: SMatrix<f64, BORDER_SIZE, JOINT_SIZE> =
            self.information.fixed_rows::<BORDER_SIZE>(CHAIN_SIZE).into();
        let own: BorderBlock =
            self.information.fixed_view::<BORDER_SIZE, BORDER_SIZE>(CHAIN_SIZE, CHAIN_SIZE).into();
        let Some(lower) = (own + BorderBlock::from_diagonal(&inverse_noise)).cholesky() else { return };
        let share = lower.solve(&self.gradient.fixed_rows::<BORDER_SIZE>(CHAIN_SIZE).into_owned());
        self.gradient -= rows.transpose() * share;
        self.information -= rows.transpose() * lower.solve(&rows);
        self.information = (self.information + self.information.transpose()) * 0.5;
    }

    /// Adds the prior to keyframe 0 of a system; returns its cost up to a constant.
    pub(crate) fn add_to(&self, system: &mut WindowSystem, chain: &ChainState, border: &BorderState) -> f64 {
        let mut step = JointVector::zeros();
        step.fixed_rows_mut::<CHAIN_SIZE>(0).copy_from(&chain.since(&self.chain));
        step.fixed_rows_mut::<BORDER_SIZE>(CHAIN_SIZE).copy_from(&border.since(&self.border));
        let moved = self.information * step;
        let gradient = self.gradient - moved;
        system.add_diagonal(0, &self.information.fixed_view::<CHAIN_SIZE, CHAIN_SIZE>(0, 0).into());
        let coupling: Coupling = self.information.fixed_view::<CHAIN_SIZE, BORDER_SIZE>(0, CHAIN_SIZE).into();
        system.add_coupling(0, &coupling);
        system.add_gradient(0, &gradient.fixed_rows::<CHAIN_SIZE>(0).into());
        system.add_border(
            &self.information.fixed_view::<BORDER_SIZE, BORDER_SIZE>(CHAIN_SIZE, CHAIN_SIZE).into(),
            &gradient.fixed_rows::<BORDER_SIZE>(CHAIN_SIZE).into(),
        );
        step.dot(&moved) - 2.0 * step.dot(&self.gradient)
    }

    /// Replaces the estimate of the anchor in a slot by `anchor` with this covariance, or by an unknown one.
    pub(crate) fn set_anchor(
        &mut self,
        slot: usize,
        anchor: trundle_core::Pose2,
        covariance: Option<Matrix3<f64>>,
    ) {
        let place = CHAIN_SIZE + FIRST_ANCHOR_PLACE + 3 * slot;
        self.forget(place);
        self.border.anchors[slot] = anchor;
        let unknown = Matrix3::identity() * UNKNOWN_ANCHOR_SIGMA.powi(2);
        let covariance = covariance.map_or(unknown, |known| known + Matrix3::identity() * MIN_SIGMA);
        let information = covariance.try_inverse().unwrap_or_else(Matrix3::zeros);
        self.information.fixed_view_mut::<3, 3>(place, place).copy_from(&information);
    }

    /// Moves the point of the prior with the map frame.
    pub(crate) fn move_all(&mut self, new_from_old: &Pose2, fixed_slot: usize) {
        self.chain.pose = *new_from_old * self.chain.pose;
        self.border.move_anchors(new_from_old, fixed_slot);
    }

    /// Removes three unknowns by a Schur complement.
    fn forget(&mut self, place: usize) {
        let rows: SMatrix<f64, 3, JOINT_SIZE> = self.information.fixed_rows::<3>(place).into();
        let own: Matrix3<f64> = self.information.fixed_view::<3, 3>(place, place).into();
        if let Some(inverse) = own.try_inverse() {
            let share = inverse * self.gradient.fixed_rows::<3>(place);
            self.gradient -= rows.transpose() * share;
            self.information -= rows.transpose() * inverse * rows;
        }
        self.information.fixed_rows_mut::<3>(place).fill(0.0);
        self.information.fixed_columns_mut::<3>(place).fill(0.0);
        self.gradient.fixed_rows_mut::<3>(place).fill(0.0);
    }
}
