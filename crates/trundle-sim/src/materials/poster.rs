//! Prints on walls, doors and cartons.

use super::color::{Rgb, lifted, mixed, pick, scaled};
use super::noise::{Fractal, lattice};

/// A print on a wall, a door or a carton: a rectangle in metres from the face's top left, and its content.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Poster {
    pub(super) left: f32,
    pub(super) top: f32,
    pub(super) width: f32,
    pub(super) height: f32,
    pub(super) seed: u32,
}

impl Poster {
    /// Whether the row at `y` may run over the print.
    pub(super) fn crosses(&self, y: f32) -> bool {
        (-1e-3..=self.height + 1e-3).contains(&(y - self.top))
    }

    /// The print's colour at a point of the face; `None` outside the print.
    pub(super) fn at(&self, x: f32, y: f32) -> Option<Rgb> {
        let (x, y) = (x - self.left, y - self.top);
        let edge = x.min(y).min(self.width - x).min(self.height - y);
        if edge < 0.0 {
            return None;
        }
        if edge < 0.015 {
            return Some(scaled(pick(self.seed, 1), 0.35));
        }
        let (u, v) = (x / self.width, y / self.height);
        Some(match (lattice(self.seed, 0, 0) * 4.0) as u32 {
            0 => self.shapes(u, v),
            1 => self.photograph(x, y),
            2 => self.page(x, y),
            _ => self.mosaic(x, y),
        })
    }

    /// Overlapping rectangles and discs.
    fn shapes(&self, u: f32, v: f32) -> Rgb {
        let mut color = lifted(pick(self.seed, 2), 30.0);
        for i in 0..14 {
            let draw = |k| lattice(self.seed, i, k);
            let (dx, dy) = (u - draw(2), v - draw(3));
            let (w, h) = (0.06 + 0.2 * draw(4), 0.05 + 0.18 * draw(5));
            let inside = if draw(6) < 0.6 {
                dx.abs() < w && dy.abs() < h
            } else {
                dx * dx / (w * w) + dy * dy / (h * h) < 1.0
            };
            if inside {
                color = pick(self.seed, i + 10);
            }
        }
        color
    }

    /// Clouds of two colours with some hard edges.
    fn photograph(&self, x: f32, y: f32) -> Rgb {
        let coarse = Fractal { wavelength: 0.22, octaves: 5, gain: 0.65 }.at(self.seed, x, y);
        let fine = Fractal { wavelength: 0.09, octaves: 4, gain: 0.7 }.at(self.seed ^ 77, x, y);
        let base = if coarse > 0.15 { pick(self.seed, 3) } else { pick(self.seed, 4) };
        lifted(mixed(base, pick(self.seed, 5), (fine * 0.5 + 0.4).clamp(0.0, 1.0)), 40.0 * fine)
    }

    /// Lines of words: dark blocks of uneven length on light paper, a heading above.
    fn page(&self, x: f32, y: f32) -> Rgb {
        let paper = [232.0, 228.0, 214.0];
        let heading = y < 0.12;
        let (line, letter) = if heading { (0.08, 0.05) } else { (0.032, 0.018) };
        let (row, column) = ((y / line).floor(), (x / letter).floor());
        let is_ink = y - row * line < 0.65 * line
            && x - column * letter < 0.85 * letter
            && lattice(self.seed, column as i32, row as i32 + 50) < 0.7;
        if !is_ink {
            paper
        } else if heading {
            pick(self.seed, 6)
        } else {
            [40.0, 40.0, 46.0]
        }
    }

    /// Uneven coloured tesserae.
    fn mosaic(&self, x: f32, y: f32) -> Rgb {
        let side = 0.03 + 0.05 * lattice(self.seed, 7, 7);
        let row = (y / side).floor() as i32;
        let column = ((x + side * lattice(self.seed, row, 31)) / side).floor() as i32;
        lifted(pick(self.seed ^ row as u32, column), 25.0 * (lattice(self.seed, column, row) - 0.5))
    }
}

/// Prints spread over a face without overlap: one at most in each field of about 0.9 x 0.8 m, `share` of the fields.
pub(super) fn spread(seed: u32, (width, height): (f32, f32), share: f32) -> Vec<Poster> {
    let (columns, rows) = ((width / 0.9).floor().max(1.0) as i32, (height / 0.8).floor().max(1.0) as i32);
    let (field_w, field_h) = (width / columns as f32, height / rows as f32);
    let mut posters = Vec::new();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let draw = |k: i32| lattice(seed.wrapping_add(k as u32 * 7919), column, row);
        if draw(0) > share {
            continue;
        }
        let (w, h) = (field_w * (0.35 + 0.5 * draw(1)), field_h * (0.35 + 0.5 * draw(2)));
        posters.push(Poster {
            left: field_w * column as f32 + (field_w - w) * draw(3),
            top: field_h * row as f32 + (field_h - h) * draw(4),
            width: w,
            height: h,
            seed: seed ^ (draw(5) * 4e9) as u32,
        });
    }
    posters
}
