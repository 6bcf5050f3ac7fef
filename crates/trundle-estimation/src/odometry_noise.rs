//! Covariances of the motions between two readings of the odometry.

use crate::odometry_config::OdometryConfig;
use nalgebra::Matrix3;
use std::f64::consts::PI;
use trundle_core::{Hypotenuse, Pose2};

/// One small motion of the base, with the source of its turn.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    /// Distance forward, m.
    pub(crate) distance: f64,
    /// Counter-clockwise, rad.
    pub(crate) turn: f64,
    /// Duration, s.
    pub(crate) dt: f64,
    /// Variance of a turn measured by the gyro, rad^2.
    pub(crate) by_gyro: Option<f64>,
    /// Difference of the distances by wheels and gyro during a slip, m; else 0.
    pub(crate) slip: f64,
}

impl OdometryConfig {
    /// Covariance of a small motion of the base measured by wheels without a gyro, as a right perturbation (x m, y m, theta rad).
    pub fn by_wheels(&self, motion: &Pose2) -> Matrix3<f64> {
        let distance = motion.x.hypotenuse(motion.y);
        of_step(self, &Step { distance, turn: motion.theta, dt: 0.0, by_gyro: None, slip: 0.0 })
    }
}

/// Turn per metre of unknown motion, rad/m. A larger value makes the heading after a gap less certain. Source: ours.
const GAP_TURN_RAD_PER_M: f64 = 3.0;
/// Largest distance of an unknown motion, m. Larger variances would lose the noise of later steps to rounding. Source: ours.
const MAX_GAP_DISTANCE_M: f64 = 10.0;

/// The covariance of a step as a right perturbation.
pub(crate) fn of_step(config: &OdometryConfig, step: &Step) -> Matrix3<f64> {
    let (distance, turn) = (step.distance.abs(), step.turn.abs());
    let slip = config.slip_length * step.slip;
    // These two constants include slip that the gyro does not measure.
    let by_wheels = config.wheel_turn_noise.powi(2) * turn + config.wheel_distance_noise.powi(2) * distance;
    let heading = step.by_gyro.unwrap_or(by_wheels);
    let spot = config.spot_noise.powi(2) * turn + slip;
    Matrix3::from_diagonal(&nalgebra::Vector3::new(
        config.distance_noise.powi(2) * distance + spot,
        config.sideways_noise.powi(2) * distance + spot,
        heading,
    ))
}

/// The covariance of an unknown motion of `gap` s.
pub(crate) fn of_gap(config: &OdometryConfig, gap: f64) -> Matrix3<f64> {
    let distance = (config.gap_speed * gap).min(MAX_GAP_DISTANCE_M).powi(2);
    let turn = (GAP_TURN_RAD_PER_M * GAP_TURN_RAD_PER_M * distance).min(PI * PI);
    Matrix3::from_diagonal(&nalgebra::Vector3::new(distance, distance, turn))
}

/// Unmeasured motion of the base.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct UnobservedMotion {
    /// Variance of the distance, m^2.
    pub(crate) distance_variance: f64,
    /// Variance of the turn, rad^2.
    pub(crate) turn_variance: f64,
}

/// Correlation time of an unobserved motion, s. With a longer time the variance grows faster. Source: ours.
const UNOBSERVED_CORRELATION_S: f64 = 2.0;
/// Sideways part of an unobserved distance, ratio: the path may curve. Source: ours.
const UNOBSERVED_SIDEWAYS_RATIO: f64 = 0.2;

impl UnobservedMotion {
    /// A motion of at most this distance (m) and turn (rad).
    pub(crate) fn of_total(distance: f64, turn: f64) -> Self {
        Self { distance_variance: distance * distance, turn_variance: turn * turn }
    }

    /// A motion of `dt` s at up to this speed (m/s) and turn rate (rad/s).
    pub(crate) fn of_speeds(v: f64, omega: f64, dt: f64) -> Self {
        let grown = |speed: f64| speed * speed * UNOBSERVED_CORRELATION_S * dt;
        Self { distance_variance: grown(v), turn_variance: grown(omega) }
    }

    /// Covariance as a right perturbation (x m, y m, theta rad); a gyro measures the turn.
    pub(crate) fn covariance(&self, has_gyro: bool) -> Matrix3<f64> {
        let turn = if has_gyro { 0.0 } else { self.turn_variance };
        let sideways = UNOBSERVED_SIDEWAYS_RATIO * UNOBSERVED_SIDEWAYS_RATIO * self.distance_variance;
        Matrix3::from_diagonal(&nalgebra::Vector3::new(self.distance_variance, sideways, turn))
    }
}
