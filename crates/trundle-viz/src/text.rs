//! Lettering on a canvas with the built-in typeface.

use crate::canvas::{Canvas, Pen};
use crate::color::Color;
use crate::font::{outline, width_px};

/// Height of a capital letter in dots. Source: ours.
const CAP_DOTS: i64 = 7;
/// Depth of the letters below the base line in dots. Source: ours, for the typeface's brackets.
const DESCENT_DOTS: i64 = 3;

/// Style of a text.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TextStyle {
    /// Pixels a dot; a capital letter is 7 dots high.
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
    CAP_DOTS * scale
}

/// Height of a line of text with descenders, px.
pub(crate) fn line_height(scale: i64) -> i64 {
    (CAP_DOTS + DESCENT_DOTS) * scale
}

/// Width of a text, px.
pub(crate) fn text_width(text: &str, scale: i64) -> i64 {
    width_px(text, cap_height(scale) as f32).ceil() as i64
}

impl Canvas {
    /// Sets a text whose upper left corner is at (x, y).
    pub(crate) fn text(&mut self, x: i64, y: i64, text: &str, style: TextStyle) {
        let cap = cap_height(style.scale);
        let is_near = |at: i64, side: i64| (-4 * side..4 * side).contains(&at);
        if !is_near(x, self.width()) || !is_near(y, self.height()) {
            return;
        }
        let Some(letters) = outline(text, (x as f32, (y + cap) as f32), cap as f32) else { return };
        if let Some(halo) = style.halo {
            self.stroke(&letters, Pen::solid(halo, 2.0 * style.scale.max(2) as f64));
        }
        self.fill(&letters, style.color);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns and rows with ink: first and last of each.
    fn inked(canvas: &Canvas) -> [i64; 4] {
        let is_inked = |x, y| canvas.at(x, y)[0] < 128;
        let columns: Vec<i64> = (0..100).filter(|&x| (0..40).any(|y| is_inked(x, y))).collect();
        let rows: Vec<i64> = (0..40).filter(|&y| (0..100).any(|x| is_inked(x, y))).collect();
        [columns[0], columns[columns.len() - 1], rows[0], rows[rows.len() - 1]]
    }

    #[test]
    fn text_fills_its_width_and_its_lines() {
        let scale = 2;
        let drawn = |text: &str| {
            let mut canvas = Canvas::new(100, 40, Color::WHITE);
            canvas.text(10, 5, text, TextStyle::new(scale, Color::BLACK));
            inked(&canvas)
        };
        let [left, right, top, bottom] = drawn("Hamburg");
        assert!((10..13).contains(&left) && right < 10 + text_width("Hamburg", scale), "{left} {right}");
        assert!(right > 10 + text_width("Hamburg", scale) - 4, "{right}");
        assert!((4..=5).contains(&top), "the b is a little higher than a capital: {top}");
        assert!(bottom > 5 + cap_height(scale) && bottom < 5 + line_height(scale), "{bottom}");
        let [.., bottom] = drawn("(1 m)");
        assert!(bottom < 5 + line_height(scale), "{bottom}");
    }

    #[test]
    fn a_halo_surrounds_the_letters_and_far_text_is_left_out() {
        let mut canvas = Canvas::new(40, 40, Color::WHITE);
        let blank = canvas.to_png();
        canvas.text(i64::MAX / 4, 3, "far", TextStyle::new(2, Color::BLACK));
        assert_eq!(canvas.to_png(), blank);
        canvas.text(10, 10, "I", TextStyle { halo: Some(Color::BLUE), ..TextStyle::new(2, Color::BLACK) });
        let row: Vec<[u8; 3]> = (0..40).map(|x| canvas.at(x, 17)).collect();
        let black = row.iter().position(|pixel| *pixel == [0; 3]).unwrap();
        assert_eq!(row[black - 2], [Color::BLUE.r, Color::BLUE.g, Color::BLUE.b]);
        assert_eq!(row[black - 6], [255; 3]);
    }
}
