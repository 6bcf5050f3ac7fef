//! Decoding of glTF textures.

use super::buffers::Buffers;
use super::schema::at;
use crate::import::ImportFault;
use gltf::json::{Index, image as file};
use image::ImageReader;
use std::borrow::Cow;
use std::io::Cursor;
use trundle_core::ColorImage;

/// Longest side of a texture, px. Source: ours.
const MAX_PIXELS: u32 = 16_384;

/// Maximum memory for decoding a texture, bytes. Source: ours.
const MAX_MEMORY: u64 = 1 << 30;

/// Decodes an image, PNG or JPEG; alpha is left out.
pub(super) fn decode(buffers: &Buffers<'_>, index: Index<file::Image>) -> Result<ColorImage, ImportFault> {
    let image = at(&buffers.root().images, index, "images")?;
    let item = name_of(image, index);
    let bytes = match (image.buffer_view, &image.uri) {
        (Some(view), _) => Cow::Borrowed(buffers.view(view)?),
        (None, Some(uri)) => Cow::Owned(buffers.fetch(&format!("image {index}"), uri)?),
        (None, None) => return Err(ImportFault::part(item, "has neither a file nor a bufferView")),
    };
    let rgb = decode_bytes(&bytes).map_err(|error| ImportFault::part(item, problem(&bytes, &error)))?;
    let (width, height) = (rgb.width() as usize, rgb.height() as usize);
    Ok(ColorImage::new(width, height, rgb.pixels().map(|pixel| pixel.0).collect())?)
}

fn decode_bytes(bytes: &[u8]) -> image::ImageResult<image::RgbImage> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAX_PIXELS);
    limits.max_image_height = Some(MAX_PIXELS);
    limits.max_alloc = Some(MAX_MEMORY);
    reader.limits(limits);
    Ok(reader.decode()?.into_rgb8())
}

/// The fault of an image.
fn problem(bytes: &[u8], error: &image::ImageError) -> String {
    let known: [(&[u8], &str); 3] = [(b"RIFF", "WebP"), (b"\xabKTX", "KTX2"), (b"DDS ", "DDS")];
    let found = known.iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, name)| *name);
    match (found, error) {
        (Some(name), _) => format!("is {name}, expected PNG or JPEG"),
        (None, image::ImageError::Limits(_)) => {
            format!("is too large, expected at most {MAX_PIXELS} px a side")
        }
        _ => "cannot be decoded, expected a whole PNG or JPEG".to_owned(),
    }
}

fn name_of(image: &file::Image, index: Index<file::Image>) -> String {
    let uri = image.uri.as_deref().filter(|uri| !uri.starts_with("data:"));
    match image.name.as_deref().or(uri) {
        Some(name) => format!("image {index} ('{name}')"),
        None => format!("image {index}"),
    }
}
