//! Images in JPEG and PNG files.

use super::raw_rows::check_size;
use crate::camera::RawImage;
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use std::io::Cursor;
use trundle_core::{ColorImage, Image, Invalid};

/// A colour image from a JPEG file of the size that the camera promised.
///
/// # Errors
/// When the file cannot be decoded or has another size.
pub(super) fn color_from_jpeg(raw: &RawImage, image: &mut ColorImage) -> Result<(), Invalid> {
    let decoded = decode(raw, ImageFormat::Jpeg)?.into_rgb8();
    let (pixels, _) = decoded.as_raw().as_chunks::<3>();
    if (image.width(), image.height()) == (raw.width, raw.height) {
        image.data_mut().copy_from_slice(pixels);
        return Ok(());
    }
    *image = ColorImage::new(raw.width, raw.height, pixels.to_vec())?;
    Ok(())
}

/// The 16-bit values of a PNG file of the size that the camera promised.
///
/// # Errors
/// When the file cannot be decoded, has another size, or has not one channel of 16 bits.
pub(super) fn values_from_png(raw: &RawImage) -> Result<Image<u16>, Invalid> {
    match decode(raw, ImageFormat::Png)? {
        DynamicImage::ImageLuma16(values) => Image::new(raw.width, raw.height, values.into_raw()),
        other => Err(wrong_channels(other.color())),
    }
}

fn wrong_channels(found: ColorType) -> Invalid {
    Invalid::new("pixels of a depth PNG", format!("{found:?}"), "", "one channel of 16 bits")
}

/// Decodes only a file of the promised size: a damaged size would cost memory.
fn decode(raw: &RawImage, format: ImageFormat) -> Result<DynamicImage, Invalid> {
    check_size(raw)?;
    let broken = |error: image::ImageError| {
        Invalid::new(format!("{} image", raw.format), format!("not readable ({error})"), "", "a whole file")
    };
    let decoder = ImageReader::with_format(Cursor::new(&raw.bytes), format).into_decoder().map_err(broken)?;
    let (width, height) = decoder.dimensions();
    if (width as usize, height as usize) != (raw.width, raw.height) {
        let expected = format!("{} x {} as the stream", raw.width, raw.height);
        let place = format!("size of a {} image", raw.format);
        return Err(Invalid::new(place, format!("{width} x {height}"), "px", expected));
    }
    DynamicImage::from_decoder(decoder).map_err(broken)
}
