//! Tile of 32 x 32 cells: log-odds, nearest obstacles and a coarse likelihood.

use crate::tile_grid::{TileData, TileGrid, TileIndex};

/// Vector from the centre of a cell to the nearest obstacle point, in 1/16 cells.
///
/// x is the low byte and y the high byte of one number, so a vector instruction loads a whole row of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(transparent)]
pub struct NearestObstacle(i16);

impl NearestObstacle {
    /// No obstacle within reach.
    pub const NONE: Self = Self::new(i8::MIN, i8::MIN);
    /// Units per cell. Source: ours.
    pub const PER_CELL: i32 = 16;
    /// Maximum offset of an obstacle point from the centre of its own cell, in 1/16 cells. A larger offset is a point of the neighbouring
    /// cell. Source: ours.
    pub const MAX_OWN_OFFSET: i32 = 7;

    /// Vector (x, y), in 1/16 cells.
    pub const fn new(x: i8, y: i8) -> Self {
        Self(i16::from_le_bytes([x as u8, y as u8]))
    }

    /// Vector of both bytes in one number.
    #[inline]
    pub const fn from_packed(packed: i16) -> Self {
        Self(packed)
    }

    /// Both bytes in one number.
    #[inline]
    pub const fn packed(self) -> i16 {
        self.0
    }

    /// Component along x, in 1/16 cells.
    #[inline]
    pub const fn x(self) -> i8 {
        self.0 as i8
    }

    /// Component along y, in 1/16 cells.
    #[inline]
    pub const fn y(self) -> i8 {
        (self.0 >> 8) as i8
    }

    /// Whether no obstacle is within reach.
    pub fn is_none(self) -> bool {
        self.x() == i8::MIN
    }

    /// Whether the obstacle is in the cell itself.
    pub fn is_own(self) -> bool {
        i32::from(self.x()).abs() <= Self::MAX_OWN_OFFSET && i32::from(self.y()).abs() <= Self::MAX_OWN_OFFSET
    }

    /// Obstacle point of the cell itself, in 1/16 cells from its centre. The offset is clamped to [`Self::MAX_OWN_OFFSET`].
    pub fn own(x: i32, y: i32) -> Self {
        let clamp = |v: i32| v.clamp(-Self::MAX_OWN_OFFSET, Self::MAX_OWN_OFFSET) as i8;
        Self::new(clamp(x), clamp(y))
    }

    /// Squared distance, 1/256 cells squared.
    pub fn squared(self) -> i32 {
        let (x, y) = (i32::from(self.x()), i32::from(self.y()));
        x * x + y * y
    }
}

/// Map of one particle: log-odds in bytes, with the nearest obstacle of each cell.
pub type TileMap = TileGrid<Tile>;

/// Tile for every unknown place.
pub(super) static UNKNOWN_TILE: Tile = Tile::UNKNOWN;

impl TileMap {
    /// Tile at these tile coordinates; a tile of unknown cells if none is stored.
    pub fn tile(&self, tile: TileIndex) -> &Tile {
        self.stored(tile).unwrap_or(&UNKNOWN_TILE)
    }
}

impl TileData for Tile {
    const EMPTY: Self = Self::UNKNOWN;
}

/// Tile of 32 x 32 cells: 3.5 kB.
#[derive(Debug, Clone)]
pub struct Tile {
    /// Log-odds in [`Tile::LOG_ODDS_UNIT`]s, row by row; 0 is unknown.
    pub log_odds: [i8; Tile::CELLS],
    /// Nearest obstacle of each cell, row by row.
    pub nearest: [NearestObstacle; Tile::CELLS],
    /// Likelihood of an obstacle at the centre of every second cell of every second row, 0 to 255.
    pub coarse: [u8; Tile::COARSE_SIDE * Tile::COARSE_SIDE],
    /// Whether a cell contains an obstacle point, one bit a cell, one word a row.
    pub own: [u32; Tile::SIDE],
}

impl Tile {
    /// log2 of the side of a tile in cells. Source: ours.
    pub const BITS: i32 = 5;
    /// Side of a tile, cells: 1.6 m at 5 cm.
    pub const SIDE: usize = 1 << Self::BITS;
    /// Cells of a tile.
    pub const CELLS: usize = Self::SIDE * Self::SIDE;
    /// Side of a tile in samples of the coarse likelihood, which are two cells apart.
    pub const COARSE_SIDE: usize = Self::SIDE / 2;
    /// Unit of the stored log-odds: a byte holds -4 to 3.97. Source: ours.
    pub const LOG_ODDS_UNIT: f64 = 1.0 / 32.0;

