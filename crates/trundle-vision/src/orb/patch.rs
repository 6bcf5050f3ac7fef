use super::fast::Corner;
use trundle_core::GrayImage;

/// Radius of the disc that orients and describes a corner, px \[Rublee11\].
pub(crate) const RADIUS: usize = 15;
/// Nearest that a described corner comes to the border, px.
pub(crate) const BORDER: usize = 16;
/// Columns of a [`Patch`]; the last one is not used. A power of two, so that indices need no check.
pub(crate) const STRIDE: usize = 32;
/// The square around a corner, which is at ([`RADIUS`], [`RADIUS`]); the last row is zero.
pub(crate) type Patch = [u8; STRIDE * STRIDE];

/// The surroundings of a corner that is at least [`BORDER`] px from the border.
pub(crate) fn around(image: &GrayImage, corner: Corner) -> Patch {
    let (left, top) = (usize::from(corner.x) - RADIUS, usize::from(corner.y) - RADIUS);
    let mut patch = [0; STRIDE * STRIDE];
    for (y, to) in patch.chunks_exact_mut(STRIDE).take(2 * RADIUS + 1).enumerate() {
        to.copy_from_slice(&image.row(top + y)[left..left + STRIDE]);
    }
    patch
}
