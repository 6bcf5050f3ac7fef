//! Materials of furniture: colour as a function of metres from the face's top left and of `grain`, fractal noise of
//! about unit strength.

use super::color::{Rgb, lifted, mixed, pick, rgb, scaled};
use super::noise::{lattice, value};
use super::poster::Poster;
use super::surfaces::timber;

/// A shelf's front: boards 0.3 m apart, between them spines of books, with labels.
pub(super) fn books(seed: u32, x: f32, y: f32, grain: f32) -> Rgb {
    let (pitch, board) = (0.30, 0.025);
    let shelf = (y / pitch).floor();
    let below = y - shelf * pitch;
    if below < board {
        return timber(seed, [150.0, 110.0, 72.0], x, y, grain);
    }
    let (book, across) = spine(seed.wrapping_add(shelf as u32 * 613), x);
    let draw = |k: i32| lattice(seed ^ 21, book * 16 + k, shelf as i32);
    let missing = 0.02 + 0.1 * draw(1);
    if draw(2) < 0.08 || below - board < missing {
        return lifted([34.0, 28.0, 24.0], 12.0 * value(seed, x / 0.03, y / 0.03));
    }
    let cover = scaled(pick(seed ^ shelf as u32, book), 0.7 + 0.5 * draw(3));
    let label = 0.08 + 0.12 * draw(4);
    let on_label = (label..label + 0.05).contains(&(below - board)) && (0.15..0.85).contains(&across);
    let color = if on_label { mixed(cover, [236.0, 230.0, 210.0], 0.8) } else { cover };
    let shade = if across < 0.12 { 0.55 } else { 1.0 };
    lifted(scaled(color, shade), 8.0 * grain)
}

/// The book at `x` in a row, and the position across its spine (0 to 1): three per field of 0.12 m.
fn spine(seed: u32, x: f32) -> (i32, f32) {
    let field = (x / 0.12).floor();
    let t = x / 0.12 - field;
    let first = 0.22 + 0.2 * lattice(seed, field as i32, 1);
    let second = first + 0.2 + 0.2 * lattice(seed, field as i32, 2);
    let (nth, low, high) = match t {
        t if t < first => (0, 0.0, first),
        t if t < second => (1, first, second),
        _ => (2, second, 1.0),
    };
    (field as i32 * 3 + nth, (t - low) / (high - low))
}

/// A carton: brown, a strip of tape, a printed label, stains.
pub(super) fn cardboard(seed: u32, size: (f32, f32), x: f32, y: f32, grain: f32) -> Rgb {
    let draw = |k: i32| lattice(seed, k, 3);
    let (w, h) = (size.0 * (0.35 + 0.35 * draw(1)), size.1 * (0.35 + 0.35 * draw(2)));
    let (left, top) = ((size.0 - w) * draw(3), (size.1 - h) * draw(4));
    if let Some(print) = (Poster { left, top, width: w, height: h, seed: seed ^ 991 }).at(x, y) {
        return print;
    }
    let brown = scaled([178.0, 136.0, 90.0], 0.75 + 0.4 * draw(5));
    let taped = (x - size.0 * (0.3 + 0.4 * draw(6))).abs() < 0.03;
    let color = if taped { mixed(brown, [222.0, 202.0, 160.0], 0.7) } else { brown };
    let stain = if value(seed ^ 2, x / 0.07, y / 0.05) > 0.65 { -38.0 } else { 0.0 };
    lifted(color, stain + 20.0 * grain)
}

/// Woven cloth with patches.
pub(super) fn fabric(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let side = 0.09;
    let (column, row) = ((x / side).floor() as i32, (y / side).floor() as i32);
    let patch = lattice(seed, column, row);
    let base = if patch < 0.3 { mixed(rgb(color), pick(seed, column * 57 + row), 0.75) } else { rgb(color) };
    let weave = if ((x / 0.012).floor() + (y / 0.012).floor()) as i32 % 2 == 0 { 7.0 } else { -7.0 };
    lifted(scaled(base, 0.8 + 0.4 * patch), weave + 13.0 * grain)
}

/// Veneered furniture: timber with a dark border and one or two joints of drawers.
pub(super) fn veneer(seed: u32, color: [u8; 3], size: (f32, f32), x: f32, y: f32, grain: f32) -> Rgb {
    let rim = x.min(y).min(size.0 - x).min(size.1 - y);
    let joint = (y - size.1 * (0.3 + 0.1 * lattice(seed, 1, 1))).abs() < 0.004 && size.1 > 0.3;
    let dark = if rim < 0.008 || joint { 0.4 } else { 1.0 };
    let inlay = value(seed ^ 6, x / 0.14, y / 0.14) > 0.55;
    let tone = if inlay { 0.7 } else { 1.0 };
    timber(seed, scaled(rgb(color), dark * tone), x, y, grain)
}

/// Painted metal: bins, legs; scratches and rings.
pub(super) fn metal(seed: u32, color: [u8; 3], x: f32, y: f32, grain: f32) -> Rgb {
    let ring = if lattice(seed, (y / 0.05).floor() as i32, 2) < 0.35 { 0.6 } else { 1.0 };
    let scratch = if value(seed, x / 0.03, y / 0.09) > 0.7 { 46.0 } else { 0.0 };
    lifted(scaled(rgb(color), ring), scratch + 12.0 * grain)
}
