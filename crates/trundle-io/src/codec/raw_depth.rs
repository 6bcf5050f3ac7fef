//! The pixels of a depth image as its file holds them.

use trundle_core::Image;

/// The pixels of a depth image as its file holds them.
pub(super) enum RawDepth {
    /// In units of the camera.
    Units(Image<u16>),
    /// In metres.
    Metres(Image<f32>),
}
