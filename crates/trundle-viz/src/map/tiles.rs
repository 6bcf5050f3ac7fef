//! Several map pictures side by side in one PNG.

use super::MapPicture;
use crate::canvas::Canvas;
use crate::color::Color;
use crate::legend::paint_legend;
use crate::text::{TextStyle, line_height};

/// The longer side of a tile, as a part of a picture's own. Source: ours.
const TILE_SIDE_SHARE: f64 = 0.4;
/// The unit of lettering, px. Source: ours.
const LETTER_UNIT_PX: i64 = 2;

/// Pictures in rows of `columns`, each with its title on top, with one legend: as an 8-bit RGB PNG. The tiles have no axes. Equal content
/// gives equal bytes.
pub fn tiles(pictures: &[(String, MapPicture<'_>)], columns: usize) -> Vec<u8> {
    let plots: Vec<Canvas> = pictures.iter().map(|(_, picture)| plot(picture)).collect();
    let columns = columns.clamp(1, plots.len().max(1));
    let (gap, title) = (8 * LETTER_UNIT_PX, line_height(LETTER_UNIT_PX) + 6 * LETTER_UNIT_PX);
    let width = plots.iter().map(Canvas::width).max().unwrap_or(1) + gap;
    let height = plots.iter().map(Canvas::height).max().unwrap_or(1) + title + gap;
    let rows = plots.len().div_ceil(columns) as i64;
    let mut items = Vec::new();
    for item in pictures.iter().flat_map(|(_, picture)| picture.legend()) {
        if !items.contains(&item) {
            items.push(item);
        }
    }
    let whole = width * columns as i64;
    let legend = paint_legend(&items, whole - 2 * gap, LETTER_UNIT_PX);
    let mut canvas = Canvas::new(
        whole.max(legend.width() + gap) + gap,
        rows * height + legend.height() + gap,
        Color::WHITE,
    );
    for (i, (plot, (name, _))) in plots.iter().zip(pictures).enumerate() {
        let (left, top) = (gap + width * (i % columns) as i64, height * (i / columns) as i64);
        canvas.text(left, top + 4 * LETTER_UNIT_PX, name, TextStyle::new(LETTER_UNIT_PX, Color::INK));
        canvas.paste(plot, left, top + title);
        canvas.frame_rect(left, top + title, plot.width(), plot.height(), 1, Color::FAINT_INK);
    }
    canvas.paste(&legend, gap, rows * height);
    canvas.to_png()
}

fn plot(picture: &MapPicture<'_>) -> Canvas {
    let view = picture.view().scaled(TILE_SIDE_SHARE);
    let mut canvas = picture.ground(&view);
    picture.draw_layers(&mut canvas, &view);
    canvas
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LineStyle;
    use trundle_core::Vector2;

    #[test]
    fn tiles_stand_in_rows_with_one_legend() {
        let wall = [Vector2::zeros(), Vector2::new(1.0, 1.0)];
        let picture = MapPicture::blank().polyline("wall", &wall, LineStyle::solid(Color::BLACK));
        let of = |count: usize, columns| tiles(&vec![("one".to_owned(), picture.clone()); count], columns);
        let size = |png: &[u8]| {
            let at = |i: usize| u32::from_be_bytes([png[i], png[i + 1], png[i + 2], png[i + 3]]);
            (at(16), at(20))
        };
        let (one, four) = (size(&of(1, 1)), size(&of(4, 2)));
        assert!(four.0 > 3 * one.0 / 2 && four.1 > 3 * one.1 / 2 && four.1 < 2 * one.1, "{one:?} {four:?}");
    }
}
