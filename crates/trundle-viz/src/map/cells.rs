//! The drawing of an occupancy grid.

use super::cell_box::CellBox;
use super::view::{View, Zoom};
use crate::canvas::Canvas;
use crate::color::Color;
use trundle_core::{Cell, CellIndex, OccupancyGrid};

/// The ground: the cells of a view in their colours. If several cells share a pixel, an occupied one is shown first.
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
    use trundle_core::{GridGeometry, Vector2};

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
