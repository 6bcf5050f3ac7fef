//! Lettering on a canvas with the built-in typeface.

use crate::canvas::Canvas;
use crate::color::Color;
use crate::font::{DESCENT_ROWS, HEIGHT, glyph};

/// Style of a text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextStyle {
    /// Pixels a dot of the typeface.
    pub scale: i64,
    pub color: Color,
    /// Colour of a border around the letters, for text on a busy ground.
    pub halo: Option<Color>,
}

impl TextStyle {
    pub(crate) fn new(scale: i64, color: Color) -> Self {
        Self { scale: scale.max(1), color, halo: None }
    }
}

/// Height of a line of text without descenders, px.
pub(crate) fn cap_height(scale: i64) -> i64 {
    HEIGHT as i64 * scale
}

/// Height of a line of text with descenders, px.
pub(crate) fn line_height(scale: i64) -> i64 {
    (HEIGHT + DESCENT_ROWS) as i64 * scale
}

/// Width of a text, px.
pub(crate) fn text_width(text: &str, scale: i64) -> i64 {
    let dots: usize = text.chars().map(|c| glyph(c).width + 1).sum();
    (dots as i64 - 1).max(0) * scale
}

impl Canvas {
    /// Sets a text whose upper left corner is at (x, y).
    pub(crate) fn text(&mut self, x: i64, y: i64, text: &str, style: TextStyle) {
        if let Some(halo) = style.halo {
            let rim = style.scale.max(2);
            for (dx, dy) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
                self.letters(x + dx * rim, y + dy * rim, text, style.scale, halo);
            }
        }
        self.letters(x, y, text, style.scale, style.color);
    }

    fn letters(&mut self, x: i64, y: i64, text: &str, scale: i64, color: Color) {
        let mut left = x;
        for glyph in text.chars().map(glyph) {
            for (row, bits) in glyph.rows.iter().enumerate() {
                for column in
                    (0..glyph.width).filter(|column| bits >> (crate::font::WIDTH - 1 - column) & 1 == 1)
                {
                    let top = y + (row + glyph.drop) as i64 * scale;
                    self.fill_rect(left + column as i64 * scale, top, scale, scale, color);
                }
            }
            left += (glyph.width as i64 + 1) * scale;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_has_its_reported_width() {
        let (text, scale) = ("1 m gj", 2);
        let mut canvas = Canvas::new(100, 30, Color::WHITE);
        canvas.text(10, 5, text, TextStyle::new(scale, Color::BLACK));
        let inked = |x: i64| (0..30).any(|y| canvas.at(x, y) == [0; 3]);
        let last = (0..100).rev().find(|&x| inked(x)).unwrap();
        assert_eq!(last + 1, 10 + text_width(text, scale));
        let lowest = (0..30).rev().find(|&y| (0..100).any(|x| canvas.at(x, y) == [0; 3])).unwrap();
        assert_eq!(lowest + 1, 5 + line_height(scale));
    }
}
