//! Encoding of one RGB-D image as the two image files of a TUM folder.

use crate::codec::encode_grey16;
use crate::{CodecError, TUM_DEPTH_SCALE, encode_color_png};
use trundle_core::{RgbdImage, Stamp};

/// An RGB-D image as the two files of a TUM folder. Encoding is most of the work and needs no folder, so several images may be encoded in
/// parallel.
#[derive(Debug, Clone, PartialEq)]
pub struct TumFrame {
    /// Stamp of the image.
    pub stamp: Stamp,
    /// Columns and rows, px.
    pub size: (usize, usize),
    /// The bytes of an 8-bit RGB PNG, without loss.
    pub color_png: Vec<u8>,
    /// The bytes of a 16-bit grey PNG in units of 1 / [`TUM_DEPTH_SCALE`] m (0.2 mm), 0 = none.
    pub depth_png: Vec<u8>,
}

impl TumFrame {
    /// Encodes an image; a depth above 13.107 m, the limit of 16 bits, becomes 0.
    ///
    /// # Errors
    /// When a side is 0 or above 2^31 px.
    pub fn encode(image: &RgbdImage) -> Result<Self, CodecError> {
        Ok(Self {
            stamp: image.stamp(),
            size: (image.color().width(), image.color().height()),
            color_png: encode_color_png(image.color())?,
            depth_png: encode_grey16(image.depth(), tum_units)?,
        })
    }
}

/// The nearest whole number of fifths of a millimetre; 0 (no reading) if the value is no depth or does not fit.
fn tum_units(metres: f32) -> u16 {
    let rounded = (f64::from(metres) * TUM_DEPTH_SCALE).round();
    if rounded > 0.0 && rounded <= f64::from(u16::MAX) { rounded as u16 } else { 0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_are_fifths_of_a_millimetre() {
        for (metres, units) in [(1.0, 5000), (0.5001, 2501), (13.107, 65_535), (13.108, 0), (0.0, 0)] {
            assert_eq!(tum_units(metres), units, "{metres} m");
        }
        assert_eq!([f32::NAN, f32::INFINITY, -1.0].map(tum_units), [0; 3]);
    }
}
