//! Encoding and decoding of colour and depth images: JPEG, PNG and RVL.

mod claim;
mod color;
mod depth_file;
mod error;
mod event;
mod exr_depth;
mod png_color;
mod png_depth;
mod png_grey;
mod png_writer;
mod raw_depth;
mod rvl;
mod tiff_depth;

pub(crate) use claim::can_hold;
pub use color::decode_color;
pub(crate) use depth_file::{decode_depth_file, is_depth_image};
pub use error::CodecError;
pub use event::{EncodedEvent, EncodedRgbd};
pub use png_color::encode_color_png;
pub(crate) use png_depth::encode_grey16;
pub use png_depth::{decode_depth, decode_raw_depth, encode_depth, encode_depth_rvl};
pub(crate) use png_grey::encode_grey8;
pub(crate) use rvl::decode_rvl;

use jpeg_encoder::{ColorType, Encoder, SamplingFactor};
use trundle_core::ColorImage;

/// JPEG quality of recorded colour images, 1 to 100: 90 preserves the positions of corners at a tenth of the raw size. Source: ours.
pub const JPEG_QUALITY: u8 = 90;

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

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use image::ImageFormat;
    use proptest::prelude::*;
    use std::io::Cursor;

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
