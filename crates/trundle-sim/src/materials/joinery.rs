//! Doors, windows, signs and kitchens, fitted to the size of their face: colour as a function of metres from the face's top left and of
//! `grain`, fractal noise of about unit strength.

use super::color::{Rgb, lifted, mixed, pick, rgb, scaled};
use super::noise::{Fractal, lattice};
use super::surfaces::timber;

/// A door's leaf: a frame, two panels, a handle of metal.
pub(super) fn door(seed: u32, color: [u8; 3], size: (f32, f32), x: f32, y: f32, grain: f32) -> Rgb {
    if size.0 < 0.3 || size.1 < 0.5 {
        return timber(seed, rgb(color), x, y, grain);
    }
    let handle = (x - 0.07).abs() < 0.02 && (y - 0.48 * size.1).abs() < 0.08;
    let lever = (0.06..0.2).contains(&x) && (y - 0.46 * size.1).abs() < 0.012;
    if handle || lever {
        return [206.0, 206.0, 210.0];
    }
    let (half, middle) = (0.5 * size.0, 0.55 * size.1);
    let (low, high) = if y < middle { (0.0, middle) } else { (middle, size.1) };
    let inset = (half - (x - half).abs()).min(y - low).min(high - y);
    let shade = match inset {
        i if (0.12..0.135).contains(&i) => 0.6,
        i if i >= 0.135 => 0.92,
        _ => 1.0,
    };
    timber(seed, scaled(rgb(color), shade), y, x, grain)
}

/// A window by day: frame, cross bar, hills under a sky.
pub(super) fn window(seed: u32, size: (f32, f32), x: f32, y: f32, grain: f32) -> Rgb {
    let rim = x.min(y).min(size.0 - x).min(size.1 - y);
    if rim < 0.06 || (x - size.0 / 2.0).abs() < 0.025 {
        return lifted([226.0, 226.0, 222.0], 3.0 * grain);
    }
    let hills = Fractal { wavelength: 0.5, octaves: 4, gain: 0.5 };
    let horizon = size.1 * (0.55 + 0.12 * hills.at(seed, x, 0.0));
    let near = size.1 * (0.75 + 0.1 * hills.at(seed ^ 7, x, 1.0));
    if y > near {
        lifted([74.0, 104.0, 58.0], 22.0 * grain)
    } else if y > horizon {
        lifted([116.0, 136.0, 128.0], 9.0 * grain)
    } else {
        let cloud = Fractal { wavelength: 0.7, octaves: 4, gain: 0.6 }.at(seed ^ 3, x, 2.0 * y);
        mixed([150.0, 190.0, 232.0], [246.0, 246.0, 248.0], (cloud * 0.8 + 0.2).clamp(0.0, 1.0))
    }
}

/// A sign: a coloured board with a light border and a glyph of blocks, the same for the same seed.
pub(super) fn sign(seed: u32, color: [u8; 3], size: (f32, f32), x: f32, y: f32) -> Rgb {
    let rim = x.min(y).min(size.0 - x).min(size.1 - y);
    let border = 0.08 * size.0.min(size.1);
    if (0.4 * border..border).contains(&rim) {
        return [240.0, 240.0, 236.0];
    }
    let cell = size.1 / 9.0;
    let columns = (size.0 / cell).floor() as i32;
    let (column, row) = ((x / cell).floor() as i32, (y / cell).floor() as i32);
    let inside = (2..columns - 2).contains(&column) && (2..7).contains(&row);
    // Letters are three cells wide with one between them.
    let inked = inside && (column - 2) % 4 != 3 && lattice(seed, column, row) < 0.6;
    if inked { [240.0, 240.0, 236.0] } else { rgb(color) }
}

/// Fitted kitchen fronts 0.6 m wide with a drawer above and a rail each.
pub(super) fn fronts(seed: u32, color: [u8; 3], size: (f32, f32), x: f32, y: f32, grain: f32) -> Rgb {
    let width = size.0 / (size.0 / 0.6).round().max(1.0);
    let across = x - (x / width).floor() * width;
    let drawer = (0.2 * size.1).max(0.12);
    let joint = across.min(width - across) < 0.005 || (y - drawer).abs() < 0.004;
    let rail = (across - width / 2.0).abs() < 0.1
        && ((y - drawer * 0.5).abs() < 0.008 || (y - drawer - 0.05).abs() < 0.008);
    if y > size.1 - 0.08 || joint {
        return [52.0, 50.0, 48.0];
    }
    if rail {
        [186.0, 188.0, 192.0]
    } else {
        lifted(rgb(color), 4.0 * grain + 3.0 * lattice(seed, (x / width) as i32, 1))
    }
}

/// A screen that is on: a window or two with lines of text.
pub(super) fn screen(seed: u32, size: (f32, f32), x: f32, y: f32) -> Rgb {
    let rim = x.min(y).min(size.0 - x).min(size.1 - y);
    if rim < 0.015 {
        return [22.0, 22.0, 24.0];
    }
    let (u, v) = (x / size.0, y / size.1);
    let draw = |k: i32| lattice(seed, k, 5);
    let split = 0.3 + 0.3 * draw(1);
    let pane = i32::from(u > split);
    let row = (v * 24.0).floor() as i32;
    let length = 0.1 + 0.8 * lattice(seed ^ 11, row, pane);
    let along = if pane == 0 { u / split } else { (u - split) / (1.0 - split) };
    let line = v * 24.0 - row as f32;
    if row < 2 {
        pick(seed, 3 + pane)
    } else if (0.25..0.75).contains(&line) && (0.08..0.08 + length).contains(&along) {
        [96.0, 128.0, 120.0]
    } else {
        [34.0, 38.0, 46.0]
    }
}
