use super::tile::{TILE_BITS, TILE_SIDE};

/// One bit for each cell of a rectangle of tiles: which ones a scan has had its say about.
#[derive(Debug, Clone, Default)]
pub(crate) struct Mask {
    first: (i32, i32),
    cols: usize,
    tiles: Vec<TileMask>,
}

/// The bits of a tile, row by row.
pub(crate) type TileMask = [u32; TILE_SIDE];

impl Mask {
    /// Forgets all, and covers the cells from `low` to `high`.
    pub(crate) fn cover(&mut self, low: (i32, i32), high: (i32, i32)) {
        self.first = (low.0 >> TILE_BITS, low.1 >> TILE_BITS);
        let size = |low: i32, high: i32| ((high >> TILE_BITS) - (low >> TILE_BITS) + 1) as usize;
        self.cols = size(low.0, high.0);
        self.tiles.clear();
        self.tiles.resize(self.cols * size(low.1, high.1), [0; TILE_SIDE]);
    }

    /// The bits of a tile that is covered.
    #[inline]
    pub(crate) fn tile(&mut self, tile: (i32, i32)) -> &mut TileMask {
        let (col, row) = ((tile.0 - self.first.0) as usize, (tile.1 - self.first.1) as usize);
        &mut self.tiles[row * self.cols + col]
    }

    /// Sets the bit of a cell that is covered; whether it was not set before.
    pub(crate) fn set(&mut self, x: i32, y: i32) -> bool {
        set(self.tile((x >> TILE_BITS, y >> TILE_BITS)), x, y)
    }
}

/// Sets the bit of a cell of the tile; whether it was not set before.
#[inline]
pub(crate) fn set(tile: &mut TileMask, x: i32, y: i32) -> bool {
    const MASK: i32 = TILE_SIDE as i32 - 1;
    let row = &mut tile[(y & MASK) as usize];
    let bit = 1_u32 << (x & MASK);
    let fresh = *row & bit == 0;
    *row |= bit;
    fresh
}
