//! Distance from the wrapped phases of three frequencies.
//!
//! Each number of wraps of the highest frequency is a hypothesis of the distance. It predicts the phases of the two other frequencies; the
//! hypothesis with the smallest weighted squares of the differences wins. Weights are inverse variances, and the variance of a phase is that
//! of the measurements over the squared amplitude. The distance is the weighted mean over the three frequencies. Source: Lawin et al. 2016,
//! sections 2 and 3.1.

use super::layout::{FREQUENCY_COUNT, wrap_distance_m};
use super::phasors::Phasors;
use std::f32::consts::TAU;

/// The highest frequency, which makes the hypotheses.
const FINEST_INDEX: usize = 2;
/// The frequencies that judge the hypotheses.
const JUDGE_INDICES: [usize; 2] = [0, 1];
/// Largest difference of a predicted phase \[turn\]: 0.12. Beyond it no hypothesis is right. Source: ours; hypotheses differ by 0.33 turn at
/// 80 MHz.
const MAX_PHASE_DIFFERENCE_TURN: f32 = 0.12;

/// Unwraps pixels up to a largest distance.
#[derive(Debug, Clone)]
pub(super) struct Unwrapper {
    wrap_m: [f32; FREQUENCY_COUNT],
    hypotheses: usize,
    min_amplitude: f32,
}

impl Unwrapper {
    /// Of distances up to `max_range_m`, of pixels with at least `min_amplitude` at each frequency.
    pub(super) fn new(max_range_m: f64, min_amplitude: f32) -> Self {
        let wrap_m = std::array::from_fn(|frequency| wrap_distance_m(frequency) as f32);
        let hypotheses = (max_range_m / wrap_distance_m(FINEST_INDEX)).ceil() as usize;
        Self { wrap_m, hypotheses, min_amplitude }
    }

    /// Distance along the ray of a pixel \[m\], and its mean amplitude; `None` where the light is too weak or the phases do not agree.
    pub(super) fn distance(&self, phasors: &Phasors) -> Option<(f32, f32)> {
        let amplitude = phasors.map(|[re, im]| (re * re + im * im).sqrt());
        if amplitude.iter().any(|amplitude| *amplitude < self.min_amplitude) {
            return None;
        }
        let phase = phasors.map(|[re, im]| im.atan2(re) / TAU);
        let distance = self.choose(&phase, &amplitude)?;
        let mean = self.mean(distance, &phase, &amplitude);
        Some((mean, amplitude.iter().sum::<f32>() / FREQUENCY_COUNT as f32))
    }

    /// The distance of the best hypothesis.
    fn choose(&self, phase: &[f32; 3], amplitude: &[f32; 3]) -> Option<f32> {
        let finest_m = self.wrap_m[FINEST_INDEX];
        let ratio = JUDGE_INDICES.map(|judge| finest_m / self.wrap_m[judge]);
        let variance = |amplitude: f32| 1.0 / (amplitude * amplitude);
        let weight: [f32; 2] = std::array::from_fn(|i| {
            let of_finest = ratio[i] * ratio[i] * variance(amplitude[FINEST_INDEX]);
            1.0 / (variance(amplitude[JUDGE_INDICES[i]]) + of_finest)
        });
        let first = phase[FINEST_INDEX].rem_euclid(1.0);
        let judge = |wraps: usize| {
            let turns = first + wraps as f32;
            let differences: [f32; 2] =
                std::array::from_fn(|i| wrapped(phase[JUDGE_INDICES[i]] - turns * ratio[i]));
            let cost: f32 = (0..2).map(|i| weight[i] * differences[i] * differences[i]).sum();
            (turns, differences, cost)
        };
        let best = (0..self.hypotheses).map(judge).min_by(|a, b| a.2.total_cmp(&b.2))?;
        let agrees = best.1.iter().all(|difference| difference.abs() < MAX_PHASE_DIFFERENCE_TURN);
        agrees.then_some(best.0 * finest_m)
    }

    /// The mean of the distances of all frequencies near `distance`, by their inverse variances.
    fn mean(&self, distance: f32, phase: &[f32; 3], amplitude: &[f32; 3]) -> f32 {
        let (mut sum, mut total) = (0.0, 0.0);
        for i in 0..FREQUENCY_COUNT {
            let correction_m = wrapped(phase[i] - distance / self.wrap_m[i]) * self.wrap_m[i];
            let weight = (amplitude[i] / self.wrap_m[i]).powi(2);
            sum += weight * correction_m;
            total += weight;
        }
        distance + sum / total
    }
}

/// A phase in turns brought to -0.5 to 0.5.
fn wrapped(turns: f32) -> f32 {
    turns - turns.round()
}
