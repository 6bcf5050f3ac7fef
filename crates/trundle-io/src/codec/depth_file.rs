//! Depth images of files: 16-bit PNG, TIFF or PGM in units of the camera, 32-bit float TIFF or OpenEXR in metres.

use super::claim::check_size;
use super::raw_depth::RawDepth;
use super::{CodecError, decode_raw_depth, exr_depth, tiff_depth};
use crate::FileKind;
use crate::pgm::Pgm;
use image::ImageFormat;
use trundle_core::{DepthImage, Image};

/// A depth image in metres, 0 for unknown depth. `depth_scale`: units per metre of whole-numbered pixels; floats are metres.
///
/// # Errors
/// When the bytes are no such image, end too early, or hold more than 67 Mpx.
pub(crate) fn decode_depth_file(bytes: &[u8], depth_scale: f64) -> Result<DepthImage, CodecError> {
    let raw = match image::guess_format(bytes) {
        Ok(ImageFormat::Png) => RawDepth::Units(decode_raw_depth(bytes)?),
        Ok(ImageFormat::Tiff) => tiff_depth::decode(bytes)?,
        Ok(ImageFormat::OpenExr) => RawDepth::Metres(exr_depth::decode(bytes)?),
        Ok(ImageFormat::Pnm) => RawDepth::Units(of_pgm(bytes)?),
        Ok(_) => {
            let found = FileKind::of_bytes(bytes, bytes.len() as u64);
            let problem = format!("this is {found}, expected a PNG, TIFF, PGM or OpenEXR of depths");
            return Err(CodecError::decode("depth", problem));
        }
        Err(_) if FileKind::of_bytes(bytes, bytes.len() as u64) == FileKind::Tiff => {
            return Err(CodecError::decode("depth", "this is a BigTIFF picture, expected a TIFF below 4 GB"));
        }
        Err(_) => {
            return Err(CodecError::decode("depth", "no picture, expected a PNG, TIFF, PGM or OpenEXR"));
        }
    };
    Ok(match raw {
        RawDepth::Units(raw) => {
            let metres = raw.data().iter().map(|&value| (f64::from(value) / depth_scale) as f32).collect();
            DepthImage::new(raw.width(), raw.height(), metres)?
        }
        RawDepth::Metres(raw) => {
            let metres = raw
                .data()
                .iter()
                .map(|&depth| if depth.is_finite() && depth > 0.0 { depth } else { 0.0 })
                .collect();
            DepthImage::new(raw.width(), raw.height(), metres)?
        }
    })
}

/// Whether the first bytes are those of a depth image: 16-bit grey PNG, or a format that is not used for colour.
pub(crate) fn is_depth_image(head: &[u8]) -> bool {
    match image::guess_format(head) {
        Ok(ImageFormat::Png) => head.get(24..26) == Some(&[16, 0]),
        Ok(ImageFormat::Tiff | ImageFormat::OpenExr) => true,
        Ok(ImageFormat::Pnm) => head.starts_with(b"P5") || head.starts_with(b"P2"),
        _ => false,
    }
}

