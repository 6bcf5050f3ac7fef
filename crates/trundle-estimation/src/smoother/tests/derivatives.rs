//! Derivatives of the factors against numeric differences.

use super::super::factors::{ScanFactor, VisualFactor, linearise_motion};
use super::super::preintegration::{Parameters, Preintegrated, spread};
use super::super::state::{BORDER_SIZE, BorderState, CHAIN_SIZE, ChainState, POSE_PLACE};
use super::fixture::{increment, wave};
use crate::odometry_config::OdometryConfig;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use trundle_core::Pose2;

/// Step of the differences, and largest relative error of a derivative.
const DIFFERENCE_STEP: f64 = 1e-6;
const SLOPE_TOLERANCE: f64 = 2e-5;

fn chain(i: i64) -> ChainState {
    ChainState {
        pose: Pose2::new(3.0 * wave(i, 0.1), 2.0 * wave(i, 0.2), 2.0 * wave(i, 0.3)),
        error: Vector3::new(wave(i, 0.4), wave(i, 0.5), wave(i, 0.6)) * 0.3,
        bias: 0.01 * wave(i, 0.7),
    }
}

fn border(i: i64) -> BorderState {
    let pose = |phase: f64| Pose2::new(wave(i, phase), wave(i, phase + 0.3), 2.0 * wave(i, phase + 0.6));
    BorderState {
        scale: 1.0 + 0.01 * wave(i, 0.8),
        wheels: Vector3::new(1.01, 0.99, 1.005),
        delay: 0.02 * wave(i, 0.9),
        anchors: [pose(0.0), pose(1.0), pose(2.0)],
    }
}

fn unit<const N: usize>(k: usize) -> SVector<f64, N> {
    let mut step = SVector::<f64, N>::zeros();
    step[k] = DIFFERENCE_STEP;
    step
}

/// Checks derivatives by keyframe and border of a residual.
fn check(
    residual: impl Fn(&ChainState, &BorderState) -> Vector3<f64>,
    (by_chain, by_border): (SMatrix<f64, 3, CHAIN_SIZE>, SMatrix<f64, 3, BORDER_SIZE>),
    (state, common): (&ChainState, &BorderState),
) {
    for k in 0..CHAIN_SIZE {
        let slope = (residual(&state.moved(&unit(k)), common) - residual(&state.moved(&-unit(k)), common))
            / (2.0 * DIFFERENCE_STEP);
        assert!(
            (slope - by_chain.column(k)).norm() < SLOPE_TOLERANCE * (1.0 + slope.norm()),
            "keyframe {k}: {slope}"
        );
    }
    for k in 0..BORDER_SIZE {
        let slope = (residual(state, &common.moved(&unit(k))) - residual(state, &common.moved(&-unit(k))))
            / (2.0 * DIFFERENCE_STEP);
        assert!(
            (slope - by_border.column(k)).norm() < SLOPE_TOLERANCE * (1.0 + slope.norm()),
            "border {k}: {slope}"
        );
    }
}

#[test]
fn of_visual_poses() {
    for i in 0..20 {
        let factor = VisualFactor {
            pose: Pose2::new(wave(i, 3.0), wave(i, 3.3), 2.0 * wave(i, 3.6)),
            velocity: Vector3::new(0.4, 0.0, 0.8),
            noise: Matrix3::identity(),
            slot: 1,
        };
        let (state, common) = (chain(i), border(i));
        let found = factor.linearise(&state, &common);
        let residual = |state: &ChainState, common: &BorderState| factor.linearise(state, common).residual;
        check(residual, (found.by_chain, found.by_border), (&state, &common));
    }
}

#[test]
fn of_scan_matches() {
    for i in 0..20 {
        let (state, common) = (chain(i), border(i));
        let near = Pose2::exp(Vector3::new(wave(i, 4.0), wave(i, 4.3), wave(i, 4.6)));
        let factor = ScanFactor { pose: state.pose * near, noise: Matrix3::identity() };
        let found = factor.linearise(&state);
        let residual = |state: &ChainState, _: &BorderState| factor.linearise(state).residual;
        check(residual, (found.by_chain, found.by_border), (&state, &common));
    }
}

fn integrated(at: Parameters) -> Preintegrated {
    let mut motion = Preintegrated::new(at);
    (50..90).for_each(|i| motion.add(&OdometryConfig::default(), 0.23, &increment(i)));
    motion
}

#[test]
fn of_motions_by_both_keyframes_and_the_border() {
    for i in 0..20 {
        let (from, common) = (chain(i), border(i));
        let motion = integrated(Parameters::from([0.0, 1.0, 1.0, 1.0, 1.0]));
        let off = Pose2::exp(Vector3::new(wave(i, 5.0), wave(i, 5.3), wave(i, 5.6)) * 0.1);
        let to = ChainState { pose: from.pose * motion.motion * off, ..chain(i + 1) };
        let found = linearise_motion(&motion, (&from, &to), &common);
        let (mut by_from, by_border) = spread(&found.by_parameters);
        by_from.fixed_columns_mut::<3>(POSE_PLACE).copy_from(&found.by_from);
        let residual =
            |from: &ChainState, common: &BorderState| linearise_motion(&motion, (from, &to), common).residual;
        check(residual, (by_from, by_border), (&from, &common));
        let mut by_to = SMatrix::<f64, 3, CHAIN_SIZE>::zeros();
        by_to.fixed_columns_mut::<3>(POSE_PLACE).copy_from(&found.by_to);
        let residual =
            |to: &ChainState, common: &BorderState| linearise_motion(&motion, (&from, to), common).residual;
        check(residual, (by_to, by_border), (&to, &common));
    }
}

#[test]
fn of_preintegrated_motions_by_the_calibration() {
    let at = Parameters::from([0.004, 1.003, 1.01, 0.99, 1.005]);
    let motion = integrated(at);
    for k in 0..5 {
        let mut step = Parameters::zeros();
        step[k] = DIFFERENCE_STEP;
        let (more, less) = (integrated(at + step), integrated(at - step));
        let slope = (less.motion.inverse() * more.motion).log() / (2.0 * DIFFERENCE_STEP);
        assert!(
            (slope - motion.by_parameters.column(k)).norm() < SLOPE_TOLERANCE * (1.0 + slope.norm()),
            "{k}: {slope}"
        );
        let turn = (more.wheels.turn - less.wheels.turn) / (2.0 * DIFFERENCE_STEP);
        assert!(
            (turn - motion.wheels.by_parameters[k]).abs() < SLOPE_TOLERANCE * (1.0 + turn.abs()),
            "{k}: {turn}"
        );
    }
}
