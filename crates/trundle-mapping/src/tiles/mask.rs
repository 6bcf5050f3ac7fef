use super::tile::{TILE_BITS, TILE_SIDE};

/// One bit for each cell of a rectangle of tiles: which ones a scan has had its say about.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mask {
    first: (i32, i32),
    cols: usize,
    /// All zero but for those touched.
    tiles: Vec<Entry>,
    touched: Vec<u32>,
}

/// The bits of a tile, row by row, and whether there may be any.
#[derive(Debug, Clone, Copy, Default)]
struct Entry {
    rows: TileMask,
    touched: bool,
}

/// The bits of a tile, row by row.
pub(crate) type TileMask = [u32; TILE_SIDE];

impl Mask {
    /// Forgets all, and covers the cells from `low` to `high`. Cost: linear in what was touched, and in growth.
    pub(crate) fn cover(&mut self, low: (i32, i32), high: (i32, i32)) {
        for i in self.touched.drain(..) {
            self.tiles[i as usize] = Entry::default();
        }
        self.first = (low.0 >> TILE_BITS, low.1 >> TILE_BITS);
        let size = |low: i32, high: i32| ((high >> TILE_BITS) - (low >> TILE_BITS) + 1) as usize;
        self.cols = size(low.0, high.0);
        let count = self.cols * size(low.1, high.1);
        if count > self.tiles.len() {
            self.tiles.resize(count, Entry::default());
        }
    }

    /// The bits of a tile that is covered.
    #[inline]
    pub(crate) fn tile(&mut self, tile: (i32, i32)) -> &mut TileMask {
        let (col, row) = ((tile.0 - self.first.0) as usize, (tile.1 - self.first.1) as usize);
        let i = row * self.cols + col;
        let entry = &mut self.tiles[i];
        if !entry.touched {
            entry.touched = true;
            self.touched.push(i as u32);
        }
        &mut entry.rows
    }

    /// Sets the bit of a cell that is covered; whether it was not set before.
    pub(crate) fn set(&mut self, x: i32, y: i32) -> bool {
        const MASK: i32 = TILE_SIDE as i32 - 1;
        let row = &mut self.tile((x >> TILE_BITS, y >> TILE_BITS))[(y & MASK) as usize];
        let bit = 1_u32 << (x & MASK);
        let fresh = *row & bit == 0;
        *row |= bit;
        fresh
    }

    /// Adds the bits of another that covers the same.
    pub(crate) fn add(&mut self, other: &Self) {
        for &i in &other.touched {
            let rows = self.tile(other.at(i));
            rows.iter_mut().zip(&other.tiles[i as usize].rows).for_each(|(row, more)| *row |= more);
        }
    }

    /// The tiles that may have bits, as they were touched first, beside those of another mask that covers the same.
    pub(crate) fn touched_with<'a>(
        &'a self,
        other: &'a Self,
    ) -> impl Iterator<Item = ((i32, i32), &'a TileMask, &'a TileMask)> {
        let rows = |mask: &'a Self, i: u32| &mask.tiles[i as usize].rows;
        self.touched.iter().map(move |&i| (self.at(i), rows(self, i), rows(other, i)))
    }

    fn at(&self, i: u32) -> (i32, i32) {
        let i = i as usize;
        (self.first.0 + (i % self.cols) as i32, self.first.1 + (i / self.cols) as i32)
    }
}
