//! Online calibration of the gyro's bias and scale.

use crate::odometry_config::OdometryConfig;
use nalgebra::{Matrix2, RowVector2};

/// Kalman filter of the gyro's bias and scale, updated at rest and by turns that the camera measured.
#[derive(Debug, Clone)]
pub(crate) struct GyroCalibration {
    /// Bias, rad/s.
    bias: f64,
    /// True turn over measured turn.
    scale: f64,
    /// Covariance of bias and scale.
    covariance: Matrix2<f64>,
    /// Covariance of bias and scale without any measurement.
    unknown: Matrix2<f64>,
    is_measured: bool,
    /// Time since the last update of the bias, s.
    time_since_update: f64,
    /// Number of consecutive turns outside the gate.
    rejected_in_row: usize,
}

/// A turn of the base measured by both camera and gyro.
#[derive(Debug, Clone, Copy)]
pub(crate) struct VisualTurn {
    /// Turn by the camera, rad.
    pub(crate) by_camera: f64,
    /// Standard deviation of the camera's turn, rad.
    pub(crate) camera_sigma: f64,
    /// Turn by the gyro, corrected by the known bias and scale, rad.
    pub(crate) by_gyro: f64,
    /// Duration of the turn, s.
    pub(crate) duration: f64,
}

/// Gate of the innovation, sigmas. Rates and turns beyond it are rejected. Source: ours.
const GATE_SIGMAS: f64 = 4.0;
/// Random walk of the scale, 1 / sqrt(s). The scale's variance grows by its square each second. Source: ours.
const SCALE_RANDOM_WALK: f64 = 3e-5;
/// Smallest sigma of the scale, ratio. The limit lets the filter follow changes, because errors of neighbouring turns are correlated.
/// Source: ours.
const MIN_SCALE_SIGMA: f64 = 3e-4;
/// Number of consecutive rejected turns that resets the filter, as after a change of the gyro. Source: ours.
const MAX_REJECTED_TURNS: usize = 3;
/// Correlation time of the bias error, s: the interval between keyframes. A longer time makes the heading less certain. Source: ours.
const BIAS_CORRELATION_S: f64 = 1.0;
/// Time without an update of the bias, s, beyond which the correlation time grows with that time. Source: ours.
const MAX_TIME_WITHOUT_UPDATE_S: f64 = 5.0;
/// Correlation angle of the scale error, rad. A larger angle makes the heading after a turn less certain. Source: ours.
const SCALE_CORRELATION_RAD: f64 = 1.0;
/// Factor on the gyro's noise at rest, ratio: a motor at rest vibrates. Rates beyond it count as turns. Source: ours.
const REST_NOISE_FACTOR: f64 = 2.0;

impl GyroCalibration {
    pub(crate) fn new(config: &OdometryConfig) -> Self {
        let variances = [config.gyro_bias_sigma, config.gyro_scale_sigma].map(|sigma| sigma * sigma);
        let unknown = Matrix2::from_diagonal(&variances.into());
        let (bias, scale, covariance) = (0.0, 1.0, unknown);
        Self {
            bias,
            scale,
            covariance,
            unknown,
            is_measured: false,
            time_since_update: 0.0,
            rejected_in_row: 0,
        }
    }

    /// The bias, rad/s; 0 without any measurement.
    pub(crate) fn bias(&self) -> f64 {
        self.bias
    }

    /// True turn over measured turn.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Standard deviation of the scale, ratio.
    pub(crate) fn scale_sigma(&self) -> f64 {
        self.covariance.m22.max(0.0).sqrt()
    }

    /// Whether the bias was measured.
    pub(crate) fn is_measured(&self) -> bool {
        self.is_measured
    }

    /// The corrected turn (rad) for a turn that the gyro measured over `dt` s.
    pub(crate) fn corrected_turn(&self, measured: f64, dt: f64) -> f64 {
        (measured - self.bias * dt) * self.scale
    }

