//! The noise model of the colour image: exposure, photon noise and read noise.

use super::exposure::Exposure;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Difference of a camera's colour from the ideal one: exposure, then photon noise and read noise \[Emva16\].
///
/// Light collects mu electrons in a pixel, with a variance sigma^2 = mu + read noise^2; a full well clips. A gain above 1 amplifies
/// electrons and noise equally; below 1 the exposure is shorter. The value is coded as sRGB, so noise in grey levels is largest in the
/// dark. Channels and pixels are independent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ColorNoise {
    /// Electrons at white, 0 to 1e6. Default 5000, what a small pixel holds; with the next it makes 1.9 grey levels of noise
    /// at mid grey. 0 turns noise off.
    pub full_well: f64,
    /// Standard deviation of reading, electrons, 0 to 1000. Default 8.
    pub read_noise: f64,
    /// Exposure.
    pub exposure: Exposure,
}

impl Default for ColorNoise {
    fn default() -> Self {
        Self { full_well: 5000.0, read_noise: 8.0, exposure: Exposure::default() }
    }
}

impl ColorNoise {
    /// No noise, and an exposure gain of 1.
    pub fn none() -> Self {
        Self { full_well: 0.0, read_noise: 0.0, exposure: Exposure::fixed(1.0) }
    }

    /// Passes valid noise through.
    ///
    /// # Errors
    /// When a number is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("color_noise.full_well", self.full_well, "electrons", 0.0, 1e6)?;
        require_in("color_noise.read_noise", self.read_noise, "electrons", 0.0, 1000.0)?;
        Ok(Self { exposure: self.exposure.validated()?, ..self })
    }

    /// The standard deviation of a channel in linear light for incoming `light` (both linear, white = 1).
    pub fn sigma(&self, light: f64, gain: f64) -> f64 {
        if self.full_well == 0.0 {
            return 0.0;
        }
        let (exposure, amplification) = (gain.min(1.0), gain.max(1.0));
        let electrons = (light * exposure).min(1.0) * self.full_well;
        amplification * (electrons + self.read_noise * self.read_noise).sqrt() / self.full_well
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_grows_with_light_and_gain_as_emva_1288_says() {
        let noise = ColorNoise::default();
        assert!((noise.sigma(0.0, 1.0) - 8.0 / 5000.0).abs() < 1e-12);
        assert!((noise.sigma(0.5, 1.0) - (2500.0_f64 + 64.0).sqrt() / 5000.0).abs() < 1e-12);
        assert_eq!(noise.sigma(3.0, 1.0), noise.sigma(1.0, 1.0), "a full well");
        assert!((noise.sigma(0.1, 4.0) / noise.sigma(0.1, 1.0) - 4.0).abs() < 1e-12);
        assert_eq!(ColorNoise::none().sigma(0.5, 8.0), 0.0);
        let error = ColorNoise { full_well: f64::NAN, ..noise }.validated().unwrap_err();
        assert_eq!(error.field, "color_noise.full_well");
    }
}
