//! Colour images from raw bytes.

use super::bt601::rgb_from_yuv;
use super::{compressed, raw_rows};
use crate::camera::{PixelFormat, RawImage};
use trundle_core::{ColorImage, Invalid};

/// Converts `raw` into `image`, whose memory is used again when the size is the same.
///
/// # Errors
/// When the format is one of depth, the number of bytes does not fit the size, or a JPEG cannot be decoded.
pub fn color_from_raw(raw: &RawImage, image: &mut ColorImage) -> Result<(), Invalid> {
    match raw.format {
        PixelFormat::Mjpg => compressed::color_from_jpeg(raw, image),
        PixelFormat::Yuyv => each_pair(raw, image, |p| [(p[0], p[1], p[3]), (p[2], p[1], p[3])]),
        PixelFormat::Uyvy => each_pair(raw, image, |p| [(p[1], p[0], p[2]), (p[3], p[0], p[2])]),
        PixelFormat::Rgb8 => each_pixel::<3>(raw, image, |p| p),
        PixelFormat::Bgr8 => each_pixel::<3>(raw, image, |p| [p[2], p[1], p[0]]),
        PixelFormat::Rgba8 => each_pixel::<4>(raw, image, |p| [p[0], p[1], p[2]]),
        PixelFormat::Bgra8 => each_pixel::<4>(raw, image, |p| [p[2], p[1], p[0]]),
        PixelFormat::Gray8 => each_pixel::<1>(raw, image, |p| [p[0]; 3]),
        depth => Err(Invalid::new("pixel format of the colour image", depth, "", "a colour format")),
    }
}

fn each_pixel<const BYTES: usize>(
    raw: &RawImage,
    image: &mut ColorImage,
    rgb: impl Fn([u8; BYTES]) -> [u8; 3],
) -> Result<(), Invalid> {
    let rows = raw_rows::rows(raw)?;
    resize(image, raw);
    for (y, row) in rows.enumerate() {
        let (pixels, _) = row.as_chunks::<BYTES>();
        for (target, pixel) in image.row_mut(y).iter_mut().zip(pixels) {
            *target = rgb(*pixel);
        }
    }
    Ok(())
}

/// Formats with one chroma for two pixels.
fn each_pair(
    raw: &RawImage,
    image: &mut ColorImage,
    yuv: impl Fn([u8; 4]) -> [(u8, u8, u8); 2],
) -> Result<(), Invalid> {
    if !raw.width.is_multiple_of(2) {
        let place = format!("width of a {} image", raw.format);
        return Err(Invalid::new(place, raw.width, "px", "an even number: two pixels share their chroma"));
    }
    let rows = raw_rows::rows(raw)?;
    resize(image, raw);
    for (y, row) in rows.enumerate() {
        let (pairs, _) = row.as_chunks::<4>();
        let (targets, _) = image.row_mut(y).as_chunks_mut::<2>();
        for (target, pair) in targets.iter_mut().zip(pairs) {
            *target = yuv(*pair).map(|(y, u, v)| rgb_from_yuv(y, u, v));
        }
    }
    Ok(())
}

fn resize(image: &mut ColorImage, raw: &RawImage) {
    if (image.width(), image.height()) != (raw.width, raw.height) {
        *image = ColorImage::filled(raw.width, raw.height, [0; 3]);
    }
}
