//! One level of the image pyramid.

use super::{
    blur::Blur, brief, config::OrbConfig, corner::Corner, described_corner::DescribedCorner, distribute,
    fast, orientation, patch, resize::Resize, subpixel, texture,
};
use crate::ImagePatch;
use trundle_core::GrayImage;

/// A level of the pyramid, with the buffers of every step.
#[derive(Debug, Clone, Default)]
pub(crate) struct Level {
    image: GrayImage,
    blurred: GrayImage,
    resize: Resize,
    blur: Blur,
    detector: fast::Detector,
    corners: Vec<Corner>,
    chosen: Vec<Corner>,
    features: Vec<DescribedCorner>,
}

impl Level {
    pub fn width(&self) -> usize {
        self.image.width()
    }

    pub fn height(&self) -> usize {
        self.image.height()
    }

    /// The corners found, in the order of the distribution.
    pub fn features(&self) -> &[DescribedCorner] {
        &self.features
    }

    /// Becomes level 0 of `image`.
    pub fn load(&mut self, image: &GrayImage) {
        self.fit(image.width(), image.height());
        self.image.data_mut().copy_from_slice(image.data());
    }

    /// Becomes `finer_level` at another size.
    pub fn shrink(&mut self, finer_level: &Self, width: usize, height: usize) {
        self.fit(width, height);
        self.resize.run(&finer_level.image, &mut self.image);
    }

    fn fit(&mut self, width: usize, height: usize) {
        if (self.width(), self.height()) != (width, height) {
            self.image = GrayImage::filled(width, height, 0);
            self.blurred = self.image.clone();
        }
    }

    /// Finds the corners with enough distance from the border for a descriptor, and gradients of at least `min` grey values per px in
    /// every direction.
    pub fn detect(&mut self, config: &OrbConfig, min: f32) {
        self.corners.clear();
        if self.width().min(self.height()) > 2 * patch::BORDER_PX && self.width().max(self.height()) <= 65536
        {
            self.blur.run(&self.image, &mut self.blurred);
            let has_texture = |corner: Corner| texture::min_gradient(&self.blurred, corner) >= min;
            self.detector.detect(&self.image, config, has_texture, &mut self.corners);
        }
    }

    /// Selects `quota` of the corners, evenly distributed, or all if fewer exist. Returns the number of selected corners.
    pub fn choose(&mut self, quota: usize) -> usize {
        self.chosen.clear();
        distribute::choose(
            &mut self.corners,
            (self.image.width(), self.image.height()),
            quota,
            &mut self.chosen,
        );
        self.chosen.len()
    }

    /// Orients and describes the chosen corners.
    pub fn describe(&mut self) {
        self.features.clear();
        if self.chosen.is_empty() {
            return;
        }
        let blurred = &self.blurred;
        self.features.extend(self.chosen.iter().map(|&corner| {
            let patch = patch::around(blurred, corner);
            let direction = orientation::direction(&patch);
            let descriptor = brief::describe(&patch, direction);
            let (dx, dy) = subpixel::offset(self.detector.scores(), self.image.width(), corner);
            DescribedCorner {
                x: f32::from(corner.x) + dx,
                y: f32::from(corner.y) + dy,
                score: corner.score,
                angle: direction.angle,
                descriptor,
                patch: ImagePatch::cut(&self.image, (corner.x.into(), corner.y.into()), [dx, dy]),
            }
        }));
    }
}
