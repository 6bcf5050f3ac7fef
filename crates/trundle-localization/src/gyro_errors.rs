use crate::OdometryConfig;
use nalgebra::{Matrix2, RowVector2};

/// What a gyro tells wrong, learnt at rest and of what the camera saw: a Kalman filter of bias and scale.
#[derive(Debug, Clone)]
pub(crate) struct GyroErrors {
    /// rad/s.
    bias: f64,
    /// True turns over the gyro's.
    scale: f64,
    /// Of bias and scale.
    covariance: Matrix2<f64>,
    /// Before anything was measured.
    unknown: Matrix2<f64>,
    is_measured: bool,
    /// Since the bias was last learnt, s.
    untold: f64,
    /// Measurements in a row that were not believed.
    refused: usize,
}

/// A turn that the camera saw.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenTurn {
    /// By the camera, rad, and its standard deviation.
    pub(crate) by_camera: (f64, f64),
    /// By the gyro, less what was known of its errors, rad.
    pub(crate) by_gyro: f64,
    /// How long it took, s.
    pub(crate) time: f64,
}

/// Rates and turns farther than this many sigmas from what is expected are not believed.
const GATE_SIGMAS: f64 = 4.0;
/// How the scale may wander (one sigma, as a part, after 1 s): sensors get warm.
const SCALE_WALK: f64 = 3e-5;
/// Never surer of the scale than this (one sigma, as a part): neighbouring turns err alike.
const LEAST_SCALE_SIGMA: f64 = 3e-4;
/// So many in a row are right, and what was learnt is wrong: a gyro that was knocked, or got warm.
const MOST_REFUSED: usize = 3;
/// For so long what is wrong with the bias is wrong the same way, s: from one keyframe to the next, whose tie it is.
const BIAS_LASTS: f64 = 1.0;
/// Unless nothing has told the bias for longer than this, s: then it has been wrong the same way since.
const TOLD: f64 = 5.0;
/// For such a turn what is wrong with the scale is wrong the same way, rad.
const SCALE_LASTS: f64 = 1.0;
/// A robot at rest may tremble, and gyros may be noisier than told: so many times, before a rate is taken for a turn.
const TREMBLE: f64 = 2.0;

impl GyroErrors {
    pub(crate) fn new(config: &OdometryConfig) -> Self {
        let variances = [config.gyro_bias_sigma, config.gyro_scale_sigma].map(|sigma| sigma * sigma);
        let unknown = Matrix2::from_diagonal(&variances.into());
        let (bias, scale, covariance) = (0.0, 1.0, unknown);
        Self { bias, scale, covariance, unknown, is_measured: false, untold: 0.0, refused: 0 }
    }

    /// The bias, rad/s: 0 before it was measured.
    pub(crate) fn bias(&self) -> f64 {
        self.bias
    }

    /// True turns over the gyro's.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Whether the bias was ever measured.
    pub(crate) fn is_measured(&self) -> bool {
        self.is_measured
    }

    /// The turn (rad) behind one that the gyro told over `dt` s.
    pub(crate) fn true_turn(&self, told: f64, dt: f64) -> f64 {
        (told - self.bias * dt) * self.scale
    }

    /// The variance of that turn, rad^2.
    pub(crate) fn turn_variance(&self, config: &OdometryConfig, turn: f64, dt: f64) -> f64 {
        let by_turn = config.gyro_turn_noise.powi(2) + self.covariance.m22 * SCALE_LASTS;
        let lasts = BIAS_LASTS + 2.0 * (self.untold - TOLD).max(0.0);
        let by_time = config.gyro_time_noise.powi(2) + self.covariance.m11 * lasts;
        by_turn * turn.abs() + by_time * dt
    }

    /// Lets `dt` s pass.
    pub(crate) fn wander(&mut self, config: &OdometryConfig, dt: f64) {
        self.untold += dt;
        let grown = |variance: f64, walk: f64, most: f64| (variance + walk * walk * dt).min(most);
        self.covariance.m11 = grown(self.covariance.m11, config.gyro_bias_walk, self.unknown.m11);
        self.covariance.m22 = grown(self.covariance.m22, SCALE_WALK, self.unknown.m22);
    }

    /// Whether a rate (rad/s) could be that of a robot at rest.
    pub(crate) fn explains(&self, config: &OdometryConfig, rate: f64) -> bool {
        let sigma = (self.covariance.m11 + (TREMBLE * config.gyro_rate_noise).powi(2)).sqrt();
        (rate - self.bias).abs() <= GATE_SIGMAS * sigma
    }

    /// Takes in a rate (rad/s) of a robot at rest.
    pub(crate) fn rest(&mut self, config: &OdometryConfig, rate: f64) {
        self.learn(RowVector2::new(1.0, 0.0), rate - self.bias, config.gyro_rate_noise);
        self.is_measured = true;
    }

    /// Takes in a turn that the camera saw.
    pub(crate) fn seen(&mut self, turn: &SeenTurn) {
        let (by_camera, sigma) = turn.by_camera;
        let slope = RowVector2::new(-self.scale * turn.time, turn.by_gyro / self.scale);
        let off = by_camera - turn.by_gyro;
        if !self.believes(slope, off, sigma) {
            self.refused += 1;
            if self.refused < MOST_REFUSED {
                return;
            }
            self.covariance = self.unknown;
        }
        self.refused = 0;
        if self.believes(slope, off, sigma) {
            self.learn(slope, off, sigma);
            self.is_measured |= self.covariance.m11 < 0.25 * self.unknown.m11;
        }
    }

