//! The built-in typeface of pictures: outlines of Roboto.

use std::sync::LazyLock;
use tiny_skia::{Path, PathBuilder};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// The characters of labels from Roboto Regular. A missing one is drawn as `?`.
const FONT: &[u8] = include_bytes!("../data/roboto-labels.ttf");
/// Height of a capital letter \[units of the font\]. Source: Roboto Regular, table OS/2.
const CAP_HEIGHT: f32 = 1456.0;

static FACE: LazyLock<Face<'static>> =
    LazyLock::new(|| Face::parse(FONT, 0).expect("invariant: the built-in file is a font"));

/// Width of a text whose capitals are `cap_px` high \[px\].
pub(crate) fn width_px(text: &str, cap_px: f32) -> f32 {
    text.chars().map(|character| advance(glyph(character))).sum::<f32>() * cap_px / CAP_HEIGHT
}

/// The letters of a text whose capitals are `cap_px` high; `None` for blanks. The text begins at `start`, on its base line \[px\].
pub(crate) fn outline(text: &str, start: (f32, f32), cap_px: f32) -> Option<Path> {
    let mut pen = Pen { path: PathBuilder::new(), origin: start, scale: cap_px / CAP_HEIGHT };
    for glyph in text.chars().map(glyph) {
        // A blank has no outline.
        _ = FACE.outline_glyph(glyph, &mut pen);
        pen.origin.0 += advance(glyph) * pen.scale;
    }
    pen.path.finish()
}

/// The glyph of a character; that of `?` for a missing one.
fn glyph(character: char) -> GlyphId {
    let character = if character.is_whitespace() { ' ' } else { character };
    FACE.glyph_index(character).or_else(|| FACE.glyph_index('?')).unwrap_or(GlyphId(0))
}

/// Way to the next letter \[units of the font\].
fn advance(glyph: GlyphId) -> f32 {
    f32::from(FACE.glyph_hor_advance(glyph).unwrap_or(0))
}

/// Draws outlines, whose y axis points up, into a path of a picture, whose y axis points down.
struct Pen {
    path: PathBuilder,
    origin: (f32, f32),
    scale: f32,
}

impl Pen {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.origin.0 + self.scale * x, self.origin.1 - self.scale * y)
    }
}

impl OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_printable_ascii_character_and_every_unit_is_drawn() {
        for character in ('!'..='~').chain("°±²µ·×–".chars()) {
            assert!(FACE.glyph_index(character).is_some(), "{character:?} is missing");
            assert!(outline(&character.to_string(), (0.0, 0.0), 7.0).is_some(), "{character:?} is blank");
        }
        assert!(outline(" \n", (0.0, 0.0), 7.0).is_none());
        assert_eq!((glyph('\u{4e00}'), glyph('\t')), (glyph('?'), glyph(' ')));
    }

    #[test]
    fn capitals_have_their_height_and_digits_one_width() {
        let bounds = outline("H", (10.0, 20.0), 14.0).unwrap().bounds();
        assert!((bounds.top() - 6.0).abs() < 0.01 && (bounds.bottom() - 20.0).abs() < 0.01, "{bounds:?}");
        let widths: Vec<f32> = ('0'..='9').map(|digit| width_px(&digit.to_string(), 14.0)).collect();
        assert!(widths.iter().all(|width| *width == widths[0]), "{widths:?}");
    }
}
