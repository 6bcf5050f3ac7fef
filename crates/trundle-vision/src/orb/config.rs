//! Settings of the ORB extractor.

use serde::{Deserialize, Serialize};
use trundle_core::{Invalid, require_in};

/// Settings of [`OrbExtractor`](crate::OrbExtractor).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct OrbConfig {
    /// Maximum number of features per image, 1 to 100000. More track better and take longer. Default 1000 \[MurArtal17\].
    pub features: usize,
    /// Number of levels of the image pyramid, 1 to 32. More levels match over larger changes of distance. Default 8 \[Rublee11\].
    pub levels: usize,
    /// Ratio of the sizes of neighbouring levels, above 1, at most 2. Default 1.2 \[Rublee11\].
    pub scale_factor: f64,
    /// Smallest difference between a corner and nine adjacent pixels of its circle, grey values, 1 to 254. A smaller threshold finds weaker
    /// corners. Default 20 \[Rublee11\].
    pub fast_threshold: u8,
    /// Threshold in cells without a corner at `fast_threshold`, grey values, 1 to `fast_threshold`. Default 7 \[MurArtal17\].
    pub fast_min_threshold: u8,
    /// Side of the cells for the lower threshold, px of the level, 8 to 65535. Default 32: about the size of a descriptor's patch.
    pub cell_px: usize,
    /// Smallest root mean square gradient around a corner (15 x 15 px of its level) in any direction, in standard deviations of the image's
    /// noise per px, 0 to 100. With 0, corners of noise and points along edges are accepted. Default 0.5 (ours, swept on simulated drives).
    pub min_texture: f64,
}

impl Default for OrbConfig {
    fn default() -> Self {
        Self {
            features: 1000,
            levels: 8,
            scale_factor: 1.2,
            fast_threshold: 20,
            fast_min_threshold: 7,
            cell_px: 32,
            min_texture: 0.5,
        }
    }
}

impl OrbConfig {
    /// Distance from the border without features, px of the octave: descriptors need the surroundings.
    pub const MARGIN: usize = super::patch::BORDER_PX;

    /// Returns a valid configuration unchanged.
    ///
    /// # Errors
    /// When a number is outside the range in its field's documentation.
    pub fn validated(self) -> Result<Self, Invalid> {
        require_in("orb.features", self.features as f64, "", 1.0, 100_000.0)?;
        require_in("orb.levels", self.levels as f64, "", 1.0, 32.0)?;
        if !(self.scale_factor > 1.0 && self.scale_factor <= 2.0) {
            return Err(Invalid::new("orb.scale_factor", self.scale_factor, "", "above 1, at most 2"));
        }
        let threshold = f64::from(self.fast_threshold);
        require_in("orb.fast_threshold", threshold, "grey values", 1.0, 254.0)?;
        let low = f64::from(self.fast_min_threshold);
        require_in("orb.fast_min_threshold", low, "grey values", 1.0, threshold)?;
        require_in("orb.cell_px", self.cell_px as f64, "px", 8.0, 65535.0)?;
        require_in("orb.min_texture", self.min_texture, "sigmas a px", 0.0, 100.0)?;
        Ok(self)
    }

    /// The size of a pixel of each level, px of the full image: 1, s, s^2, ... A keypoint's standard deviation grows so.
    pub fn scale_factors(&self) -> Vec<f64> {
        (0..self.levels).map(|level| self.scale_factor.powi(level as i32)).collect()
    }

    /// Number of features of each level: the numbers fall by the scale factor and add up to `features`.
    pub(crate) fn quotas(&self) -> Vec<usize> {
        let share: Vec<f64> = self.scale_factors().iter().map(|scale| 1.0 / scale).collect();
        let unit = self.features as f64 / share.iter().sum::<f64>();
        let up_to = |level: usize| (unit * share[..level].iter().sum::<f64>()).round() as usize;
        (0..self.levels).map(|level| up_to(level + 1) - up_to(level)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quotas_add_up_and_fall() {
        for features in [1, 7, 1000, 1001] {
            let quotas = OrbConfig { features, ..Default::default() }.quotas();
            assert_eq!(quotas.iter().sum::<usize>(), features);
        }
        assert!(OrbConfig::default().quotas().is_sorted_by(|a, b| a > b));
    }

    #[test]
    fn broken_configurations_are_refused_by_name() {
        let refused = |config: OrbConfig| config.validated().unwrap_err().field;
        let good = OrbConfig::default;
        assert_eq!(refused(OrbConfig { features: 0, ..good() }), "orb.features");
        assert_eq!(refused(OrbConfig { levels: 33, ..good() }), "orb.levels");
        assert_eq!(refused(OrbConfig { scale_factor: f64::NAN, ..good() }), "orb.scale_factor");
        assert_eq!(refused(OrbConfig { scale_factor: 1.0, ..good() }), "orb.scale_factor");
        assert_eq!(refused(OrbConfig { fast_threshold: 0, ..good() }), "orb.fast_threshold");
        assert_eq!(refused(OrbConfig { fast_min_threshold: 21, ..good() }), "orb.fast_min_threshold");
        assert_eq!(refused(OrbConfig { cell_px: 2, ..good() }), "orb.cell_px");
        assert_eq!(refused(OrbConfig { min_texture: -0.1, ..good() }), "orb.min_texture");
        assert!(good().validated().is_ok());
    }
}
