//! The view of a plot: conversion between metres of the map frame and pixels.

use super::bounds::Bounds;
use super::cell_box::CellBox;
use crate::clip::Px;
use trundle_core::{GridGeometry, Vector2};

/// Minimum length of the longer side of a plot, px; the cells of a grid may make it larger. Source: ours.
const TARGET_PX: f64 = 1100.0;
/// The longer side of a plot is at most this, px. Source: ours.
const MAX_PX: i64 = 3000;

/// Number of pixels per cell, or of cells per pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Zoom {
    /// Width of a cell in pixels.
    PxPerCell(i64),
    /// Width of a pixel in cells.
    CellsPerPx(i64),
}

/// The part of the map frame shown by a plot, and its scale.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct View {
    /// Lower left corner, m.
    corner: Vector2,
    px_per_m: f64,
    /// Size of the plot, px.
    pub width: i64,
    pub height: i64,
    /// The cells shown; `None` without a grid.
    pub cells: Option<(CellBox, Zoom)>,
    /// The unit of all that does not scale with the map: text dots and line widths, px.
    pub unit: i64,
}

impl View {
    /// A view of a block of cells, each a whole number of pixels (or a pixel a whole number of cells, for huge blocks).
    pub(crate) fn of_cells(geometry: &GridGeometry, block: CellBox) -> Self {
        let long = block.cols().max(block.rows()).max(1);
        let zoom = match long {
            n if n <= MAX_PX => Zoom::PxPerCell((TARGET_PX / n as f64).ceil().max(1.0) as i64),
            n => Zoom::CellsPerPx((n + MAX_PX - 1) / MAX_PX),
        };
        let (px_per_cell, px) = match zoom {
            Zoom::PxPerCell(n) => (n as f64, [block.cols() * n, block.rows() * n]),
            Zoom::CellsPerPx(k) => (1.0 / k as f64, [block.cols() / k, block.rows() / k]),
        };
        let low = Vector2::new(block.low[0] as f64, block.low[1] as f64);
        let corner = geometry.origin + low * geometry.resolution;
        let view = Self::new(corner, px_per_cell / geometry.resolution, px[0].max(1), px[1].max(1));
        Self { cells: Some((block, zoom)), ..view }
    }

    /// A view of a rectangle without a grid; `exact` leaves out the margin around it.
    pub(crate) fn of_bounds(bounds: Bounds, exact: bool) -> Self {
        let extent = bounds.max - bounds.min;
        let long = if extent.max() > 1e-9 { extent.max() } else { 1.0 };
        let margin = if exact { 0.0 } else { 0.06 * long };
        let sides = extent.map(|side| side.max(0.3 * long) + 2.0 * margin);
        let px_per_m = TARGET_PX / sides.max();
        let corner = (bounds.min + bounds.max) / 2.0 - sides / 2.0;
        let [width, height] = [sides.x, sides.y].map(|side| (side * px_per_m).round() as i64);
        Self::new(corner, px_per_m, width, height)
    }

    fn new(corner: Vector2, px_per_m: f64, width: i64, height: i64) -> Self {
        let unit = ((width.max(height) as f64 / 550.0).round() as i64).clamp(1, 6);
        Self { corner, px_per_m, width, height, cells: None, unit }
    }

    /// The same part of the map in a picture `part` as large, for one that is not of cells.
    pub(crate) fn scaled(self, part: f64) -> Self {
        let side = |px: i64| ((px as f64 * part).round() as i64).max(1);
        Self::new(self.corner, self.px_per_m * part, side(self.width), side(self.height))
    }

    /// The same view with its lettering enlarged by `factor`.
    pub(crate) fn with_lettering(self, factor: f64) -> Self {
        let unit = ((self.unit as f64 * factor).round() as i64).clamp(1, 12);
        Self { unit, ..self }
    }

    /// The place of a point of the map frame: x to the right, y up. Not finite for a point that cannot be drawn.
    pub(crate) fn px(&self, point: Vector2) -> Px {
        let offset = (point - self.corner) * self.px_per_m;
        (offset.x, self.height as f64 - offset.y)
    }

    /// A length in the map frame, px.
    pub(crate) fn length_px(&self, metres: f64) -> f64 {
        metres * self.px_per_m
    }

    /// A length in the picture, m.
    pub(crate) fn metres(&self, px: f64) -> f64 {
        px / self.px_per_m
    }

    /// The coordinates shown: lower left and upper right corner, m.
    pub(crate) fn extent(&self) -> (Vector2, Vector2) {
        let size = Vector2::new(self.metres(self.width as f64), self.metres(self.height as f64));
        (self.corner, self.corner + size)
    }
}

#[cfg(test)]
mod tests {
    use super::super::frame::paint_frame;
    use super::*;
    use crate::canvas::Canvas;
    use crate::color::Color;
    use crate::text::cap_height;

    fn geometry() -> GridGeometry {
        GridGeometry::new(0.05, Vector2::new(-1.0, -2.0), 100, 80).unwrap()
    }

    #[test]
    fn cells_are_whole_pixels_and_y_points_up() {
        let view = View::of_cells(&geometry(), CellBox { low: [0, 0], high: [100, 80] });
        assert_eq!((view.width, view.height), (1100, 880));
        assert_eq!(view.cells.unwrap().1, Zoom::PxPerCell(11));
        let (x, y) = view.px(Vector2::new(-0.95, -1.95));
        assert!((x - 11.0).abs() < 1e-9 && (y - 869.0).abs() < 1e-9);
    }

    #[test]
    fn huge_blocks_shrink_to_the_limit() {
        let view = View::of_cells(&geometry(), CellBox { low: [-40_000, 0], high: [50_000, 10] });
        assert_eq!(view.cells.unwrap().1, Zoom::CellsPerPx(30));
        assert_eq!((view.width, view.height), (3000, 1));
    }

    /// A column of the report is 526 px wide (`report/style.css`: half of the page without its margins).
    #[test]
    fn letters_of_a_plot_at_half_the_width_of_a_report_are_readable() {
        const COLUMN_PX: f64 = 526.0;
        const LEAST_CAPITAL_PX: f64 = 5.0;
        let geometry = geometry();
        for cells in (1..4000).step_by(7).chain([90_000]) {
            let view = View::of_cells(&geometry, CellBox { low: [0, 0], high: [cells, cells] });
            let plot = Canvas::new(view.width, 1, Color::WHITE);
            let whole = paint_frame(&plot, &view, &["x".to_owned(), "y".to_owned()], None).width();
            let capital = cap_height(view.unit) as f64 * COLUMN_PX / whole as f64;
            assert!(capital >= LEAST_CAPITAL_PX, "{cells} cells: capitals of {capital:.1} px");
        }
    }

    #[test]
    fn bounds_without_extent_still_give_a_picture() {
        let point = Vector2::new(3.0, 4.0);
        let view = View::of_bounds(Bounds { min: point, max: point }, false);
        assert!(view.width > 100 && view.height > 100);
        assert!((view.px(point).0 - view.width as f64 / 2.0).abs() < 1.0);
    }
}
