//! Bit set over the cells of a rectangle of tiles.

use super::tile::Tile;

/// One bit for each cell of a rectangle of tiles.
#[derive(Debug, Clone, Default)]
pub(super) struct CellMask {
    first: (i32, i32),
    cols: usize,
    /// All bits are zero in tiles that are not `touched`.
    tiles: Vec<Entry>,
    touched: Vec<u32>,
}

/// Bits of a tile, and whether any may be set.
#[derive(Debug, Clone, Copy, Default)]
struct Entry {
    rows: TileMask,
    touched: bool,
}

/// Bits of a tile, one word a row.
pub(super) type TileMask = [u32; Tile::SIDE];

impl CellMask {
    /// Clears all bits, and covers the cells from `low` to `high`. Cost: linear in the touched tiles, and in growth.
    pub(super) fn cover(&mut self, low: (i32, i32), high: (i32, i32)) {
        for i in self.touched.drain(..) {
            self.tiles[i as usize] = Entry::default();
        }
        self.first = Tile::of_cell(low.0, low.1);
        let last = Tile::of_cell(high.0, high.1);
        self.cols = (last.0 - self.first.0 + 1) as usize;
        let count = self.cols * (last.1 - self.first.1 + 1) as usize;
        if count > self.tiles.len() {
            self.tiles.resize(count, Entry::default());
        }
    }

    /// Bits of a covered tile, to write to.
    #[inline]
    pub(super) fn tile(&mut self, tile: (i32, i32)) -> &mut TileMask {
        let (col, row) = ((tile.0 - self.first.0) as usize, (tile.1 - self.first.1) as usize);
        let i = row * self.cols + col;
        let entry = &mut self.tiles[i];
        if !entry.touched {
            entry.touched = true;
            self.touched.push(i as u32);
        }
        &mut entry.rows
    }

    /// Sets the bit of a covered cell. Returns whether the bit was clear.
    pub(super) fn set(&mut self, x: i32, y: i32) -> bool {
        const MASK: i32 = Tile::SIDE as i32 - 1;
        let row = &mut self.tile(Tile::of_cell(x, y))[(y & MASK) as usize];
        let bit = 1_u32 << (x & MASK);
        let fresh = *row & bit == 0;
        *row |= bit;
        fresh
    }

    /// Sets the bits of another mask that covers the same cells.
    pub(super) fn add(&mut self, other: &Self) {
        for &i in &other.touched {
            let rows = self.tile(other.at(i));
            rows.iter_mut().zip(&other.tiles[i as usize].rows).for_each(|(row, more)| *row |= more);
        }
    }

    /// Tiles that may have bits, in the order of their first write, with the bits of another mask that covers the same cells.
    pub(super) fn touched_with<'a>(
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn is_a_set_of_cells(
            cells in prop::collection::vec((-70..70_i32, -70..70_i32), 0..60),
            others in prop::collection::vec((-70..70_i32, -70..70_i32), 0..60),
        ) {
            let (mut mask, mut other) = (CellMask::default(), CellMask::default());
            // The mask contains no bits of an earlier use.
            mask.cover((0, 0), (500, 500));
            mask.set(400, 20);
            mask.cover((-70, -70), (70, 70));
            other.cover((-70, -70), (70, 70));
            let mut model = BTreeSet::new();
            for &(x, y) in &cells {
                prop_assert_eq!(mask.set(x, y), model.insert((x, y)));
            }
            for &(x, y) in &others {
                other.set(x, y);
                model.insert((x, y));
            }
            mask.add(&other);
            let mut found = BTreeSet::new();
            for (at, rows, _) in mask.touched_with(&other) {
                for (y, x) in (0..32).flat_map(|y| (0..32).map(move |x| (y, x))) {
                    if rows[y as usize] >> x & 1 == 1 {
                        found.insert(((at.0 << 5) + x, (at.1 << 5) + y));
                    }
                }
            }
            prop_assert_eq!(found, model);
        }
    }
}
