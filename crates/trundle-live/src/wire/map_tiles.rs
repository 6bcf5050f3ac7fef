//! The map in tiles: a viewer receives only the tiles that it lacks.
//!
//! | bytes | content |
//! |---|---|
//! | 1 | kind |
//! | 1 | 0 |
//! | 2 | number of tiles |
//! | 4 | generation: if it changes, the page drops all tiles |
//! | 8, 8, 8 | side of a cell \[m\]; corner of cell (0, 0), map frame: x, y \[m\] |
//! | 4, 4, 1024 each | column and row of the tile; its cells, 2 bits each, from the lowest row: 0 unknown, 1 free, 2 occupied |

use super::Kind;
use std::collections::BTreeMap;
use std::sync::Arc;
use trundle_app::operator::MapView;
use trundle_core::{Cell, OccupancyGrid, Vector2};

/// Cells along a side of a tile. Source: ours.
const TILE_CELLS: i64 = 64;
/// Bytes of a tile.
const TILE_BYTES: usize = (TILE_CELLS * TILE_CELLS / 4) as usize;
/// Maximum number of tiles of one message: 25 kB, which a network of 40 kB/s takes in 0.6 s. Source: ours.
const MAX_TILES_OF_MESSAGE: usize = 24;
/// Cells from the origin beyond which no tile is made: the page counts them in 32 bits. Source: ours.
const MAX_CELLS_FROM_ORIGIN: f64 = 1e9;

/// The tiles of the newest map.
#[derive(Debug, Default)]
pub struct MapTiles {
    map: Option<Arc<MapView>>,
    layout: Option<Layout>,
    generation: u32,
    version: u64,
    tiles: BTreeMap<(i32, i32), Tile>,
}

/// Geometry of the cells. Cell (0, 0) of the tiles does not move while the map grows.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Layout {
    resolution: f64,
    origin: Vector2,
}

#[derive(Debug)]
struct Tile {
    version: u64,
    cells: Box<[u8; TILE_BYTES]>,
}

/// Part of the map that a viewer has.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct TileCursor {
    generation: u32,
    version: u64,
}

impl MapTiles {
    /// Replaces the map if it differs from the last one.
    pub fn update(&mut self, map: &Arc<MapView>) {
        if self.map.as_ref().is_some_and(|known| Arc::ptr_eq(known, map)) {
            return;
        }
        self.map = Some(Arc::clone(map));
        let Some((first_column, first_row)) = self.place(&map.grid) else { return };
        let geometry = map.grid.geometry();
        let span = |first: i64, cells: usize| {
            first.div_euclid(TILE_CELLS)..=(first + cells as i64 - 1).div_euclid(TILE_CELLS)
        };
        let mut present = BTreeMap::new();
        for row in span(first_row, geometry.height) {
            for column in span(first_column, geometry.width) {
                let from = (column * TILE_CELLS - first_column, row * TILE_CELLS - first_row);
                let (Ok(column), Ok(row)) = (i32::try_from(column), i32::try_from(row)) else { continue };
                present.insert((column, row), packed(&map.grid, from));
            }
        }
        // Floor that the map no longer covers is unknown.
        for place in self.tiles.keys() {
            present.entry(*place).or_insert_with(|| Box::new([0; TILE_BYTES]));
        }
        for (place, cells) in present {
            self.set(place, cells);
        }
    }

    /// Column and row of the grid's first cell among the cells of the tiles. A map of other cells begins a new generation.
    fn place(&mut self, grid: &OccupancyGrid) -> Option<(i64, i64)> {
        let geometry = grid.geometry();
        let resolution = geometry.resolution;
        if self.layout.is_none_or(|layout| layout.resolution != resolution) {
            self.layout = Some(Layout { resolution, origin: geometry.origin });
            self.generation += 1;
            self.tiles.clear();
        }
        let first = (geometry.origin - self.layout?.origin) / resolution;
        let is_near = first.iter().all(|cells| cells.abs() < MAX_CELLS_FROM_ORIGIN);
        is_near.then(|| (first.x.round() as i64, first.y.round() as i64))
    }

    fn set(&mut self, place: (i32, i32), cells: Box<[u8; TILE_BYTES]>) {
        let known = self.tiles.get(&place);
        let is_same = known.map_or(cells.iter().all(|byte| *byte == 0), |tile| tile.cells == cells);
        if !is_same {
            self.version += 1;
            self.tiles.insert(place, Tile { version: self.version, cells });
        }
    }

    /// A message with tiles that the viewer at `cursor` lacks, the oldest changes first; `None` if it has all.
    pub fn message(&self, cursor: &mut TileCursor) -> Option<Vec<u8>> {
        let layout = self.layout?;
        if cursor.generation != self.generation {
            *cursor = TileCursor { generation: self.generation, version: 0 };
        }
        if cursor.version == self.version {
            return None;
        }
        let mut missing: Vec<_> =
            self.tiles.iter().filter(|(_, tile)| tile.version > cursor.version).collect();
        missing.sort_by_key(|(_, tile)| tile.version);
        missing.truncate(MAX_TILES_OF_MESSAGE);
        cursor.version = missing.last().map_or(self.version, |(_, tile)| tile.version);
        let mut bytes = vec![Kind::MapTiles as u8, 0];
        bytes.extend((missing.len() as u16).to_le_bytes());
        bytes.extend(self.generation.to_le_bytes());
        for number in [layout.resolution, layout.origin.x, layout.origin.y] {
            bytes.extend(number.to_le_bytes());
        }
        for ((column, row), tile) in missing {
            bytes.extend(column.to_le_bytes());
            bytes.extend(row.to_le_bytes());
            bytes.extend(&tile.cells[..]);
        }
        Some(bytes)
    }
}