    /// Variance of a corrected turn, rad^2.
    pub(crate) fn turn_variance(&self, config: &OdometryConfig, turn: f64, dt: f64) -> f64 {
        let by_turn = config.gyro_turn_noise.powi(2) + self.covariance.m22 * SCALE_CORRELATION_RAD;
        let correlation_time =
            BIAS_CORRELATION_S + 2.0 * (self.time_since_update - MAX_TIME_WITHOUT_UPDATE_S).max(0.0);
        let by_time = config.gyro_time_noise.powi(2) + self.covariance.m11 * correlation_time;
        by_turn * turn.abs() + by_time * dt
    }

    /// Prediction step of the filter: random walks of bias and scale over `dt` s.
    pub(crate) fn predict(&mut self, config: &OdometryConfig, dt: f64) {
        self.time_since_update += dt;
        let grown = |variance: f64, walk: f64, max: f64| (variance + walk * walk * dt).min(max);
        self.covariance.m11 = grown(self.covariance.m11, config.gyro_bias_walk, self.unknown.m11);
        self.covariance.m22 = grown(self.covariance.m22, SCALE_RANDOM_WALK, self.unknown.m22);
    }

    /// Whether a robot at rest can show this rate (rad/s).
    pub(crate) fn is_rest_rate(&self, config: &OdometryConfig, rate: f64) -> bool {
        let sigma = (self.covariance.m11 + (REST_NOISE_FACTOR * config.gyro_rate_noise).powi(2)).sqrt();
        (rate - self.bias).abs() <= GATE_SIGMAS * sigma
    }

    /// Update by a rate (rad/s) measured at rest.
    pub(crate) fn update_at_rest(&mut self, config: &OdometryConfig, rate: f64) {
        self.update(RowVector2::new(1.0, 0.0), rate - self.bias, config.gyro_rate_noise);
        self.is_measured = true;
    }

    /// Update by a turn that the camera measured. Several consecutive turns outside the gate reset the filter.
    pub(crate) fn update_by_visual_turn(&mut self, turn: &VisualTurn) {
        let slope = RowVector2::new(-self.scale * turn.duration, turn.by_gyro / self.scale);
        let innovation = turn.by_camera - turn.by_gyro;
        if !self.is_within_gate(slope, innovation, turn.camera_sigma) {
            self.rejected_in_row += 1;
            if self.rejected_in_row < MAX_REJECTED_TURNS {
                return;
            }
            self.covariance = self.unknown;
        }
        self.rejected_in_row = 0;
        if self.is_within_gate(slope, innovation, turn.camera_sigma) {
            self.update(slope, innovation, turn.camera_sigma);
            self.is_measured |= self.covariance.m11 < 0.25 * self.unknown.m11;
        }
    }

    /// Whether an innovation is within the gate.
    fn is_within_gate(&self, slope: RowVector2<f64>, innovation: f64, sigma: f64) -> bool {
        innovation * innovation <= GATE_SIGMAS.powi(2) * self.innovation_variance(slope, sigma)
    }

    /// Variance of the innovation of a measurement with this Jacobian and sigma.
    fn innovation_variance(&self, slope: RowVector2<f64>, sigma: f64) -> f64 {
        (slope * self.covariance * slope.transpose()).x + sigma * sigma
    }