    /// Whether a measurement may differ by `off` from what is expected.
    fn believes(&self, slope: RowVector2<f64>, off: f64, sigma: f64) -> bool {
        off * off <= GATE_SIGMAS.powi(2) * self.spread(slope, sigma)
    }

    /// The variance of a measurement about what is expected.
    fn spread(&self, slope: RowVector2<f64>, sigma: f64) -> f64 {
        (slope * self.covariance * slope.transpose()).x + sigma * sigma
    }

    /// A measurement that differs by `off` from what is expected, and by `slope` from bias and scale.
    fn learn(&mut self, slope: RowVector2<f64>, off: f64, sigma: f64) {
        let gain = self.covariance * slope.transpose() / self.spread(slope, sigma);
        self.bias += gain.x * off;
        self.scale += gain.y * off;
        let left = Matrix2::identity() - gain * slope;
        // The form that stays symmetric and positive [Joseph].
        self.covariance = left * self.covariance * left.transpose() + gain * gain.transpose() * sigma.powi(2);
        let least = LEAST_SCALE_SIGMA.powi(2).min(self.unknown.m22);
        self.covariance.m22 = self.covariance.m22.max(least);
        self.untold = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn converges_to_the_mean_rate_and_refuses_a_turn() {
        let config = OdometryConfig::default();
        let mut gyro = GyroErrors::new(&config);
        assert!(gyro.explains(&config, 0.04) && !gyro.is_measured());
        for i in 0..200 {
            gyro.wander(&config, 0.02);
            gyro.rest(&config, 0.013 + if i % 2 == 0 { 0.01 } else { -0.01 });
        }
        assert!((gyro.bias() - 0.013).abs() < 0.001, "{}", gyro.bias());
        assert!(gyro.is_measured() && !gyro.explains(&config, 0.1));
        assert_eq!(gyro.scale(), 1.0, "rest says nothing about turns");
    }

    #[test]
    fn turns_to_both_sides_tell_bias_and_scale_apart() {
        let config = OdometryConfig::default();
        let (mut gyro, before) = (GyroErrors::new(&config), GyroErrors::new(&config));
        let (bias, scale) = (0.004, 1.006);
        for turn in [1.0, -1.0, 1.2, -0.8, 0.0, 0.1].repeat(4) {
            let told = turn / scale + bias * 3.0;
            let by_gyro = gyro.true_turn(told, 3.0);
            gyro.seen(&SeenTurn { by_camera: (turn, 0.003), by_gyro, time: 3.0 });
        }
        assert!((gyro.bias() - bias).abs() < 3e-4, "{}", gyro.bias());
        assert!((gyro.scale() - scale).abs() < 1e-3, "{}", gyro.scale());
        let surer =
            |turn, dt| gyro.turn_variance(&config, turn, dt) < 0.5 * before.turn_variance(&config, turn, dt);
        assert!(surer(1.0, 0.0) && surer(0.0, 1.0));
    }

    #[test]
    fn a_bias_that_jumps_is_learnt_anew_and_one_wrong_turn_is_not() {
        let config = OdometryConfig::default();
        let mut gyro = GyroErrors::new(&config);
        (0..100).for_each(|_| gyro.rest(&config, 0.0));
        let straight = |gyro: &mut GyroErrors, bias: f64| {
            let by_gyro = gyro.true_turn(bias * 3.0, 3.0);
            gyro.seen(&SeenTurn { by_camera: (0.0, 0.003), by_gyro, time: 3.0 });
        };
        straight(&mut gyro, 0.03);
        assert!(gyro.bias().abs() < 1e-3, "{}", gyro.bias());
        straight(&mut gyro, 0.0);
        (0..5).for_each(|_| straight(&mut gyro, 0.03));
        assert!((gyro.bias() - 0.03).abs() < 1e-3, "{}", gyro.bias());
    }

    #[test]
    fn in_the_dark_the_heading_is_told_as_uncertain_as_a_bias_makes_it() {
        let config = OdometryConfig::default();
        let mut gyro = GyroErrors::new(&config);
        (0..100).for_each(|_| gyro.rest(&config, 0.0));
        let variance: f64 = (0..3000)
            .map(|_| {
                gyro.wander(&config, 0.02);
                gyro.turn_variance(&config, 0.0, 0.02)
            })
            .sum();
        // The bias walks: the integral of a random walk.
        let walked = config.gyro_bias_walk.powi(2) * 60.0_f64.powi(3) / 3.0;
        assert!((0.5..3.0).contains(&(variance / walked)), "{}", variance / walked);
    }

    #[test]
    fn what_is_told_to_be_known_is_not_learnt() {
        let config = OdometryConfig { gyro_bias_sigma: 0.0, gyro_scale_sigma: 0.0, ..Default::default() };
        let mut gyro = GyroErrors::new(&config);
        (0..9).for_each(|_| gyro.seen(&SeenTurn { by_camera: (1.0, 0.003), by_gyro: 0.9, time: 3.0 }));
        gyro.rest(&config, 0.01);
        assert_eq!((gyro.bias(), gyro.scale()), (0.0, 1.0));
    }
}
