//! Direct access to the tiles of a rectangle of a map.

use super::tile::{Tile, TileMap, UNKNOWN_TILE};

/// References to the tiles of a rectangle of a map, for many lookups.
#[derive(Debug)]
pub struct TileWindow<'a> {
    /// Lowest cell of the rectangle.
    pub corner: (i32, i32),
    cols: usize,
    rows: usize,
    tiles: Vec<&'a Tile>,
}

impl<'a> TileWindow<'a> {
    /// Window of whole tiles that contain all cells from `low` to `high`.
    pub fn new(map: &'a TileMap, low: (i32, i32), high: (i32, i32)) -> Self {
        let (first, last) = (Tile::of_cell(low.0, low.1), Tile::of_cell(high.0, high.1));
        let (cols, rows) = ((last.0 - first.0 + 1) as usize, (last.1 - first.1 + 1) as usize);
        let mut tiles = Vec::with_capacity(cols * rows);
        for y in first.1..=last.1 {
            tiles.extend((first.0..=last.0).map(|x| map.tile((x, y))));
        }
        Self { corner: (first.0 << Tile::BITS, first.1 << Tile::BITS), cols, rows, tiles }
    }

    /// Columns and rows of tiles.
    pub fn size(&self) -> (usize, usize) {
        (self.cols, self.rows)
    }

    /// Tiles, row by row from the lowest.
    pub fn tiles(&self) -> &[&'a Tile] {
        &self.tiles
    }

    /// Tile and index of a cell, whose coordinates are relative to the window's corner. Outside the window: a tile of unknown cells.
    #[inline]
    pub fn at(&self, x: i32, y: i32) -> (&'a Tile, usize) {
        let (col, row) = ((x >> Tile::BITS) as u32 as usize, (y >> Tile::BITS) as u32 as usize);
        let inside = (col < self.cols) & (row < self.rows);
        let tile = if inside { self.tiles[row * self.cols + col] } else { &UNKNOWN_TILE };
        (tile, Tile::index(x, y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_reads_what_the_map_holds_and_unknown_outside() {
        let mut map = TileMap::default();
        for (x, y) in [(-33, 5), (0, 0), (40, -70)] {
            map.tile_mut(Tile::of_cell(x, y)).log_odds[Tile::index(x, y)] = (x + y) as i8;
        }
        let window = TileWindow::new(&map, (-40, -80), (45, 10));
        for y in -100..60 {
            for x in -100..100 {
                let (tile, index) = window.at(x - window.corner.0, y - window.corner.1);
                let inside = (-64..64).contains(&x) && (-96..32).contains(&y);
                let expected = map.tile(Tile::of_cell(x, y)).log_odds[Tile::index(x, y)];
                assert_eq!(tile.log_odds[index], if inside { expected } else { 0 });
            }
        }
    }
}
