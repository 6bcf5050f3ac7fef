//! Pictures of maps and masks: PGM, PNG or BMP as levels of grey.

use crate::codec::can_hold;
use crate::pgm::{MAX_PIXELS, Pgm};
use crate::{FileKind, IoError};
use image::{ImageFormat, ImageReader, Limits};
use png::{BitDepth, ColorType, Decoder, Transformations};
use std::io::Cursor;
use std::path::Path;

/// A grey picture, row by row from the top. Colours are averaged.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Picture {
    pub width: usize,
    pub height: usize,
    /// White, 1 to 65,535.
    pub maxval: u16,
    pub values: Vec<u16>,
    /// Whether each pixel is transparent; empty if none is.
    pub transparent: Vec<bool>,
}

impl Picture {
    /// A picture of one of the formats, recognised by its first bytes.
    pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Self, IoError> {
        let picture = match image::guess_format(bytes) {
            Ok(ImageFormat::Png) => of_png(bytes),
            Ok(ImageFormat::Bmp) => of_bmp(bytes),
            Ok(ImageFormat::Pnm) if FileKind::of_bytes(bytes, bytes.len() as u64) != FileKind::Netpbm => {
                of_pgm(bytes)
            }
            Ok(_) | Err(_) => Err(other_picture(bytes)),
        };
        picture.map_err(|problem| IoError::malformed(path, problem))
    }

    /// Whether pixel `i` is transparent, wholly or in part.
    pub(super) fn is_transparent(&self, i: usize) -> bool {
        self.transparent.get(i).copied().unwrap_or(false)
    }

    /// The indices of the pixels by rising y of the map: the picture's first row is its highest.
    pub(super) fn indices(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.height).rev().flat_map(|row| row * self.width..(row + 1) * self.width)
    }
}

/// Width and height of a map's picture according to its first bytes \[px\], before decoding.
#[must_use]
pub fn picture_size(bytes: &[u8]) -> Option<(usize, usize)> {
    match image::guess_format(bytes).ok()? {
        ImageFormat::Pnm => Pgm::size(bytes).ok(),
        format @ (ImageFormat::Png | ImageFormat::Bmp) => {
            let (width, height) =
                ImageReader::with_format(Cursor::new(bytes), format).into_dimensions().ok()?;
            Some((width as usize, height as usize))
        }
        _ => None,
    }
}

/// The problem of a picture of another format.
fn other_picture(bytes: &[u8]) -> String {
    let found = FileKind::of_bytes(bytes, bytes.len() as u64);
    format!("this is {found}, expected a PGM, PNG or BMP; save it as PNG or PGM")
}

fn of_pgm(bytes: &[u8]) -> Result<Picture, String> {
    let Pgm { width, height, maxval, values } = Pgm::parse(bytes)?;
    Ok(Picture { width, height, maxval, values, transparent: Vec::new() })
}

fn of_png(bytes: &[u8]) -> Result<Picture, String> {
    let failed = |_: png::DecodingError| "the PNG is damaged or cut off".to_owned();
    let limits = png::Limits { bytes: 8 * MAX_PIXELS };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    decoder.set_transformations(Transformations::EXPAND); // palettes to colours, 1 to 4 bits to 8
    let mut reader = decoder.read_info().map_err(failed)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    check_claim(width, height, reader.info().bits_per_pixel(), bytes.len())?;
    let (color, depth) = reader.output_color_type();
    let size = reader.output_buffer_size().ok_or_else(|| "the PNG is too large".to_owned())?;
    let mut data = vec![0; size];
    reader.next_frame(&mut data).map_err(failed)?;
    let samples: Vec<u16> = match depth {
        BitDepth::Sixteen => data.as_chunks::<2>().0.iter().map(|&pair| u16::from_be_bytes(pair)).collect(),
        _ => data.into_iter().map(u16::from).collect(),
    };
    let white = if depth == BitDepth::Sixteen { u16::MAX } else { 255 };
    Ok(of_samples(
        (width, height),
        color.samples(),
        color == ColorType::GrayscaleAlpha || color == ColorType::Rgba,
        &samples,
        white,
    ))
}

