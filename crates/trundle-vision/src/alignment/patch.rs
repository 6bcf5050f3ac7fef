//! The image around a feature.

use trundle_core::GrayImage;

/// Number of pixels from the middle of a patch to its border: 10. Source: ours.
pub(super) const PATCH_RADIUS_PX: usize = 10;
/// Side of a patch, px.
pub(super) const PATCH_SIDE_PX: usize = 2 * PATCH_RADIUS_PX + 1;

/// Image patch around a feature: 21 x 21 px of the feature's level of the pyramid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImagePatch {
    pixels: [u8; PATCH_SIDE_PX * PATCH_SIDE_PX],
    /// Position of the feature, px right and down of the middle pixel.
    feature: [f32; 2],
}

impl ImagePatch {
    /// Bytes of a patch.
    pub const BYTES: usize = PATCH_SIDE_PX * PATCH_SIDE_PX;

    /// A patch of these pixels, row by row. `feature` is the offset of the feature to the right and down from the middle pixel, px. `None`
    /// if the offset exceeds half a pixel.
    pub fn new(pixels: [u8; Self::BYTES], feature: [f32; 2]) -> Option<Self> {
        feature.iter().all(|v| v.abs() <= 0.5).then_some(Self { pixels, feature })
    }

    /// Cut from an `image` around pixel (`x`, `y`), which is 10 px or more from its border.
    pub(crate) fn cut(image: &GrayImage, (x, y): (usize, usize), feature: [f32; 2]) -> Self {
        let mut pixels = [0; Self::BYTES];
        for (row, to) in pixels.as_chunks_mut::<PATCH_SIDE_PX>().0.iter_mut().enumerate() {
            to.copy_from_slice(&image.row(y + row - PATCH_RADIUS_PX)[x - PATCH_RADIUS_PX..][..PATCH_SIDE_PX]);
        }
        Self { pixels, feature }
    }

    /// The pixels, row by row.
    pub fn pixels(&self) -> &[u8; Self::BYTES] {
        &self.pixels
    }

    /// Position of the feature, px right and down of the middle pixel.
    pub fn feature(&self) -> [f32; 2] {
        self.feature
    }

    /// The grey value at (`x`, `y`) px from the first pixel, between the four around it; `None` outside.
    pub(super) fn at(&self, x: f32, y: f32) -> Option<f32> {
        let last = (PATCH_SIDE_PX - 1) as f32;
        if !(x >= 0.0 && y >= 0.0 && x < last && y < last) {
            return None;
        }
        let (left, top) = (x as usize, y as usize);
        let (right, down) = (x - left as f32, y - top as f32);
        let value = |i: usize| f32::from(self.pixels[i]);
        let first = top * PATCH_SIDE_PX + left;
        let above = value(first) + right * (value(first + 1) - value(first));
        let below = value(first + PATCH_SIDE_PX)
            + right * (value(first + PATCH_SIDE_PX + 1) - value(first + PATCH_SIDE_PX));
        Some(above + down * (below - above))
    }

    /// For each of `N` x `N` px from pixel (`left`, `top`) on: the weighted sum of the pixel and its three right and lower neighbours, row
    /// by row.
    #[inline(always)]
    pub(super) fn blend<const N: usize>(
        &self,
        (left, top): (usize, usize),
        weights: [f32; 4],
        to: &mut [f32],
    ) {
        for (y, to) in to.as_chunks_mut::<N>().0.iter_mut().take(N).enumerate() {
            let first = (top + y) * PATCH_SIDE_PX + left;
            let (above, below) = (&self.pixels[first..][..=N], &self.pixels[first + PATCH_SIDE_PX..][..=N]);
            for (x, to) in to.iter_mut().enumerate() {
                *to = weights[0] * f32::from(above[x])
                    + weights[1] * f32::from(above[x + 1])
                    + (weights[2] * f32::from(below[x]) + weights[3] * f32::from(below[x + 1]));
            }
        }
    }
}
