//! Blocks of grid cells and the drawing of an occupancy grid.

use super::bounds::Bounds;
use super::view::{View, Zoom};
use crate::canvas::Canvas;
use crate::color::Color;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid};

/// Cells further out than this are not thought of.
const MAX_CELL_INDEX: f64 = 1e14;

/// A block of cells, which may reach beyond the grid: columns and rows from `low`, up to but without `high`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct CellBox {
    pub low: [i64; 2],
    pub high: [i64; 2],
}

impl CellBox {
    pub(crate) fn cols(&self) -> i64 {
        self.high[0] - self.low[0]
    }

    pub(crate) fn rows(&self) -> i64 {
        self.high[1] - self.low[1]
    }

    /// All cells of a grid.
    pub(crate) fn whole(geometry: &GridGeometry) -> Self {
        Self { low: [0, 0], high: [geometry.width.max(1) as i64, geometry.height.max(1) as i64] }
    }

    /// The cells that a rectangle of the map frame touches.
    pub(crate) fn touching(geometry: &GridGeometry, bounds: Bounds) -> Self {
        let cell = |metres: f64| {
            (metres / geometry.resolution).clamp(-MAX_CELL_INDEX, MAX_CELL_INDEX).floor() as i64
        };
        let (low, high) = (bounds.min - geometry.origin, bounds.max - geometry.origin);
        Self { low: [cell(low.x), cell(low.y)], high: [cell(high.x) + 1, cell(high.y) + 1] }
    }

    /// The least block around the cells that are not unknown.
    pub(crate) fn known(grid: &OccupancyGrid) -> Option<Self> {
        let width = grid.geometry().width.max(1);
        let mut found: Option<Self> = None;
        for (row, cells) in grid.cells().chunks(width).enumerate() {
            let known = |cell: &Cell| *cell != Cell::Unknown;
            let (Some(first), Some(last)) = (cells.iter().position(known), cells.iter().rposition(known))
            else {
                continue;
            };
            let line = Self { low: [first as i64, row as i64], high: [last as i64 + 1, row as i64 + 1] };
            found = Some(found.map_or(line, |block| block.union(&line)));
        }
        found
    }

    fn union(&self, other: &Self) -> Self {
        let pick = |a: [i64; 2], b: [i64; 2], f: fn(i64, i64) -> i64| [f(a[0], b[0]), f(a[1], b[1])];
        Self { low: pick(self.low, other.low, i64::min), high: pick(self.high, other.high, i64::max) }
    }

    /// This block, widened to hold `other` as far as that lies within one own length around it.
    pub(crate) fn widened_to(&self, other: &Self) -> Self {
        let reach = self.cols().max(self.rows()).max(20);
        let near = |axis: usize, value: i64| value.clamp(self.low[axis] - reach, self.high[axis] + reach);
        let other = Self {
            low: [near(0, other.low[0]), near(1, other.low[1])],
            high: [near(0, other.high[0]), near(1, other.high[1])],
        };
        self.union(&other)
    }

    /// This block with a margin, and no thinner than a quarter of its length.
    pub(crate) fn with_margin(&self) -> Self {
        let long = self.cols().max(self.rows());
        let margin = (long / 40).max(1);
        let pad = |length: i64| margin + (long / 4 - length).max(0) / 2;
        let (x, y) = (pad(self.cols()), pad(self.rows()));
        Self { low: [self.low[0] - x, self.low[1] - y], high: [self.high[0] + x, self.high[1] + y] }
    }
}

/// The ground: the cells of a view in their colours. Where cells share a pixel, the most solid one shows.
pub(crate) fn paint_cells(grid: &OccupancyGrid, block: CellBox, zoom: Zoom, view: &View) -> Canvas {
    let mut canvas = Canvas::new(view.width, view.height, Color::UNKNOWN);
    let span = |low: i64, px: i64, limit: usize| {
        let (from, to) = match zoom {
            Zoom::PxPerCell(n) => (low + px / n, low + px / n + 1),
            Zoom::CellsPerPx(k) => (low + px * k, low + (px + 1) * k),
        };
        from.clamp(0, limit as i64) as usize..to.clamp(0, limit as i64) as usize
    };
    for y in 0..view.height {
        let rows = span(block.low[1], view.height - 1 - y, grid.geometry().height);
        for x in 0..view.width {
            let cols = span(block.low[0], x, grid.geometry().width);
            let cells = rows.clone().flat_map(|row| cols.clone().map(move |col| CellIndex { col, row }));
            match cells.map(|cell| grid.get(cell)).max_by_key(solidity) {
                Some(Cell::Occupied) => canvas.blend(x, y, Color::OCCUPIED),
                Some(Cell::Free) => canvas.blend(x, y, Color::FREE),
                _ => {}
            }
        }
    }
    canvas
}

fn solidity(cell: &Cell) -> u8 {
    match cell {
        Cell::Unknown => 0,
        Cell::Free => 1,
        Cell::Occupied => 2,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    #[test]
    fn the_known_part_is_found() {
        let grid = OccupancyGrid::from_ascii(1.0, "?????\n??.??\n?#???\n?????").unwrap();
        assert_eq!(CellBox::known(&grid), Some(CellBox { low: [1, 1], high: [3, 3] }));
        assert_eq!(CellBox::known(&OccupancyGrid::from_ascii(1.0, "??").unwrap()), None);
    }

    #[test]
    fn a_stray_point_cannot_shrink_the_map_to_a_speck() {
        let block = CellBox { low: [0, 0], high: [100, 50] };
        let wide = block.widened_to(&CellBox { low: [-5, 10], high: [1_000_000, 20] });
        assert_eq!(wide, CellBox { low: [-5, 0], high: [200, 50] });
    }

    #[test]
    fn cells_appear_in_their_colours_the_lowest_row_at_the_bottom() {
        let grid = OccupancyGrid::from_ascii(1.0, "#.\n.?").unwrap();
        let block = CellBox::whole(grid.geometry());
        let view = View::of_cells(grid.geometry(), block);
        let canvas = paint_cells(&grid, block, view.cells.unwrap().1, &view);
        let [low, high] = [10, view.width - 10];
        assert_eq!(canvas.at(low, low), Color::OCCUPIED.over([0; 3]));
        assert_eq!(canvas.at(high, low), Color::FREE.over([0; 3]));
        assert_eq!(canvas.at(low, high), Color::FREE.over([0; 3]));
        assert_eq!(canvas.at(high, high), Color::UNKNOWN.over([0; 3]));
    }

    #[test]
    fn thin_walls_survive_shrinking() {
        let geometry = GridGeometry::new(0.05, Vector2::zeros(), 9000, 40).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        grid.set(CellIndex { col: 4500, row: 20 }, Cell::Occupied);
        let block = CellBox::whole(grid.geometry());
        let view = View::of_cells(grid.geometry(), block);
        let canvas = paint_cells(&grid, block, view.cells.unwrap().1, &view);
        assert_eq!(canvas.at(1500, view.height - 1 - 20 / 3), Color::OCCUPIED.over([0; 3]));
    }
}
