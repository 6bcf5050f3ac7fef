//! Pixels of raw images (`sensor_msgs/msg/Image`) by their encoding.

use super::raw_image::RawImage;
use super::yuv::{Yuv, color_of_yuv};
use crate::codec::CodecError;
use trundle_core::{ColorImage, DepthImage};

/// Encodings of separate pixels: bytes per pixel, and the positions of red, green and blue.
const COLOR_ENCODINGS: &[(&str, usize, [usize; 3])] = &[
    ("rgb8", 3, [0, 1, 2]),
    ("bgr8", 3, [2, 1, 0]),
    ("8UC3", 3, [2, 1, 0]),
    ("rgba8", 4, [0, 1, 2]),
    ("bgra8", 4, [2, 1, 0]),
    ("8UC4", 4, [2, 1, 0]),
    ("mono8", 1, [0, 0, 0]),
    ("8UC1", 1, [0, 0, 0]),
];

/// The encodings that are read, for messages.
const READ_COLORS: &str = "rgb8, bgr8, rgba8, bgra8, mono8, yuv422, yuv422_yuy2, nv12 or nv21";

pub(super) fn is_raw_color(encoding: &str) -> bool {
    Yuv::named(encoding).is_some() || COLOR_ENCODINGS.iter().any(|(name, ..)| *name == encoding)
}

pub(super) fn is_raw_depth(encoding: &str) -> bool {
    matches!(encoding, "16UC1" | "mono16" | "32FC1")
}

/// The colours of an image.
///
/// # Errors
/// When the encoding is unknown, or the bytes are too few for the size.
pub(super) fn color_of_raw(raw: &RawImage) -> Result<ColorImage, CodecError> {
    if let Some(form) = Yuv::named(&raw.encoding) {
        return color_of_yuv(raw, form);
    }
    let known = COLOR_ENCODINGS.iter().find(|(name, ..)| *name == raw.encoding);
    let Some((_, bytes, order)) = known else {
        return Err(CodecError::decode(
            "colour",
            format!("its encoding is '{}', expected {READ_COLORS}", raw.encoding),
        ));
    };
    let rows = raw.rows("colour", *bytes)?;
    let pixels = rows.flat_map(|row| row.chunks_exact(*bytes).map(|p| order.map(|i| p[i]))).collect();
    Ok(ColorImage::new(raw.width, raw.height, pixels)?)
}

/// Depth in metres of an image of 16 bits in units, or of 32-bit floats in metres; 0 for unknown.
///
/// # Errors
/// When the encoding is unknown, or the bytes are too few for the size.
pub(super) fn depth_of_raw(raw: &RawImage, depth_scale: f64) -> Result<DepthImage, CodecError> {
    let metres: Vec<f32> = if raw.encoding == "32FC1" {
        let number = if raw.is_big_endian { f32::from_be_bytes } else { f32::from_le_bytes };
        let rows = raw.rows("depth", 4)?;
        rows.flat_map(|row| row.as_chunks::<4>().0.iter().map(|bytes| number(*bytes))).collect()
    } else if is_raw_depth(&raw.encoding) {
        let number = if raw.is_big_endian { u16::from_be_bytes } else { u16::from_le_bytes };
        let metres = |bytes: &[u8; 2]| (f64::from(number(*bytes)) / depth_scale) as f32;
        raw.rows("depth", 2)?.flat_map(|row| row.as_chunks::<2>().0.iter().map(metres)).collect()
    } else {
        let problem = format!("its encoding is '{}', expected 16UC1, mono16 or 32FC1", raw.encoding);
        return Err(CodecError::decode("depth", problem));
    };
    let depth = metres.iter().map(|&depth| if depth.is_finite() && depth > 0.0 { depth } else { 0.0 });
    Ok(DepthImage::new(raw.width, raw.height, depth.collect())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn raw(encoding: &str, step: usize, data: &[u8]) -> RawImage {
        RawImage {
            width: 2,
            height: 1,
            encoding: encoding.to_owned(),
            is_big_endian: false,
            step,
            data: data.to_vec(),
        }
    }

    #[test]
    fn colours_of_every_order_with_bytes_behind_the_row() {
        let expected = [[1, 2, 3], [4, 5, 6]];
        for (encoding, data) in [
            ("rgb8", &[1, 2, 3, 4, 5, 6, 9][..]),
            ("bgr8", &[3, 2, 1, 6, 5, 4]),
            ("rgba8", &[1, 2, 3, 9, 4, 5, 6, 9]),
            ("bgra8", &[3, 2, 1, 9, 6, 5, 4, 9]),
        ] {
            assert_eq!(
                color_of_raw(&raw(encoding, data.len(), data)).unwrap().data(),
                expected,
                "{encoding}"
            );
        }
        assert_eq!(color_of_raw(&raw("mono8", 2, &[7, 8])).unwrap().data(), [[7; 3], [8; 3]]);
        let problem = color_of_raw(&raw("bayer_rggb8", 2, &[7, 8])).unwrap_err().to_string();
        assert!(problem.contains("its encoding is 'bayer_rggb8', expected rgb8"), "{problem}");
        let problem = color_of_raw(&raw("rgb8", 6, &[1; 5])).unwrap_err().to_string();
        assert!(
            problem.contains("2 x 1 px of 'rgb8' with 6 bytes per row do not fit into 5 bytes"),
            "{problem}"
        );
        let huge = RawImage { width: usize::MAX, ..raw("rgb8", 6, &[1; 6]) };
        assert!(color_of_raw(&huge).is_err());
    }

    #[test]
    fn depths_of_both_encodings_and_endians() {
        let units = depth_of_raw(&raw("16UC1", 4, &[0xe8, 3, 0, 0]), 1000.0).unwrap();
        assert_eq!(units.data(), [1.0, 0.0]);
        let big = RawImage { is_big_endian: true, ..raw("16UC1", 4, &[3, 0xe8, 0, 0]) };
        assert_eq!(depth_of_raw(&big, 1000.0).unwrap().data(), [1.0, 0.0]);
        let floats = [1.5_f32.to_le_bytes(), f32::NAN.to_le_bytes()].concat();
        assert_eq!(depth_of_raw(&raw("32FC1", 8, &floats), 1000.0).unwrap().data(), [1.5, 0.0]);
        assert!(depth_of_raw(&raw("8UC1", 2, &[1, 2]), 1.0).is_err());
    }
}
