use super::{
    map::TileMap,
    mask::{Mask, TileMask},
    tile::{TILE_BITS, TILE_SIDE, Tile},
};

/// Lowers cells, a row of a tile at a time.
#[derive(Debug, Clone)]
pub(super) struct Wipe {
    /// What passing freely takes away.
    free: u8,
    /// Log-odds plus 128: least, and where an obstacle is forgotten.
    low: u8,
    gone: u8,
}

/// A row of a tile's log-odds.
type Row = [i8; TILE_SIDE];

/// All bits of a byte for each bit that is set.
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

impl Wipe {
    pub(super) fn new(free: i8, low: i8, gone: i8) -> Self {
        Self { free: free.unsigned_abs(), low: biased(low), gone: biased(gone) }
    }

    /// Lowers the cells of a mask, but for those of another and those above `most`. What was an obstacle of its own and is one
    /// no more comes to `removed`. How many cells there were.
    pub(super) fn wipe(
        &self,
        map: &mut TileMap,
        (cells, but): (&Mask, &Mask),
        most: i8,
        removed: &mut Vec<(i32, i32)>,
    ) -> usize {
        let mut count = 0;
        for (at, rows, taken) in cells.touched_with(but) {
            let mut words = *rows;
            words.iter_mut().zip(taken).for_each(|(word, taken)| *word &= !taken);
            let left: u32 = words.iter().map(|word| word.count_ones()).sum();
            if left > 0 {
                count += left as usize;
                self.wipe_tile(map.tile_mut(at), (at, &words), most, removed);
            }
        }
        count
    }

    fn wipe_tile(
        &self,
        tile: &mut Tile,
        cells: ((i32, i32), &TileMask),
        most: i8,
        removed: &mut Vec<(i32, i32)>,
    ) {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the one feature that the function is compiled for.
            return unsafe { self.wipe_tile_by_avx2(tile, cells, most, removed) };
        }
        self.wipe_each(tile, cells, most, removed);
    }

    /// The same arithmetic in vectors of thirty-two.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn wipe_tile_by_avx2(
        &self,
        tile: &mut Tile,
        cells: ((i32, i32), &TileMask),
        most: i8,
        removed: &mut Vec<(i32, i32)>,
    ) {
        self.wipe_each(tile, cells, most, removed);
    }

    #[inline(always)]
    fn wipe_each(
        &self,
        tile: &mut Tile,
        (at, words): ((i32, i32), &TileMask),
        most: i8,
        removed: &mut Vec<(i32, i32)>,
    ) {
        for (y, &word) in words.iter().enumerate().filter(|(_, word)| **word != 0) {
            let line = tile.log_odds[y << TILE_BITS..].first_chunk_mut::<TILE_SIDE>();
            let line = line.expect("invariant: a tile holds whole rows");
            let before = *line;
            self.lower(line, word, biased(most));
            if tile.own[y] & word != 0 {
                self.find_gone(tile, (at, y), &before, removed);
            }
        }
    }

    /// Lowers the cells of a row whose bits are set. Without a branch, so that the compiler makes it vector code: log-odds plus
    /// 128 are unsigned bytes, whose difference and maximum every processor has.
    #[inline(always)]
    fn lower(&self, row: &mut Row, word: u32, most: u8) {
        let mut told = [0_u8; TILE_SIDE];
        for (part, byte) in told.as_chunks_mut::<8>().0.iter_mut().zip(word.to_le_bytes()) {
            *part = SPREAD[usize::from(byte)];
        }
        for (value, told) in row.iter_mut().zip(told) {
            let old = biased(*value);
            let told = told & if old > most { 0 } else { 255 };
            let new = old.saturating_sub(self.free).max(self.low);
            *value = (((new & told) | (old & !told)) ^ 128) as i8;
        }
    }

    fn find_gone(
        &self,
        tile: &Tile,
        (at, y): ((i32, i32), usize),
        before: &Row,
        removed: &mut Vec<(i32, i32)>,
    ) {
        for (x, old) in before.iter().enumerate() {
            let place = (y << TILE_BITS) + x;
            let fell = biased(*old) > self.gone && biased(tile.log_odds[place]) <= self.gone;
            if fell && tile.own[y] >> x & 1 == 1 {
                removed.push(((at.0 << TILE_BITS) + x as i32, (at.1 << TILE_BITS) + y as i32));
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
        fn a_row_is_lowered_as_cell_by_cell(
            values in prop::collection::vec(any::<i8>(), TILE_SIDE), word in any::<u32>(), most in any::<i8>(),
        ) {
            let wipe = Wipe::new(13, -64, -26);
            let mut tile = Tile::EMPTY;
            tile.log_odds[32..64].copy_from_slice(&values);
            // The obstacle of every second cell is its own.
            tile.own[1] = 0x5555_5555;
            let mut plain = tile.clone();
            let mut words = [0; TILE_SIDE];
            words[1] = word;
            let (mut removed, mut removed_plainly) = (Vec::new(), Vec::new());
            wipe.wipe_tile(&mut tile, ((2, -1), &words), most, &mut removed);
            wipe.wipe_each(&mut plain, ((2, -1), &words), most, &mut removed_plainly);
            prop_assert!(tile.log_odds == plain.log_odds && removed == removed_plainly);
            let mut gone = Vec::new();
            for (k, &old) in values.iter().enumerate() {
                let told = word >> k & 1 == 1 && old <= most;
                let new = if told { (i16::from(old) - 13).max(-64) as i8 } else { old };
                prop_assert_eq!(tile.log_odds[32 + k], new);
                if old > -26 && new <= -26 && k % 2 == 0 {
                    gone.push((64 + k as i32, -31));
                }
            }
            prop_assert_eq!(removed, gone);
        }
    }
}
