//! The pixels of a depth image in the numbers of its file.

use trundle_core::Image;

/// The pixels of a depth image in the numbers of its file.
pub(super) enum RawDepth {
    /// Depth in units of the camera.
    Units(Image<u16>),
    /// Depth in metres.
    Metres(Image<f32>),
}
