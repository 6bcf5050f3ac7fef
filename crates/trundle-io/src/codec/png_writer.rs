//! The PNG encoder that colour and depth images share.

use super::CodecError;
use png::{BitDepth, ColorType, Compression, Encoder, Filter};

/// Format of a PNG's pixels.
pub(super) struct PngFormat {
    pub(super) color: ColorType,
    pub(super) depth: BitDepth,
    pub(super) filter: Filter,
}

/// A PNG of `data`, row by row, samples above 8 bits high byte first; `kind` is for messages.
pub(super) fn encode_png(
    kind: &'static str,
    (width, height): (usize, usize),
    format: &PngFormat,
    data: &[u8],
) -> Result<Vec<u8>, CodecError> {
    let failed = |error: &dyn ToString| CodecError::encode(kind, error.to_string());
    let side = |n: usize| u32::try_from(n).map_err(|error| failed(&error));
    let mut bytes = Vec::with_capacity(data.len() / 2);
    let mut encoder = Encoder::new(&mut bytes, side(width)?, side(height)?);
    encoder.set_color(format.color);
    encoder.set_depth(format.depth);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(format.filter);
    let mut writer = encoder.write_header().map_err(|error| failed(&error))?;
    writer.write_image_data(data).map_err(|error| failed(&error))?;
    writer.finish().map_err(|error| failed(&error))?;
    Ok(bytes)
}
