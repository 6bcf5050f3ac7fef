//! Update of the cells that rays passed freely.

use super::{
    cell_mask::{CellMask, TileMask},
    tile::{Tile, TileMap},
};

/// Subtracts the log-odds of a free ray from the cells of a mask, one row of a tile per step.
#[derive(Debug, Clone)]
pub(super) struct FreeUpdate {
    /// Log-odds subtracted from a cell.
    free: u8,
    /// Minimum of the log-odds, plus 128.
    low: u8,
    /// Log-odds at which an obstacle is removed, plus 128.
    removed_at: u8,
}

/// Log-odds of a row of a tile.
type Row = [i8; Tile::SIDE];

/// For each byte: eight bytes, 255 for each set bit.
const SPREAD: [[u8; 8]; 256] = {
    let mut all = [[0; 8]; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut bit = 0;
        while bit < 8 {
            if byte >> bit & 1 == 1 {
                all[byte][bit] = 255;
            }
            bit += 1;
        }
        byte += 1;
    }
    all
};

impl FreeUpdate {
    pub(super) fn new(free: i8, low: i8, removed_at: i8) -> Self {
        Self { free: free.unsigned_abs(), low: biased(low), removed_at: biased(removed_at) }
    }

    /// Updates the cells of `cells` that are not in `except` and whose log-odds are at most `max`. Cells whose own obstacle falls
    /// to the removal threshold are appended to `removed`. Returns the number of cells of the mask difference.
    pub(super) fn apply(
        &self,
        map: &mut TileMap,
        (cells, except): (&CellMask, &CellMask),
        max: i8,
        removed: &mut Vec<(i32, i32)>,
    ) -> usize {
        let mut count = 0;
        for (at, rows, taken) in cells.touched_with(except) {
            let mut words = *rows;
            words.iter_mut().zip(taken).for_each(|(word, taken)| *word &= !taken);
            let left: u32 = words.iter().map(|word| word.count_ones()).sum();
            if left > 0 {
                count += left as usize;
                self.update_tile(map.tile_mut(at), (at, &words), max, removed);
            }
        }
        count
    }

    fn update_tile(
        &self,
        tile: &mut Tile,
        cells: ((i32, i32), &TileMask),
        max: i8,
        removed: &mut Vec<(i32, i32)>,
    ) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the only feature that the function is compiled for.
            return unsafe { self.update_tile_by_avx2(tile, cells, max, removed) };
        }
        self.update_rows(tile, cells, max, removed);
    }

    /// [`Self::update_rows`] compiled for vectors of 32 cells.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn update_tile_by_avx2(
        &self,
        tile: &mut Tile,
        cells: ((i32, i32), &TileMask),
        max: i8,
        removed: &mut Vec<(i32, i32)>,
    ) {
        self.update_rows(tile, cells, max, removed);
    }

    #[inline(always)]
    fn update_rows(
        &self,
        tile: &mut Tile,
        (at, words): ((i32, i32), &TileMask),
        max: i8,
        removed: &mut Vec<(i32, i32)>,
    ) {
        for (y, &word) in words.iter().enumerate().filter(|(_, word)| **word != 0) {
            let line = tile.log_odds[y << Tile::BITS..].first_chunk_mut::<{ Tile::SIDE }>();
            let line = line.expect("invariant: a tile holds whole rows");
            let before = *line;
            self.update_row(line, word, biased(max));
            if tile.own[y] & word != 0 {
                self.find_removed(tile, (at, y), &before, removed);
            }
        }
    }

    /// Updates the cells of a row whose bits are set. The loop has no branch, which lets the compiler vectorise it. Log-odds plus 128 are
    /// unsigned bytes, and saturating difference and maximum of unsigned bytes are single instructions.
    #[inline(always)]
    fn update_row(&self, row: &mut Row, word: u32, max: u8) {
        let mut selected = [0_u8; Tile::SIDE];
        for (part, byte) in selected.as_chunks_mut::<8>().0.iter_mut().zip(word.to_le_bytes()) {
            *part = SPREAD[usize::from(byte)];
        }
        for (value, selected) in row.iter_mut().zip(selected) {
            let old = biased(*value);
            let selected = selected & if old > max { 0 } else { 255 };
            let new = old.saturating_sub(self.free).max(self.low);
            *value = (((new & selected) | (old & !selected)) ^ 128) as i8;
        }
    }

    fn find_removed(
        &self,
        tile: &Tile,
        (at, y): ((i32, i32), usize),
        before: &Row,
        removed: &mut Vec<(i32, i32)>,
    ) {
        for (x, old) in before.iter().enumerate() {
            let place = (y << Tile::BITS) + x;
            let fell = biased(*old) > self.removed_at && biased(tile.log_odds[place]) <= self.removed_at;
            if fell && tile.own[y] >> x & 1 == 1 {
                removed.push(((at.0 << Tile::BITS) + x as i32, (at.1 << Tile::BITS) + y as i32));
            }
        }
    }
}

fn biased(log_odds: i8) -> u8 {
    log_odds as u8 ^ 128
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_row_is_updated_as_cell_by_cell(
            values in prop::collection::vec(any::<i8>(), Tile::SIDE), word in any::<u32>(), max in any::<i8>(),
        ) {
            let update = FreeUpdate::new(13, -64, -26);
            let mut tile = Tile::UNKNOWN;
            tile.log_odds[32..64].copy_from_slice(&values);
            // Every second cell contains an obstacle.
            tile.own[1] = 0x5555_5555;
            let mut plain = tile.clone();
            let mut words = [0; Tile::SIDE];
            words[1] = word;
            let (mut removed, mut removed_plainly) = (Vec::new(), Vec::new());
            update.update_tile(&mut tile, ((2, -1), &words), max, &mut removed);
            update.update_rows(&mut plain, ((2, -1), &words), max, &mut removed_plainly);
            prop_assert!(tile.log_odds == plain.log_odds && removed == removed_plainly);
            let mut expected = Vec::new();
            for (k, &old) in values.iter().enumerate() {
                let selected = word >> k & 1 == 1 && old <= max;
                let new = if selected { (i16::from(old) - 13).max(-64) as i8 } else { old };
                prop_assert_eq!(tile.log_odds[32 + k], new);
                if old > -26 && new <= -26 && k % 2 == 0 {
                    expected.push((64 + k as i32, -31));
                }
            }
            prop_assert_eq!(removed, expected);
        }
    }
}
