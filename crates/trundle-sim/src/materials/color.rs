//! Colours, the palette, and changes of brightness.

use super::noise::lattice;

/// Red, green, blue, 0 to 255, sRGB.
pub(super) type Rgb = [f32; 3];

/// Strong, different colours that prints and toys have. Source: ours.
const PALETTE: [[u8; 3]; 12] = [
    [196, 52, 44],
    [38, 84, 156],
    [240, 196, 60],
    [44, 122, 78],
    [30, 32, 40],
    [238, 234, 222],
    [226, 122, 46],
    [112, 62, 130],
    [70, 160, 176],
    [160, 40, 86],
    [122, 92, 62],
    [150, 176, 60],
];

pub(super) fn rgb(color: [u8; 3]) -> Rgb {
    color.map(f32::from)
}

/// A colour of the palette by hash.
pub(super) fn pick(seed: u32, n: i32) -> Rgb {
    rgb(PALETTE[(lattice(seed, n, 977) * PALETTE.len() as f32) as usize])
}

/// `color` made brighter (above 1) or darker.
pub(super) fn scaled(color: Rgb, factor: f32) -> Rgb {
    color.map(|c| c * factor)
}

/// `color` with `step` grey levels added.
pub(super) fn lifted(color: Rgb, step: f32) -> Rgb {
    color.map(|c| c + step)
}

/// A mixture of two colours with the fraction `part` of the second.
pub(super) fn mixed(a: Rgb, b: Rgb, part: f32) -> Rgb {
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * part)
}

/// The colour as a texel, `0x00BBGGRR`.
pub(super) fn packed(color: Rgb) -> u32 {
    let [r, g, b] = color.map(|c| (c + 0.5).clamp(0.0, 255.0) as u32);
    r | g << 8 | b << 16
}
