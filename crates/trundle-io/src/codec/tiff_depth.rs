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
    if !are_counts_possible(bytes) {
        return Err(CodecError::decode("depth", "the TIFF claims more values than its bytes can hold"));
    }
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

/// Whether each field of the first directory claims at most as many values as the file has bytes: the decoder allocates memory for all of
/// them. A file without a directory passes: the decoder refuses it.
fn are_counts_possible(bytes: &[u8]) -> bool {
    let is_little = bytes.starts_with(b"II");
    let number = |at: usize, length: usize| -> Option<usize> {
        let digits = bytes.get(at..at.checked_add(length)?)?;
        let add = |sum: usize, digit: &u8| sum << 8 | usize::from(*digit);
        Some(if is_little { digits.iter().rev().fold(0, add) } else { digits.iter().fold(0, add) })
    };
    let Some(directory) = number(DIRECTORY_OFFSET_AT, 4) else { return true };
    let fields = number(directory, 2).unwrap_or(0);
    let mut counts = (0..fields).map_while(|i| number(directory + 2 + i * FIELD_BYTES + COUNT_AT, 4));
    counts.all(|count| count <= bytes.len())
}

/// Position of the first directory's offset in the header \[bytes\]. Source: TIFF 6.0.
const DIRECTORY_OFFSET_AT: usize = 4;
/// Length of a field of a directory \[bytes\]. Source: TIFF 6.0.
const FIELD_BYTES: usize = 12;
/// Position of the number of values in a field \[bytes\]. Source: TIFF 6.0.
const COUNT_AT: usize = 4;

/// Sample format of a TIFF without this field: unsigned whole numbers. Source: TIFF 6.0, `SampleFormat`.
const UNSIGNED_FORMAT: u16 = 1;
/// Whole numbers with a sign. Source: TIFF 6.0, `SampleFormat`.
const SIGNED_FORMAT: u16 = 2;
/// Floating-point numbers. Source: TIFF 6.0, `SampleFormat`.
const FLOAT_FORMAT: u16 = 3;

/// Format of the pixels' numbers.
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
