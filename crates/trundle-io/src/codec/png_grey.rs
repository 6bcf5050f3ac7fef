//! Maps as 8-bit grey PNG.

use super::CodecError;
use super::png_writer::{PngFormat, encode_png};
use png::{BitDepth, ColorType, Filter};

/// An 8-bit grey PNG of the pixels, row by row from the top.
///
/// # Errors
/// When a side is 0 or above 2^31 px.
pub(crate) fn encode_grey8(size: (usize, usize), pixels: &[u8]) -> Result<Vec<u8>, CodecError> {
    let format = PngFormat { color: ColorType::Grayscale, depth: BitDepth::Eight, filter: Filter::Up };
    encode_png("map", size, &format, pixels)
}
