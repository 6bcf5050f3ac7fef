//! Width and height of a camera's images in YAML files.

use crate::IoError;
use crate::yaml_document::YamlDocument;
use trundle_core::Invalid;

/// Longest side of an image \[px\]. A file with a longer one is refused. Source: ours.
const MAX_IMAGE_SIDE_PX: f64 = 65_536.0;

/// A side of the image, by the first of its names that exists, px.
pub(super) fn image_side(document: &YamlDocument<'_>, names: &[&str]) -> Result<usize, IoError> {
    let name = document.first_of(names);
    whole_side(document, name, document.number(name, "the size of the images, px")?)
}

/// The side with this name and value, px.
pub(super) fn whole_side(document: &YamlDocument<'_>, name: &str, value: f64) -> Result<usize, IoError> {
    let is_side = (1.0..=MAX_IMAGE_SIDE_PX).contains(&value) && value.fract() == 0.0;
    let wrong = || {
        document.invalid(Invalid::new(
            name,
            value,
            "px",
            format!("a whole number from 1 to {MAX_IMAGE_SIDE_PX}"),
        ))
    };
    if is_side { Ok(value as usize) } else { Err(wrong()) }
}
