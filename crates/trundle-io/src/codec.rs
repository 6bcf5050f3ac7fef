//! Encoding and decoding of colour and depth images: JPEG and PNG.

mod claim;
mod depth_file;
mod event;
mod exr_depth;
mod png_color;
mod png_depth;
mod png_grey;
mod png_writer;
mod raw_depth;
mod tiff_depth;

pub(crate) use claim::can_hold;
pub(crate) use depth_file::{decode_depth_file, is_depth_image};
pub use event::{EncodedEvent, EncodedRgbd};
pub use png_color::encode_color_png;
pub(crate) use png_depth::encode_grey16;
pub use png_depth::{decode_depth, decode_raw_depth, encode_depth};
pub(crate) use png_grey::encode_grey8;

use crate::FileKind;
use image::{ImageFormat, ImageReader, Limits};
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};
use std::io::Cursor;
use thiserror::Error;
use trundle_core::{ColorImage, Invalid};

/// JPEG quality of recorded colour images, 1 to 100: 90 leaves corners where they are at a tenth of the raw size.
pub const JPEG_QUALITY: u8 = 90;

/// Longest side of an image that is read, px: bounds what a broken header can ask for.
const MAX_SIDE: u32 = 16_384;
/// Most pixels of an image that is read.
const MAX_PIXELS: usize = 1 << 26;

/// Why an image cannot be decoded or encoded.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum CodecError {
    /// The bytes are not an image, or not a whole one.
    #[error("{kind} image cannot be decoded: {problem}")]
    Decode {
        /// `colour` or `depth`.
        kind: &'static str,
        /// The decoder's message.
        problem: String,
    },
    /// The image cannot be encoded.
    #[error("{kind} image cannot be encoded: {problem}")]
    Encode {
        /// `colour` or `depth`.
        kind: &'static str,
        /// The encoder's message.
        problem: String,
    },
    /// A depth image in another pixel format.
    #[error(
        "depth image has {found} pixels, expected 16-bit grey ones (PNG, TIFF, PGM) or 32-bit floats in metres (TIFF, OpenEXR){}",
        coarse(found)
    )]
    DepthFormat {
        /// For example `8-bit RGB`.
        found: String,
    },
    /// A kind of event that recordings do not hold.
    #[error("the event of {:.3} s is of a kind that recordings do not hold", stamp.as_secs())]
    UnknownEvent {
        /// Stamp of the event.
        stamp: trundle_core::Stamp,
    },
    /// Colour and depth do not fit together, or a size is not accepted.
    #[error(transparent)]
    Invalid(#[from] Invalid),
}

/// Why a format of few bits is refused.
fn coarse(found: &str) -> &'static str {
    if found.starts_with("8-bit ") { ": 8 bits are too coarse for a depth" } else { "" }
}

impl CodecError {
    pub(crate) fn decode(kind: &'static str, problem: impl ToString) -> Self {
        Self::Decode { kind, problem: problem.to_string() }
    }

    pub(crate) fn encode(kind: &'static str, problem: impl ToString) -> Self {
        Self::Encode { kind, problem: problem.to_string() }
    }
}

/// A colour image as JPEG of a quality from 1 to 100, chroma halved across (4:2:2): features live on luminance.
///
/// # Errors
/// When a side is 0 or above 65,535 px.
pub fn encode_color(image: &ColorImage, quality: u8) -> Result<Vec<u8>, CodecError> {
    let side =
        |n: usize| u16::try_from(n).map_err(|_| CodecError::encode("colour", format!("{n} px wide or high")));
    let (width, height) = (side(image.width())?, side(image.height())?);
    let mut bytes = Vec::with_capacity(image.data().len());
    let mut encoder = Encoder::new(&mut bytes, quality.clamp(1, 100));
    encoder.set_sampling_factor(SamplingFactor::R_4_2_2);
    encoder
        .encode(image.data().as_flattened(), width, height, ColorType::Rgb)
        .map_err(|error| CodecError::encode("colour", error))?;
    Ok(bytes)
}

