//! Colour images from JPEG and PNG.

use super::claim::{MAX_SIDE, check_size};
use super::error::CodecError;
use crate::FileKind;
use image::{ImageFormat, ImageReader, Limits};
use std::io::Cursor;
use trundle_core::ColorImage;

/// Bits of a pixel of a colour image. Source: three channels of 8 bits.
const COLOR_BITS_PER_PIXEL: usize = 24;

/// A colour image from the bytes of a JPEG or PNG; grey images become grey colours, alpha is dropped.
///
/// # Errors
/// When the bytes are neither format, are truncated, claim too many pixels for their number, or contain an image above 16,384 px per side
/// or 67 Mpx.
pub fn decode_color(bytes: &[u8]) -> Result<ColorImage, CodecError> {
    let failed = |problem: &str| CodecError::decode("colour", problem);
    let format = image::guess_format(bytes).map_err(|_| failed("neither JPEG nor PNG"))?;
    match format {
        ImageFormat::Jpeg if !jpeg_is_whole(bytes) => return Err(failed("the JPEG is truncated")),
        ImageFormat::Jpeg | ImageFormat::Png => {}
        _ => {
            let found = FileKind::of_bytes(bytes, bytes.len() as u64);
            return Err(failed(&format!("this is {found}, expected JPEG or PNG; save it as PNG")));
        }
    }
    let size = ImageReader::with_format(Cursor::new(bytes), format).into_dimensions();
    let (width, height) = size.map_err(|error| CodecError::decode("colour", error))?;
    check_size("colour", (width as usize, height as usize), COLOR_BITS_PER_PIXEL, bytes.len())?;
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    reader.limits(limits);
    let image = reader.decode().map_err(|error| CodecError::decode("colour", error))?.into_rgb8();
    let (width, height) = (image.width() as usize, image.height() as usize);
    let pixels = image.into_raw().chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    Ok(ColorImage::new(width, height, pixels)?)
}

/// Whether the end marker exists: the decoder silently fills the missing part of a truncated JPEG with grey.
fn jpeg_is_whole(bytes: &[u8]) -> bool {
    let padding = bytes.iter().rev().take_while(|&&byte| byte == 0 || byte == b'\n').count();
    bytes[..bytes.len() - padding].ends_with(&[0xff, 0xd9])
}
