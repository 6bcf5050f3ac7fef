//! A colour image as bytes: kind, 7 bytes of 0, its time \[s\] in 8 bytes, then a JPEG.

use super::Kind;
use trundle_app::operator::ImageView;

/// The message of an image.
pub fn image_message(image: &ImageView) -> Vec<u8> {
    let mut bytes = vec![Kind::Image as u8, 0, 0, 0, 0, 0, 0, 0];
    bytes.extend(image.stamp.as_secs().to_le_bytes());
    bytes.extend(&image.jpeg);
    bytes
}