fn of_bmp(bytes: &[u8]) -> Result<Picture, String> {
    let failed = |_: image::ImageError| "the BMP is damaged, cut off or of a rare form".to_owned();
    let reader = || ImageReader::with_format(Cursor::new(bytes), ImageFormat::Bmp);
    let (width, height) = reader().into_dimensions().map_err(failed)?;
    check_claim(width as usize, height as usize, 1, bytes.len())?;
    let mut reader = reader();
    let mut limits = Limits::default();
    limits.max_alloc = Some(8 * MAX_PIXELS as u64);
    reader.limits(limits);
    let image = reader.decode().map_err(failed)?.into_rgb8();
    let samples: Vec<u16> = image.into_raw().into_iter().map(u16::from).collect();
    Ok(of_samples((width as usize, height as usize), 3, false, &samples, 255))
}

/// The grey picture of samples; the last sample of a pixel may be alpha.
fn of_samples(
    (width, height): (usize, usize),
    per_pixel: usize,
    has_alpha: bool,
    samples: &[u16],
    white: u16,
) -> Picture {
    let colors = per_pixel - usize::from(has_alpha);
    let pixels = samples.chunks_exact(per_pixel);
    let sum = |pixel: &[u16]| pixel[..colors].iter().map(|&sample| u32::from(sample)).sum::<u32>();
    // For 8 bits the sum itself is stored, because an average would be rounded.
    let is_sum = white == 255;
    let divisor = if is_sum { 1 } else { colors as u32 };
    let values = pixels.clone().map(|pixel| (sum(pixel) / divisor) as u16).collect();
    let maxval = if is_sum { white * colors as u16 } else { white };
    let mut transparent: Vec<bool> = Vec::new();
    if has_alpha {
        transparent = pixels.map(|pixel| pixel[colors] < white).collect();
    }
    Picture { width, height, maxval, values, transparent }
}

