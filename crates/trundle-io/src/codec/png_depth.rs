//! Depth images in millimetres: as 16-bit grey PNG, and as RVL.

use super::CodecError;
use super::claim::MAX_PIXELS;
use super::claim::check_size;
use super::png_writer::{PngFormat, encode_png};
use super::rvl::{decode_rvl, encode_rvl};
use png::{BitDepth, ColorType, Decoder, Filter, Limits};
use std::io::Cursor;
use trundle_core::{DepthImage, Image};

/// First bytes of a PNG. Read as a width of RVL, these bytes exceed the limit. Source: PNG specification, 5.2.
const PNG_MAGIC: &[u8] = b"\x89PNG";

/// Depth in metres from a whole number of millimetres: the only conversion from the recorded unit.
fn metres(millimetres: u16) -> f32 {
    f32::from(millimetres) * 0.001
}

/// The nearest whole number of millimetres; 0 (no reading) if the value is no depth or does not fit into 16 bits.
fn millimetres(metres: f32) -> u16 {
    let rounded = (f64::from(metres) * 1000.0).round();
    if rounded > 0.0 && rounded <= f64::from(u16::MAX) { rounded as u16 } else { 0 }
}

/// A depth image (m, 0 for unknown) as 16-bit grey PNG in millimetres.
///
/// # Errors
/// When a side is 0 or above 2^31 px.
pub fn encode_depth(image: &DepthImage) -> Result<Vec<u8>, CodecError> {
    encode_grey16(image, millimetres)
}

/// A depth image (m) as 16-bit grey PNG; `unit` converts a depth to its number.
pub(crate) fn encode_grey16(image: &DepthImage, unit: impl Fn(f32) -> u16) -> Result<Vec<u8>, CodecError> {
    let data: Vec<u8> = image.data().iter().flat_map(|&depth| unit(depth).to_be_bytes()).collect();
    // Sub: on a real depth image a sixth smaller than Up, and no slower.
    let format = PngFormat { color: ColorType::Grayscale, depth: BitDepth::Sixteen, filter: Filter::Sub };
    encode_png("depth", (image.width(), image.height()), &format, &data)
}

/// A depth image (m, 0 for unknown) in millimetres as width, height and stream of RVL.
///
/// # Errors
/// When a side is 0.
pub fn encode_depth_rvl(image: &DepthImage) -> Result<Vec<u8>, CodecError> {
    if image.data().is_empty() {
        return Err(CodecError::encode("depth", "the image has no pixel"));
    }
    let raw = image.data().iter().map(|&depth| millimetres(depth)).collect();
    Ok(encode_rvl(&Image::new(image.width(), image.height(), raw)?))
}

/// A depth image in metres from millimetres: a 16-bit grey PNG, or else RVL behind width and height.
///
/// # Errors
/// As [`decode_raw_depth`], and when the stream of RVL is cut or does not fit its size.
pub fn decode_depth(bytes: &[u8]) -> Result<DepthImage, CodecError> {
    let raw = if bytes.starts_with(PNG_MAGIC) { decode_raw_depth(bytes)? } else { decode_rvl(bytes)? };
    let data = raw.data().iter().map(|&value| metres(value)).collect();
    Ok(DepthImage::new(raw.width(), raw.height(), data)?)
}

/// The 16-bit numbers of a grey PNG, in the unit of the camera.
///
/// # Errors
/// When the bytes are not a PNG, end too early, have another pixel format, or hold more than 67 Mpx.
pub fn decode_raw_depth(bytes: &[u8]) -> Result<Image<u16>, CodecError> {
    let failed = |error: png::DecodingError| CodecError::decode("depth", error);
    let limits = Limits { bytes: 4 * MAX_PIXELS };
    let mut reader = Decoder::new_with_limits(Cursor::new(bytes), limits).read_info().map_err(failed)?;
    let (info, (color, depth)) = (reader.info(), reader.output_color_type());
    let (width, height) = (info.width as usize, info.height as usize);
    if (color, depth) != (ColorType::Grayscale, BitDepth::Sixteen) {
        return Err(CodecError::DepthFormat { found: format!("{}-bit {}", depth as u8, name(color)) });
    }
    check_size("depth", (width, height), 16, bytes.len())?;
    let mut data = vec![0; width * height * 2];
    reader.next_frame(&mut data).map_err(failed)?;
    let values = data.as_chunks::<2>().0.iter().map(|&pair| u16::from_be_bytes(pair)).collect();
    Ok(Image::new(width, height, values)?)
}

fn name(color: ColorType) -> &'static str {
    match color {
        ColorType::Grayscale => "grey",
        ColorType::Rgb => "RGB",
        ColorType::Indexed => "palette",
        ColorType::GrayscaleAlpha => "grey and alpha",
        ColorType::Rgba => "RGBA",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use png::Encoder;
    use proptest::prelude::*;

    #[test]
    fn every_millimetre_survives() {
        let image = DepthImage::from_fn(256, 256, |x, y| metres((y * 256 + x) as u16));
        for bytes in [encode_depth(&image).unwrap(), encode_depth_rvl(&image).unwrap()] {
            assert_eq!(decode_depth(&bytes).unwrap(), image);
        }
        assert!(encode_depth_rvl(&DepthImage::default()).is_err());
    }

    #[test]
    fn values_that_are_not_depth_become_none() {
        let depths = vec![f32::NAN, f32::INFINITY, -1.0, 65.536, 0.0004, 1.2344];
        let image = DepthImage::new(6, 1, depths).unwrap();
        let back = decode_depth(&encode_depth(&image).unwrap()).unwrap();
        assert_eq!(back.data(), [0.0, 0.0, 0.0, 0.0, 0.0, metres(1234)]);
    }

    #[test]
    fn eight_bits_are_refused_by_name() {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, 2, 2);
        encoder.set_color(ColorType::Grayscale);
        encoder.write_header().unwrap().write_image_data(&[0; 4]).unwrap();
        let error = decode_raw_depth(&bytes).unwrap_err().to_string();
        assert!(error.starts_with("depth image has 8-bit grey pixels, expected 16-bit grey ones"), "{error}");
    }

    #[test]
    fn every_truncated_png_and_an_empty_image_are_refused() {
        let bytes = encode_depth(&DepthImage::from_fn(20, 10, |x, y| (x + y) as f32 * 0.1)).unwrap();
        for len in 0..bytes.len() - 20 {
            assert!(decode_raw_depth(&bytes[..len]).is_err(), "{len} of {}", bytes.len());
        }
        assert!(encode_depth(&DepthImage::default()).is_err());
    }

    proptest! {
        #[test]
        fn broken_pngs_do_not_panic(position in any::<prop::sample::Index>(), with in any::<[u8; 4]>()) {
            let mut bytes = encode_depth(&DepthImage::filled(20, 10, 1.5)).unwrap();
            let at = position.index(bytes.len() - 4);
            bytes[at..at + 4].copy_from_slice(&with);
            let _ = decode_depth(&bytes);
        }
    }
}
