//! ORB: corners of FAST on an image pyramid, oriented by the intensity centroid, described by rotated BRIEF \[Rublee11\].
//!
//! Idea: a cheap corner test finds the same points in every image. The centre of mass of their surroundings gives the roll of the camera.
//! 256 brightness comparisons rotated by that angle give a descriptor; the distance of two descriptors is the number of different bits.
//! Cost: linear in the pixels of the pyramid (3.3 images) plus about 1 us a feature.
//!
//! | paper | here | unit |
//! |---|---|---|
//! | n, N | `OrbConfig::features` | |
//! | t (FAST) | `OrbConfig::fast_threshold` | grey values |
//! | m_10, m_01 | `moments` | grey value px |
//! | theta = atan2(m_01, m_10) | `Keypoint::angle` | rad |
//! | S_theta = R_theta S | `PATTERN` turned in `describe` | px of the level |

mod blur;
mod brief;
mod config;
mod corner;
mod described_corner;
mod distribute;
mod fast;
mod level;
mod noise;
mod orientation;
mod patch;
mod resize;
mod subpixel;
mod texture;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
mod vector;

pub use config::OrbConfig;

use crate::{Features, Keypoint};
use level::Level;
use rayon::prelude::*;
use trundle_core::{GrayImage, Invalid};

/// Finds ORB features; keeps its pyramid and buffers from image to image.
#[derive(Debug, Clone)]
pub struct OrbExtractor {
    config: OrbConfig,
    scale_factors: Vec<f64>,
    quotas: Vec<usize>,
    levels: Vec<Level>,
}

impl OrbExtractor {
    /// An extractor with this configuration.
    ///
    /// # Errors
    /// When the configuration is not valid.
    pub fn new(config: OrbConfig) -> Result<Self, Invalid> {
        let config = config.validated()?;
        let levels = vec![Level::default(); config.levels];
        Ok(Self { scale_factors: config.scale_factors(), quotas: config.quotas(), levels, config })
    }

    /// Settings of the extractor.
    pub fn config(&self) -> &OrbConfig {
        &self.config
    }

    /// The size of a pixel of each octave, px of the full image: 1, s, s^2, ...
    pub fn scale_factors(&self) -> &[f64] {
        &self.scale_factors
    }

    /// The features of `image`, octave by octave, at most [`OrbConfig::features`]; keypoints in px of `image`, to a fraction of a pixel. A
    /// pixel within 16 px (of its own level) of the border has no feature, because its patch would be incomplete. An image with a side
    /// below 33 px has no feature.
    pub fn extract(&mut self, image: &GrayImage) -> Features {
        let mut features = Features::default();
        self.extract_into(image, &mut features);
        features
    }

    /// [`OrbExtractor::extract`] into a buffer, whose content is replaced.
    pub fn extract_into(&mut self, image: &GrayImage, features: &mut Features) {
        self.build_pyramid(image);
        let config = &self.config;
        let min = config.min_texture as f32 * noise::sigma(image);
        self.levels.par_iter_mut().for_each(|level| level.detect(config, min));
        self.choose();
        self.levels.par_iter_mut().for_each(Level::describe);
        self.collect(image, features);
    }

    /// Computes each level from the one below.
    fn build_pyramid(&mut self, image: &GrayImage) {
        for (index, scale) in self.scale_factors.iter().enumerate() {
            let size = |side: usize| (side as f64 / scale).round() as usize;
            let (below, rest) = self.levels.split_at_mut(index);
            match below.last() {
                None => rest[0].load(image),
                Some(finer_level) => rest[0].shrink(finer_level, size(image.width()), size(image.height())),
            }
        }
    }

    /// Selects each level's share of its corners; later levels fill a shortage.
    fn choose(&mut self) {
        let mut owed = 0;
        for (level, quota) in self.levels.iter_mut().zip(&self.quotas) {
            owed += quota;
            owed -= level.choose(owed);
        }
    }

    fn collect(&self, image: &GrayImage, features: &mut Features) {
        features.keypoints.clear();
        features.descriptors.clear();
        features.patches.clear();
        features.patches.reserve(self.levels.iter().map(|level| level.features().len()).sum());
        for (octave, level) in self.levels.iter().enumerate() {
            // Pixel centres are whole numbers on every level, so the corners of the images coincide at -0.5.
            let across = image.width() as f32 / level.width().max(1) as f32;
            let down = image.height() as f32 / level.height().max(1) as f32;
            for described in level.features() {
                features.keypoints.push(Keypoint {
                    x: (described.x + 0.5) * across - 0.5,
                    y: (described.y + 0.5) * down - 0.5,
                    octave: octave as u8,
                    angle: described.angle,
                    response: f32::from(described.score),
                });
                features.descriptors.push(described.descriptor);
                features.patches.push(described.patch);
            }
        }
    }
}