/// Bits of a pixel of a colour image. Source: three channels of 8 bits.
const COLOR_BITS_PER_PIXEL: usize = 24;

/// A colour image from the bytes of a JPEG or PNG; grey ones become grey colours, alpha is dropped.
///
/// # Errors
/// When the bytes are neither, end too early, claim more pixels than they can hold, or hold an image above 16,384 px a side or 67 Mpx.
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
    claim::check_size("colour", (width as usize, height as usize), COLOR_BITS_PER_PIXEL, bytes.len())?;
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

/// Whether the end marker is there: the decoder fills the missing part of a truncated JPEG with grey, silently.
fn jpeg_is_whole(bytes: &[u8]) -> bool {
    let padding = bytes.iter().rev().take_while(|&&byte| byte == 0 || byte == b'\n').count();
    bytes[..bytes.len() - padding].ends_with(&[0xff, 0xd9])
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use proptest::prelude::*;

    pub(crate) fn test_image(width: usize, height: usize) -> ColorImage {
        let wave =
            |x: usize, y: usize| (((x as f64 / 9.0).sin() + (y as f64 / 7.0).cos()) * 60.0 + 128.0) as u8;
        ColorImage::from_fn(width, height, |x, y| [wave(x, y), (x / 3) as u8, (y / 2) as u8])
    }

    #[test]
    fn a_jpeg_comes_back_nearly_the_same() {
        let image = test_image(97, 61);
        let back = decode_color(&encode_color(&image, JPEG_QUALITY).unwrap()).unwrap();
        assert!(back.same_size(&image));
        let luma = |i: &ColorImage| trundle_core::gray_from_color(i);
        let (a, b) = (luma(&image), luma(&back));
        let worst = a.data().iter().zip(b.data()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst < Some(16), "{worst:?}");
    }

    #[test]
    fn a_png_comes_back_the_same() {
        let image = test_image(40, 30);
        let mut bytes = Cursor::new(Vec::new());
        image::write_buffer_with_format(
            &mut bytes,
            image.data().as_flattened(),
            40,
            30,
            image::ColorType::Rgb8,
            ImageFormat::Png,
        )
        .unwrap();
        assert_eq!(decode_color(bytes.get_ref()).unwrap(), image);
        let error = decode_color(&bytes.get_ref()[..200]).unwrap_err().to_string();
        assert!(error.starts_with("colour image cannot be decoded: "), "{error}");
    }

    #[test]
    fn every_truncated_jpeg_is_refused() {
        let bytes = encode_color(&test_image(40, 30), JPEG_QUALITY).unwrap();
        for len in 0..bytes.len() {
            assert!(decode_color(&bytes[..len]).is_err(), "{len} of {}", bytes.len());
        }
        let gif = decode_color(b"GIF89a...").unwrap_err().to_string();
        assert!(gif.contains("this is a GIF picture, expected JPEG or PNG"), "{gif}");
        assert!(decode_color(b"hello").unwrap_err().to_string().ends_with("neither JPEG nor PNG"));
    }

    #[test]
    fn too_wide_for_jpeg_is_refused() {
        assert!(encode_color(&ColorImage::filled(70_000, 1, [0; 3]), 90).is_err());
        assert!(encode_color(&ColorImage::filled(0, 1, [0; 3]), 90).is_err());
    }

    proptest! {
        #[test]
        fn broken_jpegs_do_not_panic(position in any::<prop::sample::Index>(), with in any::<[u8; 4]>()) {
            let mut bytes = encode_color(&test_image(24, 16), JPEG_QUALITY).unwrap();
            let at = position.index(bytes.len() - 4);
            bytes[at..at + 4].copy_from_slice(&with);
            let _ = decode_color(&bytes);
        }

        #[test]
        fn random_bytes_do_not_panic(mut bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let _ = decode_color(&bytes);
            for start in [&b"\xff\xd8\xff"[..], b"\x89PNG\r\n\x1a\n"] {
                bytes.splice(0..0, start.iter().copied());
                bytes.extend(b"\xff\xd9");
                let _ = decode_color(&bytes);
            }
        }
    }
}
