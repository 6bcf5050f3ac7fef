//! Dark pixels by comparison with the light and dark ones around them.

use crate::board::smooth_image::SmoothImage;

/// Side of a tile, px. Source: ours.
const TILE_PX: usize = 4;
/// Radii of the windows, tiles: the smallest with enough contrast counts. Source: ours.
const WINDOW_RADII_TILES: [usize; 4] = [2, 4, 8, 16];
/// Smallest contrast of a window, grey values: more than noise. Source: ours.
const MIN_CONTRAST: f32 = 20.0;
/// Threshold between dark, 0, and light, 1, of a window: below the middle, which parts dark squares that touch at a corner. Source: ours.
const DARK_RATIO: f32 = 0.4;

/// Smallest and largest grey value.
type Range = (f32, f32);

/// Whether each pixel is dark, by rows.
pub(super) fn dark_mask(image: &SmoothImage) -> Vec<bool> {
    let (columns, rows) = (image.width.div_ceil(TILE_PX), image.height.div_ceil(TILE_PX));
    let tiles: Vec<Range> =
        (0..columns * rows).map(|i| tile_range(image, i % columns, i / columns)).collect();
    let levels = WINDOW_RADII_TILES.map(|radius| window_ranges(&tiles, (columns, rows), radius));
    let threshold = |tile: usize| {
        let range = levels.iter().map(|level| level[tile]).find(|(low, high)| high - low >= MIN_CONTRAST);
        range.map_or(f32::MIN, |(low, high)| low + DARK_RATIO * (high - low))
    };
    let thresholds: Vec<f32> = (0..tiles.len()).map(threshold).collect();
    let is_dark = |i: usize| {
        let (x, y) = (i % image.width, i / image.width);
        image.value(x, y) < thresholds[y / TILE_PX * columns + x / TILE_PX]
    };
    (0..image.width * image.height).map(is_dark).collect()
}

fn tile_range(image: &SmoothImage, column: usize, row: usize) -> Range {
    let end = |start: usize, size: usize| ((start + 1) * TILE_PX).min(size);
    let pixels = (row * TILE_PX..end(row, image.height))
        .flat_map(|y| (column * TILE_PX..end(column, image.width)).map(move |x| image.value(x, y)));
    pixels.fold((f32::MAX, f32::MIN), |(low, high), value| (low.min(value), high.max(value)))
}

/// The range of the window about each tile: along rows, then along columns.
fn window_ranges(tiles: &[Range], (columns, rows): (usize, usize), radius: usize) -> Vec<Range> {
    let pass = |from: &[Range], is_row: bool| -> Vec<Range> {
        (0..columns * rows)
            .map(|i| {
                let (x, y) = (i % columns, i / columns);
                let (at, size) = if is_row { (x, columns) } else { (y, rows) };
                let window = at.saturating_sub(radius)..(at + radius + 1).min(size);
                let others =
                    window.map(|k| if is_row { from[y * columns + k] } else { from[k * columns + x] });
                others.fold((f32::MAX, f32::MIN), |(low, high), other| (low.min(other.0), high.max(other.1)))
            })
            .collect()
    };
    pass(&pass(tiles, true), false)
}
