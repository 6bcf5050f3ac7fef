//! Materials of halls, corridors and offices with much or little texture: colour as a function of metres from the face's top left and of
//! `grain`, fractal noise of about unit strength.

use super::color::{Rgb, lifted, mixed, rgb, scaled};
use super::noise::{lattice, value};

/// A wall painted evenly, with almost no features.
pub(super) fn plain(color: [u8; 3], grain: f32) -> Rgb {
    lifted(rgb(color), 2.5 * grain)
}

/// Carpet tiles of 0.5 m: speckled, with faint joints.
pub(super) fn carpet(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let side = 0.5;
    let (column, row) = ((x / side).floor(), (y / side).floor());
    let tone = 0.94 + 0.12 * lattice(seed, column as i32, row as i32);
    let speckle = lattice(seed ^ 17, (x / 0.012).floor() as i32, (y / 0.012).floor() as i32);
    let fleck = if speckle < 0.1 { 15.0 } else { -5.0 * speckle };
    lifted(scaled(rgb(color), tone), fleck + 5.0 * grain)
}

/// Cast concrete: clouds, joints every 5 m, hair cracks, stains of oil.
pub(super) fn concrete(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let field = 5.0;
    let (dx, dy) = (x / field - (x / field).floor(), y / field - (y / field).floor());
    if dx.min(dy) * field < 0.02 {
        return scaled(rgb(color), 0.55);
    }
    let crack =
        (value(seed ^ 31, x / 0.9, y / 0.9) + 0.35 * value(seed ^ 32, x / 0.17, y / 0.17)).abs() < 0.016;
    let stain = value(seed ^ 33, x / 0.6, y / 0.6) + 0.2 * grain;
    let dark = if crack { 0.6 } else { 1.0 - 0.35 * ((stain - 0.72) * 6.0).clamp(0.0, 1.0) };
    lifted(scaled(rgb(color), dark), 7.0 * grain)
}

/// Sheets of corrugated metal: ribs every 0.25 m, a seam every 1.5 m.
pub(super) fn corrugated(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let rib = x / 0.25 - (x / 0.25).floor();
    let shade = 0.86 + 0.28 * (rib - 0.5).abs();
    let sheet = (x / 1.5).floor();
    let tone = 0.96 + 0.08 * lattice(seed, sheet as i32, 0);
    let seam = if x - sheet * 1.5 < 0.012 { 0.7 } else { 1.0 };
    let rust = if value(seed ^ 9, x / 0.3, y / 1.2) > 0.8 { 0.85 } else { 1.0 };
    lifted(scaled(rgb(color), shade * tone * seam * rust), 2.0 * grain)
}

/// Worn floor paint.
pub(super) fn marking(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let worn = value(seed ^ 4, x / 0.12, y / 0.12) + 0.35 * grain;
    mixed(rgb(color), [132.0, 130.0, 124.0], ((worn - 0.35) * 3.0).clamp(0.0, 0.85))
}

/// A steel upright with two rows of slots every 0.075 m.
pub(super) fn slotted(seed: u32, color: [u8; 3], size: (f32, f32), x: f32, y: f32, grain: f32) -> Rgb {
    let along = y / 0.075 - (y / 0.075).floor();
    let across = (x / size.0.max(1e-3) - 0.5).abs();
    let slot = (0.25..0.7).contains(&along) && (0.16..0.34).contains(&across);
    let base = if slot { [26.0, 26.0, 30.0] } else { rgb(color) };
    let scratch = if value(seed, x / 0.03, y / 0.11) > 0.7 { 30.0 } else { 0.0 };
    lifted(base, scratch + 8.0 * grain)
}

/// A stack of packed goods under film: rows of boxes 0.3 x 0.25 m, some with a label, and vertical reflections.
pub(super) fn goods(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let (width, height) = (0.3, 0.25);
    let row = (y / height).floor();
    let column = ((x + 0.15 * (row % 2.0)) / width).floor();
    let (bx, by) = (x + 0.15 * (row % 2.0) - column * width, y - row * height);
    let draw = |k: u32| lattice(seed.wrapping_add(k * 211), column as i32, row as i32);
    if bx.min(by) < 0.006 {
        return scaled(rgb(color), 0.4);
    }
    let (lx, ly) = (0.03 + 0.1 * draw(1), 0.03 + 0.1 * draw(2));
    let labelled = draw(3) < 0.6 && (lx..lx + 0.12).contains(&bx) && (ly..ly + 0.08).contains(&by);
    let printed = labelled && lattice(seed, (x / 0.012).floor() as i32, (y / 0.016).floor() as i32) < 0.4;
    let base = if printed {
        [48.0, 48.0, 56.0]
    } else if labelled {
        [230.0, 226.0, 216.0]
    } else {
        scaled(rgb(color), 0.8 + 0.35 * draw(4))
    };
    let shine = (value(seed ^ 6, x / 0.12, y / 1.1) - 0.4).max(0.0);
    lifted(mixed(base, [236.0, 240.0, 246.0], 0.6 * shine), 8.0 * grain)
}