/// The cells of a tile whose first cell is column and row `from` of the grid; unknown outside the grid.
fn packed(grid: &OccupancyGrid, from: (i64, i64)) -> Box<[u8; TILE_BYTES]> {
    let mut bytes = Box::new([0; TILE_BYTES]);
    let geometry = grid.geometry();
    let (width, height) = (geometry.width as i64, geometry.height as i64);
    for row in 0.max(-from.1)..TILE_CELLS.min(height - from.1) {
        let line = &grid.cells()[((from.1 + row) * width) as usize..][..width as usize];
        for column in 0.max(-from.0)..TILE_CELLS.min(width - from.0) {
            let value = match line[(from.0 + column) as usize] {
                Cell::Unknown => 0,
                Cell::Free => 1,
                Cell::Occupied => 2,
            };
            let at = (row * TILE_CELLS + column) as usize;
            bytes[at / 4] |= value << (2 * (at % 4));
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::GridGeometry;

    fn map(origin: (f64, f64), width: usize, height: usize, occupied: &[(f64, f64)]) -> Arc<MapView> {
        let geometry = GridGeometry::new(0.05, Vector2::new(origin.0, origin.1), width, height).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        for (x, y) in occupied {
            grid.set(geometry.cell_at(Vector2::new(*x, *y)).unwrap(), Cell::Occupied);
        }
        Arc::new(MapView { number: 0, revision: 1, grid })
    }

    /// The tiles of a message as column, row and value of the cell at (x, y) of the map frame.
    fn tiles(message: &[u8]) -> Vec<(i32, i32)> {
        let at = |i: usize| i32::from_le_bytes(message[i..i + 4].try_into().unwrap());
        (32..message.len()).step_by(8 + TILE_BYTES).map(|i| (at(i), at(i + 4))).collect()
    }

    #[test]
    fn a_viewer_is_sent_what_changed_and_a_map_that_grows_keeps_its_tiles() {
        let (mut all, mut cursor) = (MapTiles::default(), TileCursor::default());
        assert_eq!(all.message(&mut cursor), None);
        all.update(&map((-1.0, -1.0), 100, 64, &[]));
        assert_eq!(tiles(&all.message(&mut cursor).unwrap()), [(0, 0), (1, 0)]);
        assert_eq!(all.message(&mut cursor), None);
        all.update(&map((-1.0, -1.0), 100, 64, &[(0.02, 0.02)]));
        assert_eq!(tiles(&all.message(&mut cursor).unwrap()), [(0, 0)]);
        // One more tile to the left and below: 64 cells are 3.2 m.
        all.update(&map((-4.2, -4.2), 164, 128, &[(0.02, 0.02)]));
        let grown = tiles(&all.message(&mut cursor).unwrap());
        assert!(grown.iter().all(|&(column, row)| column == -1 || row == -1), "{grown:?}");
        assert_eq!(grown.len(), 4);
        let mut late = TileCursor::default();
        assert_eq!(tiles(&all.message(&mut late).unwrap()).len(), 6);
    }

    #[test]
    fn cells_lie_where_the_map_has_them() {
        let mut all = MapTiles::default();
        all.update(&map((0.0, 0.0), 64, 64, &[(0.12, 0.07)]));
        let message = all.message(&mut TileCursor::default()).unwrap();
        assert_eq!(&message[..4], &[1, 0, 1, 0]);
        let cells = &message[40..];
        let value = |column: usize, row: usize| {
            let at = row * 64 + column;
            cells[at / 4] >> (2 * (at % 4)) & 3
        };
        assert_eq!((value(2, 1), value(3, 1), value(63, 63)), (2, 1, 1));
    }

    #[test]
    fn many_tiles_come_in_several_messages_and_other_cells_are_another_generation() {
        let (mut all, mut cursor) = (MapTiles::default(), TileCursor::default());
        all.update(&map((0.0, 0.0), 640, 640, &[]));
        let counts: Vec<usize> =
            std::iter::from_fn(|| all.message(&mut cursor)).map(|message| tiles(&message).len()).collect();
        assert_eq!(counts, [24, 24, 24, 24, 4]);
        let geometry = GridGeometry::new(0.1, Vector2::zeros(), 64, 64).unwrap();
        let grid = OccupancyGrid::filled(geometry, Cell::Free);
        all.update(&Arc::new(MapView { number: 0, revision: 2, grid }));
        let message = all.message(&mut cursor).unwrap();
        assert_eq!((tiles(&message).len(), message[4]), (1, 2));
    }
}
