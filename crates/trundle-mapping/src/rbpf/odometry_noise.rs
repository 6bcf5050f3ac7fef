//! Scale of the random errors of the odometry, estimated from the scan matches.

use nalgebra::{Matrix3, Vector3};

/// Scale of the odometry's random errors, learnt from the scan matches.
///
/// The configuration holds the errors of the worst usable odometry; a robot with a gyro may be ten times better. Too large errors spread
/// the particles where a scan determines little. For each step that a match determines in all directions, e = (match - odometry)^2 /
/// (configured variance) estimates the squared scale of the errors plus the variance of the match. The ratio of the two sums, each with
/// exponential forgetting, is the scale (a moment estimate of the motion model's parameters, after \[Eliazar04\]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct OdometryNoise {
    shift: Moments,
    turn: Moments,
}

/// Sums of errors and of their weights, and the number of steps in them.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Moments {
    errors: f64,
    weights: f64,
    steps: f64,
}

/// Difference between match and odometry in a step, base frame: cells, cells, rad.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Innovation {
    /// Displacement from the odometry's pose to the optimum of the hits alone.
    pub(crate) off: Vector3<f64>,
    /// Variances that remain after the match.
    pub(crate) open: Vector3<f64>,
}

/// Maximum error of a step [sigmas of configuration and match]. A larger error counts as this one. Source: ours.
const MAX_ERROR_SIGMAS: f64 = 3.0;
/// Number of steps that the sums cover. Source: ours.
const MEMORY_STEPS: f64 = 60.0;
/// Number of steps with the configured errors that the sums begin with. Source: ours.
const PRIOR_STEPS: f64 = 4.0;
/// Factor on the learnt scale of the errors \[1\]: errors of successive steps are correlated. Source:
/// docs/experiments/mapping-odometry.md.
const ERROR_SCALE_FACTOR: f64 = 3.0;
/// Minimum scale of the errors relative to the configured ones \[1\]. Source: ours.
const MIN_ERROR_SCALE: f64 = 0.15;

impl Default for OdometryNoise {
    fn default() -> Self {
        let moments = Moments { errors: PRIOR_STEPS, weights: PRIOR_STEPS, steps: PRIOR_STEPS };
        Self { shift: moments, turn: moments }
    }
}

impl OdometryNoise {
    /// Records a step; `covariance` is the configured one of the step's motion.
    pub(crate) fn learn(&mut self, step: &Innovation, covariance: &Matrix3<f64>) {
        for k in 0..3 {
            let variance = covariance[(k, k)];
            let open = step.open[k] / variance;
            let max = MAX_ERROR_SIGMAS * MAX_ERROR_SIGMAS * (1.0 + open);
            let error = (step.off[k] * step.off[k] / variance).min(max) - open;
            // A match with a larger variance than the odometry's has little weight.
            let weight = (1.0 + open).powi(-2);
            let moments = if k < 2 { &mut self.shift } else { &mut self.turn };
            moments.add(error, weight * if k < 2 { 0.5 } else { 1.0 });
        }
    }

    /// Adds a step with wrong odometry.
    pub(crate) fn doubt(&mut self) {
        self.shift.add(MAX_ERROR_SIGMAS * MAX_ERROR_SIGMAS, 1.0);
        self.turn.add(MAX_ERROR_SIGMAS * MAX_ERROR_SIGMAS, 1.0);
    }

    /// The configured covariance of a motion, scaled by the learnt errors.
    pub(crate) fn scaled(&self, covariance: &Matrix3<f64>) -> Matrix3<f64> {
        let (shift, turn) = (self.shift.scale(), self.turn.scale());
        let scale = Matrix3::from_diagonal(&Vector3::new(shift, shift, turn));
        scale * covariance * scale
    }

    /// The state as numbers, for saving.
    pub(crate) fn numbers(&self) -> [f64; 6] {
        let Self { shift, turn } = self;
        [shift.errors, shift.weights, shift.steps, turn.errors, turn.weights, turn.steps]
    }

    /// Restores the state from its numbers; impossible numbers restart the estimate.
    pub(crate) fn from_numbers([a, b, c, d, e, f]: [f64; 6]) -> Self {
        let new = Self {
            shift: Moments { errors: a, weights: b, steps: c },
            turn: Moments { errors: d, weights: e, steps: f },
        };
        let fair = |m: &Moments| m.weights > 0.0 && m.steps > 0.0;
        if fair(&new.shift) && fair(&new.turn) { new } else { Self::default() }
    }
}

impl Moments {
    fn add(&mut self, error: f64, weight: f64) {
        let keep = 1.0 - 1.0 / MEMORY_STEPS;
        if self.steps < MEMORY_STEPS {
            self.steps += weight;
        } else {
            (self.errors, self.weights) = (self.errors * keep, self.weights * keep);
        }
        self.errors += weight * error;
        self.weights += weight;
    }

    fn scale(&self) -> f64 {
        (ERROR_SCALE_FACTOR * (self.errors / self.weights).max(0.0).sqrt()).clamp(MIN_ERROR_SCALE, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rbpf::rng::ParticleRng;

    fn estimated_noise(good: f64, steps: usize) -> OdometryNoise {
        let covariance = Matrix3::from_diagonal(&Vector3::new(2.0, 1.0, 0.01));
        let (mut trust, mut rng) = (OdometryNoise::default(), ParticleRng::new(1, 0, 0));
        let open = Vector3::new(0.02, 0.02, 1e-4);
        for _ in 0..steps {
            let (error, noise) = (rng.normal3() * good, rng.normal3());
            let off = Vector3::from_fn(|k, _| {
                error[k] * f64::sqrt(covariance[(k, k)]) + noise[k] * f64::sqrt(open[k])
            });
            trust.learn(&Innovation { off, open }, &covariance);
        }
        trust
    }

    #[test]
    fn learns_how_good_the_odometry_is_and_forgets_it() {
        for good in [0.1, 0.2, 0.3] {
            let trust = estimated_noise(good, 300);
            assert!((trust.shift.scale() - ERROR_SCALE_FACTOR * good).abs() < 0.2, "{good}: {trust:?}");
            assert!((trust.turn.scale() - ERROR_SCALE_FACTOR * good).abs() < 0.25, "{good}: {trust:?}");
        }
        assert_eq!(estimated_noise(0.0, 400).turn.scale(), MIN_ERROR_SCALE);
        assert_eq!(estimated_noise(3.0, 50).shift.scale(), 1.0);
        let mut trust = estimated_noise(0.2, 300);
        let covariance = Matrix3::identity();
        for _ in 0..8 {
            let wild = Innovation { off: Vector3::repeat(4.0), open: Vector3::repeat(0.01) };
            trust.learn(&wild, &covariance);
        }
        assert!(trust.turn.scale() > 0.8, "eight wild steps are accepted: {trust:?}");
        assert_eq!(OdometryNoise::from_numbers(trust.numbers()), trust);
    }

    #[test]
    fn a_match_that_holds_little_teaches_little() {
        let (covariance, mut trust) = (Matrix3::identity(), OdometryNoise::default());
        for _ in 0..30 {
            let off = Vector3::repeat(10.0_f64.sqrt());
            trust.learn(&Innovation { off, open: Vector3::repeat(10.0) }, &covariance);
        }
        assert!(trust.shift.scale() > 0.9, "{trust:?}");
    }
}
