/// log2 of the side of a tile, cells.
pub(crate) const TILE_BITS: i32 = 5;
/// Side of a tile, cells: 1.6 m at 5 cm.
pub(crate) const TILE_SIDE: usize = 1 << TILE_BITS;
/// Cells of a tile.
pub(crate) const TILE_CELLS: usize = TILE_SIDE * TILE_SIDE;
/// Side of a tile in the coarse field, whose samples are two cells apart.
pub(crate) const COARSE_SIDE: usize = TILE_SIDE / 2;

/// Log-odds are kept in units of 1 / 32: -4 to 3.97 in a byte.
pub(crate) const LOG_ODDS_UNIT: f64 = 1.0 / 32.0;

/// From the middle of a cell to the nearest obstacle point, in 1/16 cells: x in the low byte, y in the high one. One number, so
/// that a row of cells is loaded and taken apart as a vector.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(transparent)]
pub(crate) struct Nearest(i16);

impl Nearest {
    /// No obstacle within reach.
    pub(crate) const NONE: Self = Self::new(i8::MIN, i8::MIN);
    /// Units a cell.
    pub(crate) const PER_CELL: i32 = 16;
    /// An obstacle point stays at most this far from the middle of its own cell, so that no neighbour's looks like it.
    pub(crate) const OWN: i32 = 7;

    pub(crate) const fn new(x: i8, y: i8) -> Self {
        Self(i16::from_le_bytes([x as u8, y as u8]))
    }

    /// From both bytes in one number.
    #[inline]
    pub(crate) const fn from_packed(packed: i16) -> Self {
        Self(packed)
    }

    /// Both bytes in one number.
    #[inline]
    pub(crate) const fn packed(self) -> i16 {
        self.0
    }

    #[inline]
    pub(crate) const fn x(self) -> i8 {
        self.0 as i8
    }

    #[inline]
    pub(crate) const fn y(self) -> i8 {
        (self.0 >> 8) as i8
    }

    pub(crate) fn is_none(self) -> bool {
        self.x() == i8::MIN
    }

    /// Whether the obstacle is in the cell itself.
    pub(crate) fn is_own(self) -> bool {
        i32::from(self.x()).abs() <= Self::OWN && i32::from(self.y()).abs() <= Self::OWN
    }

    /// The point of the cell itself at these 1/16 cells from its middle.
    pub(crate) fn own(x: i32, y: i32) -> Self {
        Self::new(x.clamp(-Self::OWN, Self::OWN) as i8, y.clamp(-Self::OWN, Self::OWN) as i8)
    }

    /// Squared distance, 1/256 cells squared.
    pub(crate) fn squared(self) -> i32 {
        let (x, y) = (i32::from(self.x()), i32::from(self.y()));
        x * x + y * y
    }
}

/// 32 x 32 cells: 3.5 kB.
#[derive(Debug, Clone)]
pub(crate) struct Tile {
    /// In [`LOG_ODDS_UNIT`]s; 0 is "don't know".
    pub(crate) log_odds: [i8; TILE_CELLS],
    /// The nearest obstacle of each cell.
    pub(crate) nearest: [Nearest; TILE_CELLS],
    /// Likelihood of an obstacle at the middle of every second cell of every second row, 0 to 255.
    pub(crate) coarse: [u8; COARSE_SIDE * COARSE_SIDE],
    /// Which cells have an obstacle of their own, a bit each, row by row.
    pub(crate) own: [u32; TILE_SIDE],
}

impl Tile {
    /// Nothing known.
    pub(crate) const EMPTY: Self = Self {
        log_odds: [0; TILE_CELLS],
        nearest: [Nearest::NONE; TILE_CELLS],
        coarse: [0; COARSE_SIDE * COARSE_SIDE],
        own: [0; TILE_SIDE],
    };

    /// Log-odds and nearest obstacles as bytes; the coarse field follows from them.
    pub(crate) fn bytes(&self) -> impl Iterator<Item = u8> {
        let log_odds = self.log_odds.iter().map(|v| *v as u8);
        let (x, y) = (self.nearest.iter().map(|n| n.x() as u8), self.nearest.iter().map(|n| n.y() as u8));
        log_odds.chain(x).chain(y)
    }

    /// From its bytes, 3 a cell, without the coarse field.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Self {
        let mut tile = Self::EMPTY;
        for i in 0..TILE_CELLS {
            tile.log_odds[i] = bytes[i] as i8;
            tile.nearest[i] = Nearest::new(bytes[TILE_CELLS + i] as i8, bytes[2 * TILE_CELLS + i] as i8);
            tile.own[i >> TILE_BITS] |= u32::from(tile.nearest[i].is_own()) << (i % TILE_SIDE);
        }
        tile
    }

    /// The place of a cell, from its coordinates in the whole map or in the tile.
    #[inline]
    pub(crate) fn place(x: i32, y: i32) -> usize {
        const MASK: i32 = TILE_SIDE as i32 - 1;
        (((y & MASK) << TILE_BITS) | (x & MASK)) as usize
    }

    /// Notes whether a cell has an obstacle of its own.
    #[inline]
    pub(crate) fn set_own(&mut self, x: i32, y: i32, own: bool) {
        const MASK: i32 = TILE_SIDE as i32 - 1;
        let (row, bit) = (&mut self.own[(y & MASK) as usize], 1 << (x & MASK));
        *row = if own { *row | bit } else { *row & !bit };
    }

    /// The place of a cell in the coarse field, if it has one.
    #[inline]
    pub(crate) fn coarse_place(x: i32, y: i32) -> Option<usize> {
        ((x | y) & 1 == 0).then(|| Self::coarse_index(x, y))
    }

    /// The same of a cell that has one.
    #[inline]
    pub(crate) fn coarse_index(x: i32, y: i32) -> usize {
        const MASK: i32 = COARSE_SIDE as i32 - 1;
        ((((y >> 1) & MASK) << (TILE_BITS - 1)) | ((x >> 1) & MASK)) as usize
    }
}
