//! Decoding of glTF textures.

use super::buffers::Buffers;
use super::schema::at;
use crate::import::ImportFault;
use gltf::json::{Index, image as file};
use image::ImageReader;
use std::io::Cursor;
use trundle_core::ColorImage;

/// Longest side of a texture, px.
const MOST_PIXELS: u32 = 16_384;

/// Most memory for decoding a texture, bytes.
const MOST_MEMORY: u64 = 1 << 30;

/// Decodes an image, PNG or JPEG; alpha is left out.
pub(super) fn decode(buffers: &Buffers<'_>, index: Index<file::Image>) -> Result<ColorImage, ImportFault> {
    let image = at(&buffers.root().images, index, "images")?;
    let item = name_of(image, index);
    let rgb = match (image.buffer_view, &image.uri) {
        (Some(view), _) => decode_bytes(buffers.view(view)?),
        (None, Some(uri)) => decode_bytes(&buffers.fetch(&format!("image {index}"), uri)?),
        (None, None) => return Err(ImportFault::part(item, "has neither a file nor a bufferView")),
    };
    let rgb = rgb.map_err(|e| ImportFault::part(item, format!("cannot be decoded: {e}")))?;
    let (width, height) = (rgb.width() as usize, rgb.height() as usize);
    Ok(ColorImage::new(width, height, rgb.pixels().map(|pixel| pixel.0).collect())?)
}

fn decode_bytes(bytes: &[u8]) -> image::ImageResult<image::RgbImage> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MOST_PIXELS);
    limits.max_image_height = Some(MOST_PIXELS);
    limits.max_alloc = Some(MOST_MEMORY);
    reader.limits(limits);
    Ok(reader.decode()?.into_rgb8())
}

fn name_of(image: &file::Image, index: Index<file::Image>) -> String {
    let uri = image.uri.as_deref().filter(|uri| !uri.starts_with("data:"));
    match image.name.as_deref().or(uri) {
        Some(name) => format!("image {index} ('{name}')"),
        None => format!("image {index}"),
    }
}
