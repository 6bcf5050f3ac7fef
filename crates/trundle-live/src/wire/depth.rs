//! A depth image as bytes.
//!
//! | bytes | content |
//! |---|---|
//! | 1, 1 | kind; 0 |
//! | 2 | width \[px\] |
//! | 1 each | depth of a pixel \[4 cm\], row by row; 0: not measured |

use super::Kind;
use trundle_app::operator::DepthPicture;

/// The message of a depth image.
pub fn depth_message(depth: &DepthPicture) -> Vec<u8> {
    let mut bytes = vec![Kind::Depth as u8, 0];
    bytes.extend((depth.width as u16).to_le_bytes());
    bytes.extend(&depth.pixels);
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn width_and_pixels_are_sent() {
        let depth = DepthPicture { width: 2, pixels: vec![0, 50, 255, 1] };
        assert_eq!(depth_message(&depth), [8, 0, 2, 0, 0, 50, 255, 1]);
    }
}
