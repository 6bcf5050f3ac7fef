//! Depth images of `compressed_depth_image_transport`: a header of 12 bytes, then a PNG or RVL.

use crate::codec::{CodecError, decode_raw_depth, decode_rvl};
use trundle_core::{DepthImage, Image};

/// Bytes in front of the image: a number of the quantisation, and its two parameters as floats. Source: `compressed_depth_image_transport`.
const HEADER_BYTES: usize = 12;
/// First bytes of a PNG. Source: PNG specification, 5.2.
const PNG_MAGIC: &[u8] = b"\x89PNG";

/// Whether a format is `compressedDepth`, as `16UC1; compressedDepth png`.
pub(super) fn is_compressed_depth(format: &str) -> bool {
    format.contains("compressedDepth")
}

/// Depth in metres, 0 for unknown. `format` is the message's format, as `16UC1; compressedDepth png`. Images of 32 bits hold quantised
/// inverse depth d: metres = a / (d - b). In all other images, `depth_scale` units are one metre.
///
/// # Errors
/// When the image is cut, of another pixel format, or its parameters make no depth.
pub fn decode_compressed_depth(
    format: &str,
    bytes: &[u8],
    depth_scale: f64,
) -> Result<DepthImage, CodecError> {
    let failed = |problem: String| CodecError::decode("depth", problem);
    // Some cameras' drivers leave the header out.
    let (header, image) = if bytes.starts_with(PNG_MAGIC) {
        (&[0; HEADER_BYTES][..], bytes)
    } else {
        bytes
            .split_at_checked(HEADER_BYTES)
            .ok_or_else(|| failed(format!("{} bytes, expected a header of {HEADER_BYTES}", bytes.len())))?
    };
    let raw = if image.starts_with(PNG_MAGIC) { decode_raw_depth(image)? } else { decode_rvl(image)? };
    if !format.starts_with("32FC1") {
        return metres(&raw, |value| f64::from(value) / depth_scale);
    }
    let parameter = |at: usize| {
        header[at..].first_chunk().map_or(f64::NAN, |bytes| f64::from(f32::from_le_bytes(*bytes)))
    };
    let (a, b) = (parameter(4), parameter(8));
    if !(a.is_finite() && a > 0.0 && b.is_finite()) {
        return Err(failed(format!(
            "the quantisation is {a}, {b}, expected a finite number above 0, and one"
        )));
    }
    metres(&raw, |value| a / (f64::from(value) - b))
}

/// Converts numbers to depths; 0 and invalid depths become 0.
fn metres(raw: &Image<u16>, depth: impl Fn(u16) -> f64) -> Result<DepthImage, CodecError> {
    let metres = |&value: &u16| {
        let depth = if value == 0 { 0.0 } else { depth(value) };
        if depth.is_finite() && depth > 0.0 { depth as f32 } else { 0.0 }
    };
    Ok(DepthImage::new(raw.width(), raw.height(), raw.data().iter().map(metres).collect())?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::{encode_depth, encode_depth_rvl};

    #[test]
    fn millimetres_in_png_and_rvl_are_the_same() {
        let depth = DepthImage::from_fn(7, 5, |x, y| 0.5 * (x * y) as f32);
        let png = encode_depth(&depth).unwrap();
        let header = [0; HEADER_BYTES];
        for (format, bytes) in [
            ("16UC1; compressedDepth png", [&header[..], &png].concat()),
            ("16UC1; compressedDepth", [&header[..], &png].concat()),
            ("16UC1; compressedDepth png", png.clone()),
            ("16UC1; compressedDepth rvl", [&header[..], &encode_depth_rvl(&depth).unwrap()].concat()),
        ] {
            assert_eq!(decode_compressed_depth(format, &bytes, 1000.0).unwrap(), depth, "{format}");
            for end in 0..bytes.len().min(40) {
                assert!(decode_compressed_depth(format, &bytes[..end], 1000.0).is_err());
            }
        }
    }

    #[test]
    fn inverse_depth_is_undone() {
        // Quantisation of depths up to 10 m with a = 100: d = 100 / metres + 1.
        let raw = DepthImage::new(3, 1, vec![0.0, 0.051, 0.201]).unwrap();
        let mut bytes = vec![1, 0, 0, 0];
        bytes.extend(100.0_f32.to_le_bytes());
        bytes.extend(1.0_f32.to_le_bytes());
        bytes.extend(encode_depth_rvl(&raw).unwrap());
        let depth = decode_compressed_depth("32FC1; compressedDepth rvl", &bytes, 1.0).unwrap();
        assert_eq!(depth.data(), [0.0, 2.0, 0.5]);
        bytes[4..8].copy_from_slice(&f32::NAN.to_le_bytes());
        let problem = decode_compressed_depth("32FC1; compressedDepth rvl", &bytes, 1.0).unwrap_err();
        assert!(problem.to_string().contains("the quantisation is NaN, 1"), "{problem}");
    }
}
