//! The smoothed image around a corner.

use super::corner::Corner;
use trundle_core::GrayImage;

/// Radius of the disc that orients and describes a corner: 15 px. Source: \[Rublee11\].
pub(crate) const DISC_RADIUS_PX: usize = 15;
/// Smallest distance of a described corner to the border of its level: 16 px. Source: ours.
pub(crate) const BORDER_PX: usize = 16;
/// Columns of a [`Patch`]: 32; the last one is unused. A power of two needs no check of indices.
pub(crate) const PATCH_STRIDE: usize = 32;
/// The square around a corner, which is at ([`DISC_RADIUS_PX`], [`DISC_RADIUS_PX`]); the last row is zero.
pub(crate) type Patch = [u8; PATCH_STRIDE * PATCH_STRIDE];

/// The surroundings of a corner that is at least [`BORDER_PX`] px from the border.
pub(crate) fn around(image: &GrayImage, corner: Corner) -> Patch {
    let (left, top) = (usize::from(corner.x) - DISC_RADIUS_PX, usize::from(corner.y) - DISC_RADIUS_PX);
    let mut patch = [0; PATCH_STRIDE * PATCH_STRIDE];
    for (y, to) in patch.chunks_exact_mut(PATCH_STRIDE).take(2 * DISC_RADIUS_PX + 1).enumerate() {
        to.copy_from_slice(&image.row(top + y)[left..left + PATCH_STRIDE]);
    }
    patch
}
