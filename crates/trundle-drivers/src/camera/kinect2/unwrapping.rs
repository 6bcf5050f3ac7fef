//! Distance from the wrapped phases of three frequencies.
//!
//! Each number of wraps of the highest frequency is a hypothesis of the distance. The hypothesis predicts the phases of the two other
//! frequencies. The hypothesis with the smallest weighted sum of squared differences is chosen. Weights are inverse variances; the variance
//! of a phase is that of the measurements over the squared amplitude. The distance is the weighted mean over the three frequencies. Source:
//! \[Lawin16\].

use super::layout::{FREQUENCY_COUNT, wrap_distance_m};
use super::phasors::Phasors;
use std::f32::consts::TAU;

/// The highest frequency, which makes the hypotheses. Source: the order of `MODULATION_HZ`.
const FINEST_INDEX: usize = 2;
/// The frequencies by which the hypotheses are scored. Source: the order of `MODULATION_HZ`.
const JUDGE_INDICES: [usize; 2] = [0, 1];
/// Largest difference of a predicted phase \[turn\]: 0.12. With a larger difference no hypothesis is accepted. Source: ours; hypotheses
/// differ by 0.33 turn at 80 MHz.
const MAX_PHASE_DIFFERENCE_TURN: f32 = 0.12;

/// Number whose sum with a smaller one is whole: 1.5 x 2^23. Source: IEEE 754, 23 bits of fraction.
const ROUNDING_SUMMAND: f32 = 12_582_912.0;
/// Coefficients of the arctangent, of x, x^3, ..., x^9. Source: \[Abramowitz64\], equation 4.4.47.
const ARCTAN_COEFFICIENTS: [f32; 5] = [0.999_866, -0.330_299_5, 0.180_141, -0.085_133, 0.020_835_1];

/// Unwraps pixels up to a largest distance.
#[derive(Debug, Clone)]
pub(super) struct Unwrapper {
    wrap_m: [f32; FREQUENCY_COUNT],
    hypotheses: usize,
    min_amplitude: f32,
}

impl Unwrapper {
    /// An unwrapper for distances up to `max_range_m`, for pixels with at least `min_amplitude` at each frequency.
    pub(super) fn new(max_range_m: f64, min_amplitude: f32) -> Self {
        let wrap_m = std::array::from_fn(|frequency| wrap_distance_m(frequency) as f32);
        let hypotheses = (max_range_m / wrap_distance_m(FINEST_INDEX)).ceil() as usize;
        Self { wrap_m, hypotheses, min_amplitude }
    }

    /// Distance along the ray of a pixel \[m\], and its mean amplitude; `None` if the light is too weak or the phases do not agree.
    pub(super) fn distance(&self, phasors: &Phasors) -> Option<(f32, f32)> {
        let [a_re, a_im, b_re, b_im, c_re, c_im] = *phasors;
        let parts = [[a_re, a_im], [b_re, b_im], [c_re, c_im]];
        let amplitude = parts.map(|[re, im]| (re * re + im * im).sqrt());
        if amplitude.iter().any(|amplitude| *amplitude < self.min_amplitude) {
            return None;
        }
        let phase = parts.map(|[re, im]| turn_of(im, re));
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
        let first = phase[FINEST_INDEX];
        let first = if first < 0.0 { first + 1.0 } else { first };
        let (mut best_cost, mut best_turns, mut best) = (f32::INFINITY, first, [f32::INFINITY; 2]);
        for wraps in 0..self.hypotheses {
            let turns = first + wraps as f32;
            let differences = [0, 1].map(|i| wrapped(phase[JUDGE_INDICES[i]] - turns * ratio[i]));
            let cost =
                weight[0] * differences[0] * differences[0] + weight[1] * differences[1] * differences[1];
            if cost < best_cost {
                (best_cost, best_turns, best) = (cost, turns, differences);
            }
        }
        let agrees = best.iter().all(|difference| difference.abs() < MAX_PHASE_DIFFERENCE_TURN);
        agrees.then_some(best_turns * finest_m)
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

/// A phase in turns brought to -0.5 to 0.5, for less than a million turns. A sum with a number of this size has no digits after the point,
/// which rounds without a call of a library.
fn wrapped(turns: f32) -> f32 {
    turns - ((turns + ROUNDING_SUMMAND) - ROUNDING_SUMMAND)
}

/// The angle of (x, y) in turns, -0.5 to 0.5. The error is below 2e-6 turn, 2.5 um at 120 MHz. Source: \[Abramowitz64\], equation 4.4.47,
/// for the eighth of a turn; symmetry for the rest.
fn turn_of(y: f32, x: f32) -> f32 {
    let (a, b) = (x.abs(), y.abs());
    let (low, high) = (a.min(b), a.max(b));
    let ratio = low / high.max(f32::MIN_POSITIVE);
    let squared = ratio * ratio;
    let angle = ARCTAN_COEFFICIENTS.iter().rev().fold(0.0, |sum, c| sum * squared + c) * ratio / TAU;
    let angle = if b > a { 0.25 - angle } else { angle };
    let angle = if x < 0.0 { 0.5 - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_is_that_of_atan2() {
        for step in 0..100_000 {
            let angle = step as f64 * 1e-3;
            let (y, x) = (3.0 * angle.sin(), 3.0 * angle.cos());
            let error = turn_of(y as f32, x as f32) as f64 - y.atan2(x) / std::f64::consts::TAU;
            assert!((error - error.round()).abs() < 2e-6, "{angle}: {error}");
        }
        assert_eq!(turn_of(0.0, 0.0), 0.0);
    }

    #[test]
    fn wrapping_is_the_distance_to_the_nearest_whole_number() {
        for step in -100_000..100_000 {
            let turns = step as f32 * 1.37e-3;
            assert!((wrapped(turns).abs() - (turns - turns.round()).abs()).abs() < 1e-6, "{turns}");
        }
    }
}
