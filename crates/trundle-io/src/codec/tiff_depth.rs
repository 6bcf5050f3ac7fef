//! Depth images of TIFF files: 16-bit grey, or 32-bit floats.

use super::CodecError;
use super::claim::check_size;
use super::raw_depth::RawDepth;
use std::io::Cursor;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};
use trundle_core::Image;

/// The pixels of a grey TIFF.
pub(super) fn decode(bytes: &[u8]) -> Result<RawDepth, CodecError> {
    let failed = |error: TiffError| CodecError::decode("depth", problem(&error));
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(failed)?;
    let (width, height) = decoder.dimensions().map_err(failed)?;
    let (width, height) = (width as usize, height as usize);
    let color = decoder.colortype().map_err(failed)?;
    let bits = match color {
        ColorType::Gray(bits @ (16 | 32 | 64)) => bits,
        other => return Err(CodecError::DepthFormat { found: name(other) }),
    };
    match (bits, sample_format(&mut decoder)) {
        (16, UNSIGNED_FORMAT) | (32, FLOAT_FORMAT) => {}
        (bits, format) => return Err(CodecError::DepthFormat { found: grey_name(bits, format) }),
    }
    let bytes_per_pixel = usize::from(bits) / 8;
    check_size("depth", (width, height), usize::from(bits), bytes.len())?;
    let mut limits = Limits::default();
    limits.decoding_buffer_size = width * height * bytes_per_pixel;
    limits.intermediate_buffer_size = limits.decoding_buffer_size.max(bytes.len());
    limits.ifd_value_size = bytes.len();
    match decoder.with_limits(limits).read_image().map_err(failed)? {
        DecodingResult::U16(values) => Ok(RawDepth::Units(Image::new(width, height, values)?)),
        DecodingResult::F32(values) => Ok(RawDepth::Metres(Image::new(width, height, values)?)),
        _ => Err(CodecError::decode(
            "depth",
            "the TIFF is damaged: its pixels are not of the kind that it names",
        )),
    }
}

/// How numbers of pixels are written where the TIFF does not say it, and whole numbers from 0 (TIFF 6.0, `SampleFormat`).
const UNSIGNED_FORMAT: u16 = 1;
/// Whole numbers with a sign (TIFF 6.0, `SampleFormat`).
const SIGNED_FORMAT: u16 = 2;
/// Floating-point numbers (TIFF 6.0, `SampleFormat`).
const FLOAT_FORMAT: u16 = 3;

/// How the numbers of the pixels are written.
fn sample_format(decoder: &mut Decoder<Cursor<&[u8]>>) -> u16 {
    let formats = decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat).ok().flatten();
    formats.and_then(|formats| formats.first().copied()).unwrap_or(UNSIGNED_FORMAT)
}

/// The name of grey pixels of a sample format.
fn grey_name(bits: u8, format: u16) -> String {
    match format {
        FLOAT_FORMAT => format!("{bits}-bit float"),
        SIGNED_FORMAT => format!("{bits}-bit signed whole-numbered"),
        _ => format!("{bits}-bit whole-numbered"),
    }
}

fn problem(error: &TiffError) -> &'static str {
    match error {
        TiffError::UnsupportedError(_) => {
            "the TIFF is of a form that is not read, expected grey pixels plain, LZW or deflate"
        }
        TiffError::LimitsExceeded => "the TIFF claims more pixels than its bytes can hold",
        _ => "the TIFF is damaged or cut off",
    }
}

fn name(color: ColorType) -> String {
    match color {
        ColorType::Gray(bits) => format!("{bits}-bit grey"),
        ColorType::RGB(bits) => format!("{bits}-bit RGB"),
        ColorType::RGBA(bits) => format!("{bits}-bit RGBA"),
        ColorType::Palette(bits) => format!("{bits}-bit palette"),
        _ => "coloured".to_owned(),
    }
}
