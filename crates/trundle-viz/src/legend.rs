//! Legends: marks, labels and their drawing.

use crate::canvas::{Canvas, Pen};
use crate::color::Color;
use crate::map::{draw_badge, radius_of};
use crate::text::{TextStyle, cap_height, line_height, text_width};
use crate::wedge::wedge;

/// The sign of an entry in a legend.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// A solid line.
    Line,
    /// A line with a head.
    Arrow,
    /// A number in a circle.
    Badge,
    /// An empty box: an outline.
    Outline,
    /// A dashed line.
    Dashes,
    /// A filled dot.
    Dot,
    /// A circle.
    Ring,
    /// The wedge of a pose.
    Wedge,
    /// A translucent band.
    Band,
    /// A filled cell with a border.
    Cell,
}

/// A line of a legend: the meaning of a colour and a mark.
#[derive(Debug, Clone, PartialEq)]
pub struct LegendItem {
    /// The text.
    pub label: String,
    /// Colour in the picture.
    pub color: Color,
    /// Sign of the entry.
    pub mark: Mark,
}

impl LegendItem {
    /// A legend line.
    pub fn new(label: impl Into<String>, color: Color, mark: Mark) -> Self {
        Self { label: label.into(), color, mark }
    }
}

/// Width of a mark in dots of the typeface. Source: ours.
const MARK_DOTS: i64 = 14;
/// Space between two items, in dots. Source: ours.
const GAP_DOTS: i64 = 12;

/// A legend on white, `width` px wide at least, wrapped as text is.
pub(crate) fn paint_legend(items: &[LegendItem], width: i64, scale: i64) -> Canvas {
    let item_width = |item: &LegendItem| (MARK_DOTS + 5) * scale + text_width(&item.label, scale);
    let width = items.iter().map(item_width).max().unwrap_or(0).max(width);
    let pitch = line_height(scale) + 5 * scale;
    let (mut places, mut x, mut row) = (Vec::new(), 0, 0);
    for item in items {
        if x > 0 && x + item_width(item) > width {
            (x, row) = (0, row + 1);
        }
        places.push((x, row * pitch));
        x += item_width(item) + GAP_DOTS * scale;
    }
    let rows = if items.is_empty() { 0 } else { row + 1 };
    let mut canvas = Canvas::new(width, rows * pitch, Color::WHITE);
    for (item, (x, y)) in items.iter().zip(places) {
        paint_mark(&mut canvas, item, (x, y + 2 * scale), scale);
        canvas.text(
            x + (MARK_DOTS + 5) * scale,
            y + 2 * scale,
            &item.label,
            TextStyle::new(scale, Color::INK),
        );
    }
    canvas
}

/// A mark as tall as the text, its upper left corner at a place.
fn paint_mark(canvas: &mut Canvas, item: &LegendItem, (x, y): (i64, i64), scale: i64) {
    let (s, color) = (scale as f64, item.color);
    let (left, right) = (x as f64 + s, (x + MARK_DOTS * scale) as f64 - s);
    let (width, height) = (MARK_DOTS * scale, cap_height(scale));
    let middle = y as f64 + height as f64 / 2.0;
    let center = ((left + right) / 2.0, middle);
    match item.mark {
        Mark::Line => canvas.polyline([(left, middle), (right, middle)], Pen::solid(color, 2.0 * s)),
        Mark::Arrow => {
            canvas.polyline([(left, middle), (right - 4.0 * s, middle)], Pen::solid(color, 1.5 * s));
            let foot = |side: f64| (right - 5.0 * s, middle + 3.0 * s * side);
            canvas.polygon(&[(right, middle), foot(1.0), foot(-1.0)], color);
        }
        Mark::Badge => draw_badge(canvas, center, radius_of("1", scale), "1", scale, color),
        Mark::Outline => {
            let line = Pen::solid(color, 1.3 * s);
            let (low, high) = (middle - 3.0 * s, middle + 3.0 * s);
            canvas.polyline([(left, low), (right, low), (right, high), (left, high), (left, low)], line);
        }
        Mark::Dashes => {
            let pen = Pen { color, width: 2.0 * s, dash: Some(2.4 * s) };
            canvas.polyline([(left, middle), (right, middle)], pen);
        }
        Mark::Dot => canvas.dot(center, 2.5 * s, color.alpha(color.a.max(200))),
        Mark::Ring => canvas.ring(center, 3.5 * s, 1.5 * s, color),
        Mark::Wedge => canvas.polygon(&wedge(center, 6.0 * s, 0.0), color),
        Mark::Band => canvas.fill_rect(x, y, width, height, color),
        Mark::Cell => {
            canvas.fill_rect(x + 3 * scale, y, 8 * scale, height, color);
            canvas.frame_rect(x + 3 * scale, y, 8 * scale, height, (scale / 2).max(1), Color::FAINT_INK);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_wraps_and_shows_every_item() {
        let items: Vec<_> = [
            Mark::Line,
            Mark::Arrow,
            Mark::Badge,
            Mark::Outline,
            Mark::Dashes,
            Mark::Dot,
            Mark::Ring,
            Mark::Wedge,
            Mark::Band,
            Mark::Cell,
        ]
        .map(|mark| LegendItem::new("something", Color::BLUE, mark))
        .into();
        let wide = paint_legend(&items, 2000, 2);
        let narrow = paint_legend(&items, 10, 2);
        assert_eq!(narrow.height(), items.len() as i64 * wide.height());
        for row in 0..items.len() as i64 {
            let band = row * wide.height()..(row + 1) * wide.height();
            assert!(
                band.clone().any(|y| (0..28).any(|x| narrow.at(x, y) != [255; 3])),
                "mark {row} is missing"
            );
        }
        assert_eq!(paint_legend(&[], 50, 2).height(), 1);
    }
}
