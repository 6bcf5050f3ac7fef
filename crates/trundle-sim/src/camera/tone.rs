//! Tone tables: from ideal sRGB levels to mean and standard deviation of the measured level.

use super::color_noise::ColorNoise;
use super::round::nearest;
use super::srgb::{linear_from_srgb, srgb};
use crate::rng::NormalTable;

/// From the level of a channel (sRGB) to mean and standard deviation of the measured level: a table an image.
#[derive(Debug, Clone)]
pub(super) struct Tone(Box<[(f32, f32); 256]>);

impl Tone {
    pub(super) fn new(noise: &ColorNoise, gain: f64) -> Self {
        Self(Box::new(std::array::from_fn(|level| {
            let light = f64::from(linear_from_srgb(level as u8));
            let sigma = noise.sigma(light, gain);
            let measured = light * gain;
            // The curve of sRGB carries noise over: half of what one sigma up and down make.
            let spread = (srgb(measured + sigma) - srgb(measured - sigma)) / 2.0;
            (srgb(measured) as f32, spread as f32)
        })))
    }

    /// Measured level of a colour; `bits` is the pixel's hash, of which depth takes the first deviate.
    #[inline]
    pub(super) fn measure(&self, color: [u8; 3], bits: u64, normals: &NormalTable) -> [u8; 3] {
        let channel = |i: usize| {
            let (mean, sigma) = self.0[usize::from(color[i])];
            let level = mean + sigma * normals.pick(bits, i as u32 + 1);
            let level = if level > 0.0 { level } else { 0.0 };
            nearest(if level < 255.0 { level } else { 255.0 }) as u8
        };
        [channel(0), channel(1), channel(2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Exposure;
    use crate::rng::hash;

    fn measured(noise: &ColorNoise, gain: f64, color: [u8; 3]) -> Vec<[f64; 3]> {
        let (tone, normals) = (Tone::new(noise, gain), NormalTable::shared());
        (0..20_000).map(|i| tone.measure(color, hash(3, i), normals).map(f64::from)).collect()
    }

    fn mean(values: impl Iterator<Item = f64>) -> f64 {
        values.sum::<f64>() / 20_000.0
    }

    #[test]
    fn without_noise_every_level_is_itself() {
        let tone = Tone::new(&ColorNoise::none(), 1.0);
        for level in 0..=255 {
            assert_eq!(tone.measure([level; 3], 12345, NormalTable::shared()), [level; 3]);
        }
    }

    #[test]
    fn spread_is_that_of_photons_and_reading_through_the_curve_and_channels_are_independent() {
        let noise = ColorNoise { exposure: Exposure::fixed(1.0), ..ColorNoise::default() };
        for level in [40, 128, 200] {
            let values = measured(&noise, 1.0, [level; 3]);
            let center = mean(values.iter().map(|v| v[1]));
            let variance = mean(values.iter().map(|v| (v[1] - center).powi(2)));
            let light = f64::from(linear_from_srgb(level));
            // d level / d light, and the variance of rounding.
            let slope = 255.0 * 1.055 / 2.4 * light.powf(1.0 / 2.4 - 1.0);
            let stated = (slope * noise.sigma(light, 1.0)).powi(2) + 1.0 / 12.0;
            assert!((center - f64::from(level)).abs() < 0.06, "mean {center} of {level}");
            assert!((variance / stated - 1.0).abs() < 0.05, "variance {variance} of {stated} at {level}");
            let covariance = mean(values.iter().map(|v| (v[0] - center) * (v[2] - center)));
            assert!(covariance.abs() < 0.03 * variance, "{covariance}");
        }
        assert!((measured(&noise, 1.0, [128; 3]).len() as f64 - 20_000.0).abs() < 1.0);
    }

    #[test]
    fn gain_brightens_and_clips() {
        let noise = ColorNoise::default();
        let dark = mean(measured(&noise, 4.0, [60; 3]).iter().map(|v| v[0]));
        let light = f64::from(linear_from_srgb(60));
        assert!((dark - srgb(4.0 * light)).abs() < 0.3, "{dark}");
        assert!(measured(&noise, 4.0, [220; 3]).iter().all(|v| v[0] == 255.0));
    }
}
