//! Materials of walls, floors and ceilings: colour as a function of metres from the face's top left and of `grain`,
//! fractal noise of about unit strength.

use super::color::{Rgb, lifted, mixed, pick, rgb, scaled};
use super::noise::{Fractal, lattice, value};

/// Painted plaster, blotchy, with spatters.
pub(super) fn plaster(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let spatter = value(seed ^ 5, x / 0.045, y / 0.045);
    let mark = if spatter > 0.72 { -34.0 } else { 0.0 };
    lifted(rgb(color), 20.0 * grain + mark)
}

/// Wallpaper with a different motif in every field.
pub(super) fn wallpaper(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let side = 0.16;
    let (column, row) = ((x / side).floor(), (y / side).floor());
    let (dx, dy) = (x / side - column - 0.5, y / side - row - 0.5);
    let draw = |k: u32| lattice(seed.wrapping_add(k * 131), column as i32, row as i32);
    let (sx, sy) = (0.12 + 0.3 * draw(1), 0.12 + 0.3 * draw(2));
    let (dx, dy) = (dx + 0.3 * (draw(3) - 0.5), dy + 0.3 * (draw(4) - 0.5));
    let inside = match (draw(5) * 4.0) as u32 {
        0 => dx.abs() < sx && dy.abs() < sy,
        1 => dx * dx / (sx * sx) + dy * dy / (sy * sy) < 1.0,
        2 => dx.abs() / sx + dy.abs() / sy < 1.0,
        _ => dx.abs() < 0.07 && dy.abs() < sy || dy.abs() < 0.07 && dx.abs() < sx,
    };
    let base = lifted(rgb(color), 7.0 * grain);
    if inside { mixed(base, pick(seed, (draw(6) * 1e4) as i32), 0.35 + 0.5 * draw(7)) } else { base }
}

/// Bricks in running bond with different tones, and joints of mortar.
pub(super) fn bricks(seed: u32, x: f32, y: f32, grain: f32) -> Rgb {
    let (length, height, joint) = (0.25, 0.085, 0.012);
    let row = (y / height).floor();
    let shift = length * 0.5 * (row % 2.0) + 0.03 * lattice(seed, row as i32, 5);
    let column = ((x + shift) / length).floor();
    let (bx, by) = (x + shift - column * length, y - row * height);
    if bx < joint || by < joint {
        return lifted([176.0, 168.0, 156.0], 11.0 * grain);
    }
    let tone = lattice(seed, column as i32, row as i32);
    let clay = mixed([112.0, 52.0, 40.0], [206.0, 128.0, 92.0], tone * tone);
    lifted(clay, 15.0 * grain)
}

/// Floor boards along x with different tones and lengths, with grain, gaps and knots.
pub(super) fn boards(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let width = 0.13;
    let row = (y / width).floor();
    let length = 0.9 + 0.6 * lattice(seed, row as i32, 1);
    let along = x + 3.0 * lattice(seed, row as i32, 2);
    let column = (along / length).floor();
    let gap = (y - row * width).min(along - column * length);
    if gap < 0.006 {
        return scaled(rgb(color), 0.3);
    }
    let tone = 0.62 + 0.6 * lattice(seed, column as i32, row as i32 + 7);
    timber(seed ^ (row as u32).wrapping_mul(31), scaled(rgb(color), tone), along, y, grain)
}

/// Fibres of wood, across them; along they are nine times as long.
const FIBRE: Fractal = Fractal { wavelength: 0.03, octaves: 2, gain: 0.75 };

/// Sawn timber with fibres along x and some knots.
pub(super) fn timber(seed: u32, color: Rgb, x: f32, y: f32, grain: f32) -> Rgb {
    let wave = 0.02 * value(seed ^ 3, x / 0.4, y / 0.2);
    let fibre = FIBRE.at(seed, x / 9.0, y + wave);
    let knot = value(seed ^ 8, x / 0.11, y / 0.06);
    let dark = if knot > 0.8 { 0.45 } else { 1.0 };
    lifted(scaled(color, dark), 22.0 * fibre + 11.0 * grain)
}

/// Floor tiles with different tones, some with an inlay.
pub(super) fn tiles(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let side = 0.30;
    let (column, row) = ((x / side).floor(), (y / side).floor());
    let (dx, dy) = (x / side - column, y / side - row);
    if dx.min(dy) < 0.03 {
        return [92.0, 90.0, 88.0];
    }
    let draw = |k: u32| lattice(seed.wrapping_add(k * 173), column as i32, row as i32);
    let base = scaled(rgb(color), 0.72 + 0.4 * draw(1));
    let (px, py) = (dx - 0.3 - 0.4 * draw(2), dy - 0.3 - 0.4 * draw(3));
    let reach = 0.1 + 0.16 * draw(4);
    let inlaid = draw(5) < 0.45
        && if draw(6) < 0.5 { px.abs() + py.abs() < reach } else { px.abs().max(py.abs()) < reach * 0.8 };
    let base = if inlaid { mixed(base, pick(seed, (draw(7) * 1e4) as i32), 0.7) } else { base };
    lifted(base, 18.0 * grain)
}

/// Ceiling boards of 0.6 m with holes and lamps.
pub(super) fn ceiling(seed: u32, x: f32, y: f32, grain: f32) -> Rgb {
    let side = 0.6;
    let (column, row) = ((x / side).floor(), (y / side).floor());
    let (dx, dy) = (x / side - column, y / side - row);
    if dx.min(dy) < 0.03 {
        return [120.0, 120.0, 124.0];
    }
    let draw = |k: u32| lattice(seed.wrapping_add(k * 37), column as i32, row as i32);
    if draw(1) < 0.12 && (0.2..0.85).contains(&dx) && (0.2..0.85).contains(&dy) {
        return [252.0, 250.0, 240.0];
    }
    let hole = value(seed, x / 0.05, y / 0.05) > 0.6;
    let base = 176.0 + 24.0 * draw(2) - if hole { 50.0 } else { 0.0 };
    lifted([base; 3], 14.0 * grain)
}
