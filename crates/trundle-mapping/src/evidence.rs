use std::sync::Arc;
use trundle_core::Vector2;

/// A cell of the endless grid: cell (0, 0) has its lower-left corner at the map's origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GridCell {
    /// Along x.
    pub x: i32,
    /// Along y.
    pub y: i32,
}

impl GridCell {
    /// The cell that holds a point given in cells. Saturates at the ends of `i32`.
    pub fn containing(point_cells: Vector2) -> Self {
        Self { x: point_cells.x.floor() as i32, y: point_cells.y.floor() as i32 }
    }

    /// Its middle, in cells.
    pub fn center_cells(self) -> Vector2 {
        Vector2::new(f64::from(self.x) + 0.5, f64::from(self.y) + 0.5)
    }

    fn tile(self) -> (i32, i32) {
        (self.x >> TILE_BITS, self.y >> TILE_BITS)
    }

    fn within_tile(self) -> usize {
        ((self.y & TILE_MASK) << TILE_BITS | (self.x & TILE_MASK)) as usize
    }
}

/// What scans have said about one cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// ln(p / (1 - p)) of being occupied; 0 is "don't know".
    pub log_odds: f32,
    /// Running mean of the hits in the cell, from its lower-left corner, in cells; NaN where there was none.
    hit: [f32; 2],
}

impl Evidence {
    const NONE: Self = Self { log_odds: 0.0, hit: [f32::NAN; 2] };

    /// Where in the cell the hits were, from its lower-left corner, in cells, each 0 to 1.
    pub fn hit(&self) -> Option<Vector2> {
        let [x, y] = self.hit;
        (!x.is_nan()).then(|| Vector2::new(f64::from(x), f64::from(y)))
    }

    /// Takes in the mean of a scan's hits in the cell (from its lower-left corner, in cells).
    pub(crate) fn add_hit(&mut self, hit: Vector2) {
        /// Weight of a new scan: a mean over about the last ten.
        const RATE: f32 = 0.2;
        let new = [hit.x as f32, hit.y as f32];
        for (mean, x) in self.hit.iter_mut().zip(new) {
            *mean = if mean.is_nan() { x } else { *mean + RATE * (x - *mean) };
        }
    }
}

/// Evidence in tiles of 64 x 64 cells, allocated where something was seen, shared between clones until one writes.
///
/// Reading or writing a cell is O(1); memory grows with the area seen (48 kB a tile) plus 16 bytes for each tile of the
/// bounding box.
#[derive(Debug, Clone, Default)]
pub struct LogOddsGrid {
    first: (i32, i32),
    cols: usize,
    rows: usize,
    tiles: Vec<Option<Arc<[Evidence]>>>,
}

const TILE_BITS: i32 = 6;
const TILE_MASK: i32 = TILE_CELLS as i32 - 1;
/// Side of a tile, cells.
pub(crate) const TILE_CELLS: usize = 1 << TILE_BITS;

impl LogOddsGrid {
    /// What is known of a cell; `None` where no tile is.
    pub fn get(&self, cell: GridCell) -> Option<&Evidence> {
        let slot = self.slot(cell.tile())?;
        self.tiles[slot].as_ref().map(|tile| &tile[cell.within_tile()])
    }

    /// The log-odds of a cell, 0 where nothing was seen.
    pub fn log_odds(&self, cell: GridCell) -> f32 {
        self.get(cell).map_or(0.0, |evidence| evidence.log_odds)
    }

    /// The cells of the bounding box of all tiles: lowest cell and (columns, rows).
    pub fn bounds(&self) -> (GridCell, (usize, usize)) {
        let corner = GridCell { x: self.first.0 << TILE_BITS, y: self.first.1 << TILE_BITS };
        (corner, (self.cols * TILE_CELLS, self.rows * TILE_CELLS))
    }

    /// Tiles that hold evidence.
    pub fn tiles(&self) -> usize {
        self.tiles.iter().flatten().count()
    }

    /// A cell to write to; makes its tile if there is none, and copies it if a clone shares it.
    pub(crate) fn entry(&mut self, cell: GridCell) -> &mut Evidence {
        &mut self.tile_of(cell)[cell.within_tile()]
    }

    /// Cells to write to, with their evidence: a tile is looked up once for those of it that follow each other.
    pub(crate) fn each_entry(&mut self, cells: &[GridCell], mut each: impl FnMut(GridCell, &mut Evidence)) {
        for run in cells.chunk_by(|a, b| a.tile() == b.tile()) {
            let tile = self.tile_of(run[0]);
            run.iter().for_each(|cell| each(*cell, &mut tile[cell.within_tile()]));
        }
    }

    fn tile_of(&mut self, cell: GridCell) -> &mut [Evidence] {
        self.reach(cell);
        let slot = self.slot(cell.tile()).expect("invariant: the directory was grown to reach the cell");
        let tile =
            self.tiles[slot].get_or_insert_with(|| Arc::new([Evidence::NONE; TILE_CELLS * TILE_CELLS]));
        Arc::make_mut(tile)
    }

    /// Grows the bounding box so that it holds `cell`.
    pub(crate) fn reach(&mut self, cell: GridCell) {
        let (x, y) = cell.tile();
        if self.slot((x, y)).is_some() {
            return;
        }
        let empty = self.tiles.is_empty();
        let low = if empty { (x, y) } else { (self.first.0.min(x), self.first.1.min(y)) };
        let last = (self.first.0 + self.cols as i32 - 1, self.first.1 + self.rows as i32 - 1);
        let high = if empty { (x, y) } else { (last.0.max(x), last.1.max(y)) };
        self.resize(low, ((high.0 - low.0 + 1) as usize, (high.1 - low.1 + 1) as usize));
    }

    fn resize(&mut self, first: (i32, i32), (cols, rows): (usize, usize)) {
        let mut tiles = vec![None; cols * rows];
        for (i, tile) in self.tiles.drain(..).enumerate() {
            let col = (self.first.0 - first.0) as usize + i % self.cols;
            let row = (self.first.1 - first.1) as usize + i / self.cols;
            tiles[row * cols + col] = tile;
        }
        *self = Self { first, cols, rows, tiles };
    }

    fn slot(&self, (x, y): (i32, i32)) -> Option<usize> {
        let (col, row) =
            (x.wrapping_sub(self.first.0) as u32 as usize, y.wrapping_sub(self.first.1) as u32 as usize);
        (col < self.cols && row < self.rows).then_some(row * self.cols + col)
    }
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
