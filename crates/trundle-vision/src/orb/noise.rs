//! Noise of an image.

use trundle_core::GrayImage;

/// Standard deviation of the mask's answer to noise of 1: 6. Source: \[Immerkaer96\].
const MASK_GAIN: f32 = 6.0;
/// The answers' quantile that is used: a quarter. The estimate holds as long as a quarter of the image has no texture. Source:
/// ours.
const QUANTILE_DIVISOR: usize = 4;
/// That quantile of the absolute values of a normal distribution, in standard deviations. Source: the 62.5th percentile of the normal
/// distribution.
const QUANTILE_SIGMAS: f32 = 0.3186;
/// Smallest standard deviation of an image's noise: 0.29 grey values, the rounding error of whole values. Source: the deviation of a
/// uniform distribution, 1 / sqrt(12).
const MIN_NOISE_SIGMA: f32 = 0.29;
/// Distance between the pixels that are used, in both directions: 2. Source: ours.
const STRIDE_PX: usize = 2;
/// Number of possible answers: 8 x 255 and 0. Source: the weights of the mask.
const ANSWER_COUNT: usize = 8 * 255 + 1;

/// Standard deviation of the image's noise, grey values, at least that of rounding: the difference of pixels from the prediction by their
/// neighbours, in areas of small differences. The difference is zero on a ramp and in the middle of a straight edge \[Immerkaer96\].
pub(crate) fn sigma(image: &GrayImage) -> f32 {
    let mut counts = [0_usize; ANSWER_COUNT];
    for y in (1..image.height().saturating_sub(1)).step_by(STRIDE_PX) {
        let rows = [y - 1, y, y + 1].map(|y| image.row(y));
        for x in (1..image.width().saturating_sub(1)).step_by(STRIDE_PX) {
            counts[usize::from(answer(rows.map(|row| [row[x - 1], row[x], row[x + 1]])))] += 1;
        }
    }
    (quarter(&counts) / (QUANTILE_SIGMAS * MASK_GAIN)).max(MIN_NOISE_SIGMA)
}

/// The absolute response of the mask 1 -2 1, -2 4 -2, 1 -2 1.
fn answer(rows: [[u8; 3]; 3]) -> u16 {
    let [above, here, below] =
        rows.map(|[left, middle, right]| i16::from(left) - 2 * i16::from(middle) + i16::from(right));
    (above - 2 * here + below).unsigned_abs()
}

/// The lower quartile of the responses; 0 without responses. Each whole number represents the interval that is rounded to it.
fn quarter(counts: &[usize; ANSWER_COUNT]) -> f32 {
    let wanted = counts.iter().sum::<usize>() as f32 / QUANTILE_DIVISOR as f32;
    let mut below = 0.0;
    for (answer, count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
        let (count, low) = (*count as f32, (answer as f32 - 0.5).max(0.0));
        if below + count >= wanted {
            return low + (answer as f32 + 0.5 - low) * (wanted - below) / count;
        }
        below += count;
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Half bare, half full of edges, with noise of a given amplitude, grey values.
    fn image(noise: f32) -> GrayImage {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mut normal = || (0..12).map(|_| rng.random_range(-0.5_f32..0.5)).sum::<f32>();
        GrayImage::from_fn(320, 240, |x, y| {
            let clean =
                if x < 160 { 90.0 + 0.2 * y as f32 } else { 60.0 + 90.0 * ((x / 5 + y / 7) % 2) as f32 };
            (clean + noise * normal()).round() as u8
        })
    }

    #[test]
    fn the_noise_is_that_of_the_half_without_texture() {
        for noise in [1.0, 2.0, 5.0] {
            let found = sigma(&image(noise));
            assert!((0.9..1.6).contains(&(found / noise)), "{found} for {noise}");
        }
    }

    #[test]
    fn a_clean_and_an_empty_image_have_the_noise_of_rounding() {
        assert_eq!(sigma(&image(0.0)), MIN_NOISE_SIGMA);
        for (width, height) in [(0, 0), (0, 9), (9, 0), (1, 1), (2, 9), (9, 2)] {
            assert_eq!(sigma(&GrayImage::filled(width, height, 7)), MIN_NOISE_SIGMA);
        }
    }
}
