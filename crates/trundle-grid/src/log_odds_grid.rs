//! Log-odds and mean hit of each cell of an unbounded grid.

use crate::GridCell;
use crate::tile_grid::{TileData, TileGrid, TileIndex};
use trundle_core::Vector2;

/// Accumulated evidence about one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// Log-odds of occupancy, ln(p / (1 - p)); 0 is unknown.
    pub log_odds: f32,
    /// Running mean of the hits in the cell, from its lower-left corner, in cells; NaN without a hit.
    hit: [f32; 2],
}

/// Weight of a new scan in the running mean of a cell's hits \[1\]. The mean covers about the last ten scans. Source: ours.
const MEAN_HIT_RATE: f32 = 0.2;

impl Evidence {
    const NONE: Self = Self { log_odds: 0.0, hit: [f32::NAN; 2] };

    /// Running mean of the hits in the cell, from its lower-left corner, in cells, each 0 to 1; `None` without a hit.
    pub fn hit(&self) -> Option<Vector2> {
        let [x, y] = self.hit;
        (!x.is_nan()).then(|| Vector2::new(f64::from(x), f64::from(y)))
    }

    /// Adds the mean of one scan's hits in the cell, from its lower-left corner, in cells.
    pub fn add_hit(&mut self, hit: Vector2) {
        let new = [hit.x as f32, hit.y as f32];
        for (mean, x) in self.hit.iter_mut().zip(new) {
            *mean = if mean.is_nan() { x } else { *mean + MEAN_HIT_RATE * (x - *mean) };
        }
    }
}

/// Evidence of 64 x 64 cells: 48 kB.
#[derive(Debug, Clone)]
pub struct EvidenceTile([Evidence; LogOddsGrid::TILE_SIDE * LogOddsGrid::TILE_SIDE]);

impl TileData for EvidenceTile {
    const EMPTY: Self = Self([Evidence::NONE; LogOddsGrid::TILE_SIDE * LogOddsGrid::TILE_SIDE]);
}

/// Log-odds and mean hit of each cell, in tiles of 64 x 64 cells.
///
/// Reading and writing a cell is O(1). Memory: 48 kB for each stored tile.
pub type LogOddsGrid = TileGrid<EvidenceTile>;

/// log2 of the side of a tile in cells. Source: ours.
const TILE_BITS: i32 = 6;
/// Bits of a coordinate within its tile.
const TILE_MASK: i32 = LogOddsGrid::TILE_SIDE as i32 - 1;

impl LogOddsGrid {
    /// Side of a tile, cells.
    pub const TILE_SIDE: usize = 1 << TILE_BITS;

    /// Evidence about a cell; `None` if no tile is stored.
    pub fn get(&self, cell: GridCell) -> Option<&Evidence> {
        self.stored(tile_of(cell)).map(|tile| &tile.0[index_in_tile(cell)])
    }

    /// Log-odds of a cell; 0 if no tile is stored.
    pub fn log_odds(&self, cell: GridCell) -> f32 {
        self.get(cell).map_or(0.0, |evidence| evidence.log_odds)
    }

    /// Bounding box of all tiles: lowest cell and (columns, rows) of cells.
    pub fn bounds(&self) -> (GridCell, (usize, usize)) {
        let (first, (cols, rows)) = self.tile_bounds();
        let corner = GridCell { x: first.0 << TILE_BITS, y: first.1 << TILE_BITS };
        (corner, (cols * Self::TILE_SIDE, rows * Self::TILE_SIDE))
    }

    /// Bounding box of all tiles: lowest tile and (columns, rows) of tiles.
    pub fn tile_bounds(&self) -> (TileIndex, (usize, usize)) {
        let Some((low, high)) = self.extent() else { return ((0, 0), (0, 0)) };
        (low, ((high.0 - low.0 + 1) as usize, (high.1 - low.1 + 1) as usize))
    }

    /// Evidence to write to. Allocates a missing tile, and copies a tile shared with a clone.
    pub fn entry(&mut self, cell: GridCell) -> &mut Evidence {
        &mut self.tile_mut(tile_of(cell)).0[index_in_tile(cell)]
    }

    /// Evidence of many cells to write to. Successive cells of one tile cost one tile lookup.
    pub fn each_entry(&mut self, cells: &[GridCell], mut each: impl FnMut(GridCell, &mut Evidence)) {
        for run in cells.chunk_by(|a, b| tile_of(*a) == tile_of(*b)) {
            let tile = self.tile_mut(tile_of(run[0]));
            run.iter().for_each(|cell| each(*cell, &mut tile.0[index_in_tile(*cell)]));
        }
    }

    /// Grows the bounding box to contain `cell`.
    pub fn reach(&mut self, cell: GridCell) {
        self.reach_tile(tile_of(cell));
    }
}

fn tile_of(cell: GridCell) -> TileIndex {
    (cell.x >> TILE_BITS, cell.y >> TILE_BITS)
}

fn index_in_tile(cell: GridCell) -> usize {
    ((cell.y & TILE_MASK) << TILE_BITS | (cell.x & TILE_MASK)) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #[test]
        fn is_a_map_from_cells_to_numbers(
            writes in prop::collection::vec((-500..500_i32, -500..500_i32, -3.0..3.0_f32), 1..60),
        ) {
            let mut grid = LogOddsGrid::default();
            let mut model = BTreeMap::new();
            for (x, y, value) in writes {
                grid.entry(GridCell { x, y }).log_odds = value;
                model.insert((x, y), value);
            }
            for (&(x, y), &value) in &model {
                prop_assert_eq!(grid.log_odds(GridCell { x, y }), value);
                let (corner, (cols, rows)) = grid.bounds();
                prop_assert!(x >= corner.x && x < corner.x + cols as i32);
                prop_assert!(y >= corner.y && y < corner.y + rows as i32);
            }
            prop_assert_eq!(grid.log_odds(GridCell { x: 501, y: 501 }), 0.0);
        }

        #[test]
        fn many_cells_at_once_are_written_as_one_by_one(
            cells in prop::collection::vec((-150..150_i32, -150..150_i32), 1..80),
        ) {
            let cells: Vec<GridCell> = cells.into_iter().map(|(x, y)| GridCell { x, y }).collect();
            let (mut many, mut single) = (LogOddsGrid::default(), LogOddsGrid::default());
            many.each_entry(&cells, |_, evidence| evidence.log_odds += 1.0);
            cells.iter().for_each(|cell| single.entry(*cell).log_odds += 1.0);
            prop_assert_eq!(many.bounds(), single.bounds());
            prop_assert!(cells.iter().all(|cell| many.log_odds(*cell) == single.log_odds(*cell)));
        }
    }

    #[test]
    fn a_clone_is_not_changed_by_writing_to_the_original() {
        let mut grid = LogOddsGrid::default();
        let cell = GridCell { x: -1, y: 70 };
        grid.entry(cell).log_odds = 1.0;
        let before = grid.clone();
        grid.entry(cell).log_odds = 2.0;
        assert_eq!((before.log_odds(cell), grid.log_odds(cell)), (1.0, 2.0));
    }

    #[test]
    fn hits_are_averaged_within_the_cell() {
        let mut evidence = Evidence::NONE;
        assert_eq!(evidence.hit(), None);
        for _ in 0..50 {
            evidence.add_hit(Vector2::new(0.2, 0.5));
            evidence.add_hit(Vector2::new(0.4, 0.5));
        }
        assert!((evidence.hit().unwrap() - Vector2::new(0.3, 0.5)).norm() < 0.02);
    }
}