/// Refuses a size that the limit or the bytes of the file cannot hold.
fn check_claim(width: usize, height: usize, bits: usize, file_bytes: usize) -> Result<(), String> {
    let pixels = width.checked_mul(height).filter(|pixels| (1..=MAX_PIXELS).contains(pixels));
    let pixels = pixels
        .ok_or_else(|| format!("size is {width} x {height} px, expected 1 to {MAX_PIXELS} px in all"))?;
    if !can_hold(file_bytes, pixels, bits) {
        return Err(format!(
            "size is {width} x {height} px, more than a file of {file_bytes} bytes can hold"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, GrayImage, RgbImage, RgbaImage};
    use png::Encoder;
    use proptest::prelude::*;

    /// Darkness of each pixel, 0 to 1, in thousandths.
    fn shades(bytes: &[u8]) -> Vec<u32> {
        let picture = Picture::parse(Path::new("m.png"), bytes).unwrap();
        picture.values.iter().map(|&value| u32::from(value) * 1000 / u32::from(picture.maxval)).collect()
    }

    fn bytes(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    const GREYS: [u8; 6] = [0, 100, 205, 254, 255, 7];

    fn png(color: ColorType, depth: BitDepth, data: &[u8], palette: Option<&'static [u8]>) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = Encoder::new(&mut bytes, 2, 2);
        encoder.set_color(color);
        encoder.set_depth(depth);
        if let Some(palette) = palette {
            encoder.set_palette(palette);
        }
        encoder.write_header().unwrap().write_image_data(data).unwrap();
        bytes
    }

    #[test]
    fn the_same_greys_come_out_of_every_format() {
        let grey = GrayImage::from_raw(3, 2, GREYS.to_vec()).unwrap();
        let expected = GREYS.map(|grey| u32::from(grey) * 1000 / 255).to_vec();
        let pgm = [&b"P5\n3 2\n255\n"[..], &GREYS].concat();
        let rgb = RgbImage::from_fn(3, 2, |x, y| image::Rgb([GREYS[(3 * y + x) as usize]; 3]));
        for bytes in [
            pgm,
            bytes(&DynamicImage::ImageLuma8(grey.clone()), ImageFormat::Png),
            bytes(&DynamicImage::ImageRgb8(rgb.clone()), ImageFormat::Png),
            bytes(&DynamicImage::ImageRgb8(rgb), ImageFormat::Bmp),
            bytes(&DynamicImage::ImageLuma8(grey), ImageFormat::Bmp),
        ] {
            assert_eq!(shades(&bytes), expected);
        }
    }

    #[test]
    fn few_bits_palettes_and_sixteen_bits_are_greys() {
        assert_eq!(
            shades(&png(ColorType::Grayscale, BitDepth::One, &[0x40, 0x80], None)),
            [0, 1000, 1000, 0]
        );
        assert_eq!(
            shades(&png(ColorType::Grayscale, BitDepth::Four, &[0x0f, 0x3c], None)),
            [0, 1000, 200, 800]
        );
        let palette: &'static [u8] = &[0, 0, 0, 255, 255, 255, 30, 60, 90];
        assert_eq!(
            shades(&png(ColorType::Indexed, BitDepth::Eight, &[0, 1, 2, 2], Some(palette))),
            [0, 1000, 235, 235]
        );
        let wide: Vec<u8> =
            [0u16, 65_535, 6_554, 52_429].iter().flat_map(|value| value.to_be_bytes()).collect();
        assert_eq!(shades(&png(ColorType::Grayscale, BitDepth::Sixteen, &wide, None)), [0, 1000, 100, 800]);
    }

    #[test]
    fn pixels_that_are_not_opaque_are_transparent() {
        let image = RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 255, 0, 0, 254]).unwrap();
        let picture =
            Picture::parse(Path::new("m"), &bytes(&DynamicImage::ImageRgba8(image), ImageFormat::Png))
                .unwrap();
        assert_eq!((picture.values[0], picture.maxval), (255, 765), "colours are averaged");
        assert_eq!([picture.is_transparent(0), picture.is_transparent(1)], [false, true]);
    }

    #[test]
    fn a_picture_of_another_kind_is_named() {
        let problem = |bytes: &[u8]| Picture::parse(Path::new("m.png"), bytes).unwrap_err().to_string();
        assert_eq!(
            problem(b"hello"),
            "m.png: this is a text file of no known kind, expected a PGM, PNG or BMP; save it as PNG or PGM"
        );
        assert_eq!(
            problem(b"\xff\xd8\xff\xe0"),
            "m.png: this is a JPEG picture, expected a PGM, PNG or BMP; save it as PNG or PGM"
        );
        assert!(problem(b"GIF89a......").contains("this is a GIF picture, expected"));
        assert!(problem(b"P6 1 1 255\n...").contains("this is a PBM or PPM picture, expected"));
        assert!(problem(b"P4 1 1\n.").contains("this is a PBM or PPM picture, expected"));
        let whole = png(ColorType::Grayscale, BitDepth::Eight, &[1, 2, 3, 4], None);
        assert_eq!(problem(&whole[..whole.len() - 20]), "m.png: the PNG is damaged or cut off");
        let mut huge = whole.clone();
        huge[16..24].copy_from_slice(&[0, 0, 64, 0, 0, 0, 64, 0]); // and a checksum that is wrong
        assert!(Picture::parse(Path::new("m.png"), &huge).is_err());
        assert!(
            check_claim(16_384, 16_384, 8, 1000)
                .unwrap_err()
                .contains("more than a file of 1000 bytes can hold")
        );
    }

    #[test]
    fn the_size_of_a_picture_is_known_before_it_is_decoded() {
        let grey = DynamicImage::ImageLuma8(GrayImage::from_raw(3, 2, GREYS.to_vec()).unwrap());
        for format in [ImageFormat::Png, ImageFormat::Bmp] {
            assert_eq!(picture_size(&bytes(&grey, format)), Some((3, 2)), "{format:?}");
        }
        assert_eq!(picture_size(b"P5 # size\n30000 20000 255\n"), Some((30_000, 20_000)));
        assert_eq!([picture_size(b"P5 x"), picture_size(b""), picture_size(b"image: a.pgm")], [None; 3]);
    }

    proptest! {
        #[test]
        fn broken_pictures_do_not_panic(format in 0..2, position in any::<prop::sample::Index>(), with in any::<[u8; 4]>()) {
            let grey = DynamicImage::ImageLuma8(GrayImage::from_raw(3, 2, GREYS.to_vec()).unwrap());
            let mut bytes = bytes(&grey, [ImageFormat::Png, ImageFormat::Bmp][format as usize]);
            let at = position.index(bytes.len() - 4);
            bytes[at..at + 4].copy_from_slice(&with);
            let _ = Picture::parse(Path::new("m"), &bytes);
        }
    }
}