fn of_pgm(bytes: &[u8]) -> Result<Image<u16>, CodecError> {
    let pgm = Pgm::parse(bytes).map_err(|problem| CodecError::decode("depth", problem))?;
    if pgm.maxval < 256 {
        return Err(CodecError::DepthFormat { found: "8-bit grey".to_owned() });
    }
    check_size("depth", (pgm.width, pgm.height), 16, bytes.len())?;
    Ok(Image::new(pgm.width, pgm.height, pgm.values)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::encode_grey16;
    use proptest::prelude::*;
    use std::io::Cursor;
    use tiff::encoder::{TiffEncoder, colortype};

    const SIZE: (usize, usize) = (5, 3);

    /// Depths of 0, 0.5 m, 1 m, ...
    fn truth() -> DepthImage {
        DepthImage::from_fn(SIZE.0, SIZE.1, |x, y| 0.5 * (x + y) as f32)
    }

    fn units() -> Vec<u16> {
        truth().data().iter().map(|metres| (metres * 1000.0) as u16).collect()
    }

    fn tiff<C: colortype::ColorType>(pixels: &[C::Inner]) -> Vec<u8>
    where
        [C::Inner]: tiff::encoder::TiffValue,
    {
        let mut bytes = Cursor::new(Vec::new());
        TiffEncoder::new(&mut bytes).unwrap().write_image::<C>(5, 3, pixels).unwrap();
        bytes.into_inner()
    }

    /// An OpenEXR file whose header names DWAA.
    fn exr_by_dwaa() -> Vec<u8> {
        let mut bytes = exr();
        let name = b"compression\0compression\0";
        let at = bytes.windows(name.len()).position(|part| part == name).unwrap();
        bytes[at + name.len() + 4] = 8;
        bytes
    }

    fn exr() -> Vec<u8> {
        use exr::prelude::*;
        let samples = FlatSamples::F32(truth().data().to_vec());
        let channels = AnyChannels::sort([AnyChannel::new("Y", samples)].into_iter().collect());
        let mut bytes = Cursor::new(Vec::new());
        Image::from_channels((5, 3), channels).write().to_buffered(&mut bytes).unwrap();
        bytes.into_inner()
    }

    fn files() -> Vec<(&'static str, Vec<u8>)> {
        let pgm =
            [b"P5\n5 3\n65535\n".to_vec(), units().iter().flat_map(|value| value.to_be_bytes()).collect()]
                .concat();
        vec![
            ("png", encode_grey16(&truth(), |metres| (metres * 1000.0) as u16).unwrap()),
            ("pgm", pgm),
            ("16-bit tiff", tiff::<colortype::Gray16>(&units())),
            ("float tiff", tiff::<colortype::Gray32Float>(truth().data())),
            ("exr", exr()),
        ]
    }

    #[test]
    fn one_depth_image_is_the_same_in_every_format() {
        for (name, bytes) in files() {
            assert_eq!(decode_depth_file(&bytes, 1000.0).unwrap(), truth(), "{name}");
            assert!(is_depth_image(&bytes), "{name}");
            for len in 0..bytes.len().min(400) {
                let _ = decode_depth_file(&bytes[..len], 1000.0);
            }
        }
    }

    #[test]
    fn floats_that_are_not_depth_become_none() {
        let pixels =
            [f32::NAN, f32::INFINITY, -1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let read = decode_depth_file(&tiff::<colortype::Gray32Float>(&pixels), 1.0).unwrap();
        assert_eq!(read.data()[..5], [0.0, 0.0, 0.0, 0.0, 2.0]);
    }

    #[test]
    fn eight_bits_and_other_files_are_refused_by_name() {
        let problem = |bytes: &[u8]| decode_depth_file(bytes, 1000.0).unwrap_err().to_string();
        assert!(
            problem(&tiff::<colortype::Gray8>(&[7; 15]))
                .contains("8-bit grey pixels, expected 16-bit grey ones")
        );
        assert!(problem(b"P5 1 1 255\n#").contains("8-bit grey pixels"));
        assert!(problem(b"\xff\xd8\xff\xe0").contains("this is a JPEG picture, expected a PNG, TIFF"));
        for (bytes, found) in [
            (tiff::<colortype::Gray64Float>(&[2.0; 15]), "64-bit float"),
            (tiff::<colortype::Gray32>(&[2000; 15]), "32-bit whole-numbered"),
            (tiff::<colortype::GrayI16>(&[2000; 15]), "16-bit signed whole-numbered"),
        ] {
            let message = problem(&bytes);
            assert!(message.contains(&format!("has {found} pixels, expected 16-bit grey")), "{message}");
            assert!(!message.contains("too coarse"), "{message}");
        }
        assert!(problem(b"II+\0\x08\0\0\0").contains("this is a BigTIFF picture, expected a TIFF"));
        let lossy = problem(&exr_by_dwaa());
        assert!(lossy.contains("compressed by dwaa compression, expected ZIP"), "{lossy}");
        assert!(problem(b"no image").contains("no picture, expected a PNG, TIFF, PGM or OpenEXR"));
    }

    proptest! {
        #[test]
        fn broken_files_do_not_panic(which in 0usize..5, position in any::<prop::sample::Index>(), with in any::<[u8; 4]>()) {
            let mut bytes = files().swap_remove(which).1;
            let at = position.index(bytes.len() - 4);
            bytes[at..at + 4].copy_from_slice(&with);
            let _ = decode_depth_file(&bytes, 1000.0);
        }
    }
}
