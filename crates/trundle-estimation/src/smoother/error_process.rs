//! The error of visual poses along the path, and the switch of a recognised place.
//!
//! Problem: errors of neighbouring visual poses are nearly equal, because they come from the visible part of the visual map. Averages of
//! such poses gain little, but their differences measure the motion well. Idea: the error is a state of each keyframe, a Gauss-Markov
//! process along the path. With distance and turn it decays to zero with the covariance of the map part. A recognised place restarts the
//! process. A switch states whether the place is correct: its weight is the posterior probability against an error of any size.

use super::preintegration::Preintegrated;
use nalgebra::{Matrix3, Vector2, Vector3};

/// Step of the error from the previous keyframe.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ErrorStep {
    /// Stationary covariance of the error, in the axes of the visual map.
    pub(crate) stationary: Matrix3<f64>,
    /// Distance (m) and turn (rad) over which the error decays to 1/e.
    pub(crate) correlation: (f64, f64),
    /// Displacement of the visual pose since the previous keyframe, in the axes of the visual map, m.
    pub(crate) displacement: Vector2<f64>,
    /// Restart of the process at this keyframe, if any.
    pub(crate) start: Option<ErrorStart>,
}

/// Start of the error of visual poses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ErrorStart {
    /// A visual map begins: the image defines its frame, with zero error.
    NewMap,
    /// A place was recognised, or the visual frame jumped.
    Place(PlaceSwitch),
}

/// The switch of a recognised place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlaceSwitch {
    /// Probability that the place is correct, 0 to 1.
    pub(crate) weight: f64,
    /// Prior log-odds that the place is correct.
    pub(crate) prior_log_odds: f64,
}

/// Sigmas of the error at a wrong place, anywhere in a room: m, m, rad. Source: ours.
pub(crate) const WRONG_PLACE_SIGMAS: Vector3<f64> = Vector3::new(5.0, 5.0, 1.8);
/// Variance of the error of the first visual pose of a map, m^2 and rad^2. Source: ours; it keeps the equations definite.
const NEW_MAP_VARIANCE: f64 = 1e-8;
/// Smallest variance of the error's step, relative to its stationary variance: two keyframes at rest. Source: ours.
const MIN_STEP_RATIO: f64 = 1e-4;

impl ErrorStep {
    /// The error after a motion, and its derivative by the previous error; `trust` is the probability of the last recognised place.
    ///
    /// A map part rotated by an angle shifts the visual pose by the rotated displacement minus the displacement.
    pub(crate) fn moved(
        &self,
        before: &Vector3<f64>,
        motion: &Preintegrated,
        trust: f64,
    ) -> (Vector3<f64>, Matrix3<f64>) {
        let keep = self.keep(motion, trust);
        let (s, c) = before.z.sin_cos();
        let (x, y) = (self.displacement.x, self.displacement.y);
        let straight = Vector2::new(c * x + s * y, c * y - s * x);
        let off = self.displacement - straight;
        let moved = Vector3::new(before.x + off.x, before.y + off.y, before.z);
        let mut by = Matrix3::identity();
        (by[(0, 2)], by[(1, 2)]) = (-straight.y, straight.x);
        (moved * keep, by * keep)
    }

    /// The factor of the previous error; `trust` is the probability of the last recognised place.
    fn keep(&self, motion: &Preintegrated, trust: f64) -> f64 {
        match self.start {
            Some(_) => 0.0,
            // The error at a wrong place is constant and does not decay.
            None => 1.0 - trust * (1.0 - self.correlated(motion)),
        }
    }

    /// Correlation of the errors before and after a motion, 0 to 1.
    pub(crate) fn correlated(&self, motion: &Preintegrated) -> f64 {
        let (distance, turn) = self.correlation;
        (-motion.distance / distance - motion.turned / turn).exp()
    }

    /// Covariance of the new part of the error at a correct place.
    pub(crate) fn noise(&self, motion: &Preintegrated) -> Matrix3<f64> {
        match self.start {
            Some(ErrorStart::NewMap) => Matrix3::identity() * NEW_MAP_VARIANCE,
            Some(ErrorStart::Place(_)) => self.stationary,
            None => {
                let correlated = self.correlated(motion);
                self.stationary * (1.0 - correlated * correlated).max(MIN_STEP_RATIO)
            }
        }
    }

    /// Information of the new part of the error; at an uncertain place, the mean over correct and wrong.
    pub(crate) fn information(&self, motion: &Preintegrated) -> Option<Matrix3<f64>> {
        let right = self.noise(motion).try_inverse()?;
        let Some(ErrorStart::Place(switch)) = self.start else { return Some(right) };
        Some(right * switch.weight + wrong_place().try_inverse()? * (1.0 - switch.weight))
    }

    /// Covariance that belongs to [`ErrorStep::information`].
    pub(crate) fn covariance(&self, motion: &Preintegrated) -> Matrix3<f64> {
        self.information(motion).and_then(|information| information.try_inverse()).unwrap_or_else(wrong_place)
    }
}

/// Covariance of the error at a wrong place.
pub(crate) fn wrong_place() -> Matrix3<f64> {
    Matrix3::from_diagonal(&WRONG_PLACE_SIGMAS.component_mul(&WRONG_PLACE_SIGMAS))
}

impl PlaceSwitch {
    /// A switch before any comparison.
    pub(crate) fn new(wrong_probability: f64) -> Self {
        let prior_log_odds = ((1.0 - wrong_probability) / wrong_probability).ln();
        Self { weight: 1.0 - wrong_probability, prior_log_odds }
    }

    /// This switch with the posterior weight, by the error of the place from all other factors.
    #[must_use]
    pub(crate) fn judged(
        &self,
        error: &Vector3<f64>,
        covariance: &Matrix3<f64>,
        right: &Matrix3<f64>,
    ) -> Self {
        let ratio =
            log_density(error, &(covariance + right)) - log_density(error, &(covariance + wrong_place()));
        let log_odds = self.prior_log_odds + ratio;
        Self { weight: 1.0 / (1.0 + (-log_odds).exp()), ..*self }
    }
}

/// Logarithm of the density of a normal distribution with mean zero; minus infinity if the covariance is not positive.
pub(crate) fn log_density(value: &Vector3<f64>, covariance: &Matrix3<f64>) -> f64 {
    let Some(lower) = covariance.cholesky() else { return f64::NEG_INFINITY };
    let squared = value.dot(&lower.solve(value));
    let log_determinant = 2.0 * lower.l_dirty().diagonal().map(f64::ln).sum();
    -0.5 * (squared + log_determinant + 3.0 * std::f64::consts::TAU.ln())
}