    /// Kalman update by an innovation; `slope` is the Jacobian of the measurement by bias and scale.
    fn update(&mut self, slope: RowVector2<f64>, innovation: f64, sigma: f64) {
        let gain = self.covariance * slope.transpose() / self.innovation_variance(slope, sigma);
        self.bias += gain.x * innovation;
        self.scale += gain.y * innovation;
        let left = Matrix2::identity() - gain * slope;
        // Joseph's form remains symmetric and positive.
        self.covariance = left * self.covariance * left.transpose() + gain * gain.transpose() * sigma.powi(2);
        let min_variance = MIN_SCALE_SIGMA.powi(2).min(self.unknown.m22);
        self.covariance.m22 = self.covariance.m22.max(min_variance);
        self.time_since_update = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bias_converges_to_the_mean_rate_and_a_turn_is_not_rest() {
        let config = OdometryConfig::default();
        let mut gyro = GyroCalibration::new(&config);
        assert!(gyro.is_rest_rate(&config, 0.04) && !gyro.is_measured());
        for i in 0..200 {
            gyro.predict(&config, 0.02);
            gyro.update_at_rest(&config, 0.013 + if i % 2 == 0 { 0.01 } else { -0.01 });
        }
        assert!((gyro.bias() - 0.013).abs() < 0.001, "{}", gyro.bias());
        assert!(gyro.is_measured() && !gyro.is_rest_rate(&config, 0.1));
        assert_eq!(gyro.scale(), 1.0, "rest says nothing about turns");
    }

    #[test]
    fn turns_to_both_sides_separate_bias_from_scale() {
        let config = OdometryConfig::default();
        let (mut gyro, before) = (GyroCalibration::new(&config), GyroCalibration::new(&config));
        let (bias, scale) = (0.004, 1.006);
        for turn in [1.0, -1.0, 1.2, -0.8, 0.0, 0.1].repeat(4) {
            let measured = turn / scale + bias * 3.0;
            let by_gyro = gyro.corrected_turn(measured, 3.0);
            gyro.update_by_visual_turn(&VisualTurn {
                by_camera: turn,
                camera_sigma: 0.003,
                by_gyro,
                duration: 3.0,
            });
        }
        assert!((gyro.bias() - bias).abs() < 3e-4, "{}", gyro.bias());
        assert!((gyro.scale() - scale).abs() < 1e-3, "{}", gyro.scale());
        let surer =
            |turn, dt| gyro.turn_variance(&config, turn, dt) < 0.5 * before.turn_variance(&config, turn, dt);
        assert!(surer(1.0, 0.0) && surer(0.0, 1.0));
    }

    #[test]
    fn a_changed_bias_is_estimated_again_and_one_wrong_turn_is_rejected() {
        let config = OdometryConfig::default();
        let mut gyro = GyroCalibration::new(&config);
        (0..100).for_each(|_| gyro.update_at_rest(&config, 0.0));
        let straight = |gyro: &mut GyroCalibration, bias: f64| {
            let by_gyro = gyro.corrected_turn(bias * 3.0, 3.0);
            gyro.update_by_visual_turn(&VisualTurn {
                by_camera: 0.0,
                camera_sigma: 0.003,
                by_gyro,
                duration: 3.0,
            });
        };
        straight(&mut gyro, 0.03);
        assert!(gyro.bias().abs() < 1e-3, "{}", gyro.bias());
        straight(&mut gyro, 0.0);
        (0..5).for_each(|_| straight(&mut gyro, 0.03));
        assert!((gyro.bias() - 0.03).abs() < 1e-3, "{}", gyro.bias());
    }

    #[test]
    fn heading_variance_without_updates_is_that_of_a_bias_random_walk() {
        let config = OdometryConfig::default();
        let mut gyro = GyroCalibration::new(&config);
        (0..100).for_each(|_| gyro.update_at_rest(&config, 0.0));
        let variance: f64 = (0..3000)
            .map(|_| {
                gyro.predict(&config, 0.02);
                gyro.turn_variance(&config, 0.0, 0.02)
            })
            .sum();
        // The bias walks: the integral of a random walk.
        let walked = config.gyro_bias_walk.powi(2) * 60.0_f64.powi(3) / 3.0;
        assert!((0.5..3.0).contains(&(variance / walked)), "{}", variance / walked);
    }

    #[test]
    fn a_sigma_of_zero_keeps_the_nominal_bias_and_scale() {
        let config = OdometryConfig { gyro_bias_sigma: 0.0, gyro_scale_sigma: 0.0, ..Default::default() };
        let mut gyro = GyroCalibration::new(&config);
        let turn = VisualTurn { by_camera: 1.0, camera_sigma: 0.003, by_gyro: 0.9, duration: 3.0 };
        (0..9).for_each(|_| gyro.update_by_visual_turn(&turn));
        gyro.update_at_rest(&config, 0.01);
        assert_eq!((gyro.bias(), gyro.scale()), (0.0, 1.0));
    }
}
