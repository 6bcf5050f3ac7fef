//! Pictures: maps, colour and depth.

use super::text::SMALL_PGM;
use trundle::core::{ColorImage, DepthImage};
use trundle::io::{encode_color, encode_color_png, encode_depth};

/// PGM in binary and as text, and a PNG.
pub fn map_picture() -> Vec<Vec<u8>> {
    let wide = [b"P5 # by hand\n2 2\n65535\n".as_slice(), &[0, 0, 255, 255, 1, 2, 3, 4]].concat();
    let pictures = [SMALL_PGM.to_vec(), b"P2\n2 2\n255\n0 254\n205 0\n".to_vec(), wide];
    pictures.into_iter().chain([small_png(), small_bmp()]).collect()
}

/// A JPEG and a PNG.
pub fn color_image() -> Vec<Vec<u8>> {
    let jpeg = encode_color(&colors(24, 16), 90).expect("invariant: the image has a size");
    vec![jpeg, small_png()]
}

/// A 16-bit PNG.
pub fn depth_image() -> Vec<Vec<u8>> {
    let image = DepthImage::from_fn(20, 10, |x, y| (x + y) as f32 * 0.1);
    vec![encode_depth(&image).expect("invariant: the image has a size")]
}

/// Depth as 16-bit PNG, 16-bit PGM and 32-bit TIFF.
pub fn depth_file() -> Vec<Vec<u8>> {
    let pgm = [b"P5\n2 2\n65535\n".as_slice(), &[0, 0, 19, 136, 39, 16, 58, 152]].concat();
    depth_image().into_iter().chain([pgm, small_tiff()]).collect()
}

/// A TIFF of 2 x 2 px, floats, without compression.
fn small_tiff() -> Vec<u8> {
    let entry = |tag: u16, kind: u16, value: u32| {
        [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &1_u32.to_le_bytes(), &value.to_le_bytes()].concat()
    };
    let size_and_format = [(256, 3, 2), (257, 3, 2), (258, 3, 32), (259, 3, 1), (262, 3, 1)];
    let strip_and_kind = [(273, 4, 134), (277, 3, 1), (278, 3, 2), (279, 4, 16), (339, 3, 3)];
    let entries = size_and_format
        .into_iter()
        .chain(strip_and_kind)
        .flat_map(|(tag, kind, value)| entry(tag, kind, value));
    let mut bytes = [b"II*\0".as_slice(), &8_u32.to_le_bytes(), &10_u16.to_le_bytes()].concat();
    bytes.extend(entries.chain([0; 4]));
    bytes.extend([1.0_f32, 1.5, 0.0, 2.25].iter().flat_map(|depth| depth.to_le_bytes()));
    bytes
}

pub(crate) fn small_png() -> Vec<u8> {
    encode_color_png(&colors(8, 6)).expect("invariant: the image has a size")
}

/// A BMP of 2 x 2 px, 24 bits.
fn small_bmp() -> Vec<u8> {
    let head = [70_u32, 0, 54, 40, 2, 2, 0x0018_0001, 0, 16, 2835, 2835, 0, 0].map(u32::to_le_bytes);
    [b"BM".as_slice(), head.as_flattened(), &[0, 0, 0, 255, 255, 255, 0, 0, 205, 205, 205, 0, 0, 0, 0, 0]]
        .concat()
}

fn colors(width: usize, height: usize) -> ColorImage {
    ColorImage::from_fn(width, height, |x, y| [(x * 9) as u8, (y * 13) as u8, (x * y) as u8])
}
