use crate::chance::NormalTable;
use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// How a camera's colour differs from the ideal one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ColorNoise {
    /// Standard deviation of each channel, grey levels, 0 to 64. Default 1.8: what a small sensor has indoors.
    pub sigma: f64,
}

impl Default for ColorNoise {
    fn default() -> Self {
        Self { sigma: 1.8 }
    }
}

impl ColorNoise {
    /// No noise.
    pub fn none() -> Self {
        Self { sigma: 0.0 }
    }

    /// Passes valid noise through.
    ///
    /// # Errors
    /// When the spread is outside its range.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("color_noise.sigma", self.sigma, "grey levels", 0.0, 64.0)?;
        Ok(self)
    }

    /// What the camera says for a colour; `bits` is the pixel's hash, of which depth takes the first deviate.
    pub(super) fn measure(&self, color: [u8; 3], bits: u64, normals: &NormalTable) -> [u8; 3] {
        let sigma = self.sigma as f32;
        let channel = |i: usize| (f32::from(color[i]) + sigma * normals.pick(bits, i as u32 + 1) + 0.5) as u8;
        [channel(0), channel(1), channel(2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::hash;

    #[test]
    fn spread_is_as_configured_and_channels_are_independent() {
        let (noise, normals) = (ColorNoise { sigma: 2.0 }, NormalTable::shared());
        let n = 20_000;
        let deviations: Vec<[f64; 3]> = (0..n)
            .map(|i| noise.measure([100; 3], hash(3, i), normals).map(|c| f64::from(c) - 100.0))
            .collect();
        let mean_of = |f: &dyn Fn(&[f64; 3]) -> f64| deviations.iter().map(f).sum::<f64>() / n as f64;
        assert!(mean_of(&|d| d[0]).abs() < 0.05);
        assert!((mean_of(&|d| d[1] * d[1]).sqrt() - 2.02).abs() < 0.05);
        assert!(mean_of(&|d| d[0] * d[2]).abs() < 0.1);
        assert_eq!(ColorNoise::none().measure([0, 128, 255], 12345, normals), [0, 128, 255]);
    }
}