    /// Tile of unknown cells.
    pub const UNKNOWN: Self = Self {
        log_odds: [0; Self::CELLS],
        nearest: [NearestObstacle::NONE; Self::CELLS],
        coarse: [0; Self::COARSE_SIDE * Self::COARSE_SIDE],
        own: [0; Self::SIDE],
    };

    /// Log-odds and nearest obstacles as bytes, 3 a cell. The coarse likelihood follows from the nearest obstacles.
    pub fn bytes(&self) -> impl Iterator<Item = u8> {
        let log_odds = self.log_odds.iter().map(|v| *v as u8);
        let (x, y) = (self.nearest.iter().map(|n| n.x() as u8), self.nearest.iter().map(|n| n.y() as u8));
        log_odds.chain(x).chain(y)
    }

    /// Tile from its bytes, 3 per cell, with an empty coarse likelihood. Panics for too few bytes.
    pub fn from_bytes(bytes: &[u8]) -> Self {
        let mut tile = Self::UNKNOWN;
        for i in 0..Self::CELLS {
            tile.log_odds[i] = bytes[i] as i8;
            tile.nearest[i] =
                NearestObstacle::new(bytes[Self::CELLS + i] as i8, bytes[2 * Self::CELLS + i] as i8);
            tile.own[i >> Self::BITS] |= u32::from(tile.nearest[i].is_own()) << (i % Self::SIDE);
        }
        tile
    }

    /// Tile of a cell.
    #[inline]
    pub fn of_cell(x: i32, y: i32) -> (i32, i32) {
        (x >> Self::BITS, y >> Self::BITS)
    }

    /// Index of a cell in its tile, from its coordinates in the map or in the tile.
    #[inline]
    pub fn index(x: i32, y: i32) -> usize {
        const MASK: i32 = Tile::SIDE as i32 - 1;
        (((y & MASK) << Self::BITS) | (x & MASK)) as usize
    }

    /// Sets whether a cell contains an obstacle point.
    #[inline]
    pub(super) fn set_own(&mut self, x: i32, y: i32, own: bool) {
        const MASK: i32 = Tile::SIDE as i32 - 1;
        let (row, bit) = (&mut self.own[(y & MASK) as usize], 1 << (x & MASK));
        *row = if own { *row | bit } else { *row & !bit };
    }

    /// Index of a cell in the coarse likelihood; `None` for cells at odd coordinates.
    #[inline]
    pub(super) fn coarse_index_if_even(x: i32, y: i32) -> Option<usize> {
        ((x | y) & 1 == 0).then(|| Self::coarse_index(x, y))
    }

    /// Index of a cell at even coordinates in the coarse likelihood.
    #[inline]
    pub(super) fn coarse_index(x: i32, y: i32) -> usize {
        const MASK: i32 = Tile::COARSE_SIDE as i32 - 1;
        ((((y >> 1) & MASK) << (Self::BITS - 1)) | ((x >> 1) & MASK)) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_vector_comes_back_from_its_packed_bytes(x: i8, y: i8) {
            let nearest = NearestObstacle::new(x, y);
            prop_assert_eq!((nearest.x(), nearest.y()), (x, y));
            prop_assert_eq!(NearestObstacle::from_packed(nearest.packed()), nearest);
            prop_assert_eq!(nearest.squared(), i32::from(x).pow(2) + i32::from(y).pow(2));
        }

        #[test]
        fn an_own_point_stays_in_its_cell(x in -100..100_i32, y in -100..100_i32) {
            prop_assert!(NearestObstacle::own(x, y).is_own());
        }

        #[test]
        fn every_cell_has_one_index_in_its_tile(x in -2000..2000_i32, y in -2000..2000_i32) {
            let (col, row) = Tile::of_cell(x, y);
            let index = Tile::index(x, y) as i32;
            prop_assert_eq!(((col << 5) + index % 32, (row << 5) + index / 32), (x, y));
            prop_assert_eq!(Tile::coarse_index_if_even(x, y).is_some(), x % 2 == 0 && y % 2 == 0);
        }

        #[test]
        fn a_tile_comes_back_from_its_bytes(bytes in prop::collection::vec(any::<u8>(), 3 * Tile::CELLS)) {
            prop_assert_eq!(Tile::from_bytes(&bytes).bytes().collect::<Vec<_>>(), bytes);
        }
    }
}
