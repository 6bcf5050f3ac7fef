//! Colour and depth in the form of the camera.

use super::PixelFormat;
use trundle_core::Stamp;

/// A pair of images as delivered.
#[derive(Debug, Clone, PartialEq)]
pub struct CameraFrame {
    /// The colour image.
    pub color: RawImage,
    /// The depth image.
    pub depth: RawImage,
}

/// An image as delivered.
#[derive(Debug, Clone, PartialEq)]
pub struct RawImage {
    /// Form of the pixels.
    pub format: PixelFormat,
    /// Columns \[px\].
    pub width: usize,
    /// Rows \[px\].
    pub height: usize,
    /// Bytes from the start of a row to the start of the next; 0 if rows follow each other without padding.
    pub stride: usize,
    /// The bytes.
    pub bytes: Vec<u8>,
    /// Time of the image on the camera's own clock.
    pub device_stamp: Stamp,
}

impl RawImage {
    /// An image without padding at the end of its rows.
    pub fn packed(
        format: PixelFormat,
        (width, height): (usize, usize),
        bytes: Vec<u8>,
        device_stamp: Stamp,
    ) -> Self {
        Self { format, width, height, stride: 0, bytes, device_stamp }
    }
}
