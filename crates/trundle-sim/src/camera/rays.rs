//! The rays of a tile and affine functions of its pixels.

#![expect(clippy::needless_range_loop, reason = "loops over lanes by number become SIMD")]

use super::tile::{ROWS, Row, TILE_COLUMNS};

/// The rays through the pixels of a tile in some frame: start + column * right + row * down. Their component along the optical axis is 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rays {
    pub(super) start: [f32; 3],
    pub(super) right: [f32; 3],
    pub(super) down: [f32; 3],
}

/// An affine function of column and row in a tile.
#[derive(Debug, Clone, Copy)]
pub(super) struct Linear {
    pub(super) start: f32,
    pub(super) right: f32,
    pub(super) down: f32,
}

impl Rays {
    /// `normal . ray`. For the opposite normal exactly the opposite, in every pixel.
    #[inline(always)]
    pub(super) fn along(&self, normal: [f32; 3]) -> Linear {
        Linear {
            start: dot(normal, self.start),
            right: dot(normal, self.right),
            down: dot(normal, self.down),
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, row: usize, column: usize) -> [f32; 3] {
        let part = |k: usize| self.start[k] + row as f32 * self.down[k] + column as f32 * self.right[k];
        [part(0), part(1), part(2)]
    }
}

impl Linear {
    pub(super) const fn constant(value: f32) -> Self {
        Self { start: value, right: 0.0, down: 0.0 }
    }

    #[inline(always)]
    pub(super) fn times(self, factor: f32) -> Self {
        Self { start: self.start * factor, right: self.right * factor, down: self.down * factor }
    }

    /// The value at the left end of a row.
    #[inline(always)]
    pub(super) fn left(&self, row: usize) -> f32 {
        self.start + row as f32 * self.down
    }

    /// The values in every column of a row.
    #[inline(always)]
    pub(super) fn row(&self, row: usize) -> Row<f32> {
        let left = self.left(row);
        let mut values = [0.0; TILE_COLUMNS];
        for column in 0..TILE_COLUMNS {
            values[column] = left + column as f32 * self.right;
        }
        values
    }

    /// The largest value in a row.
    #[inline(always)]
    pub(super) fn max_in_row(&self, row: usize) -> f32 {
        let (left, right) = (self.left(row), self.left(row) + (TILE_COLUMNS - 1) as f32 * self.right);
        if left > right { left } else { right }
    }

    /// The maximum in the tile: exactly the value of one of its corners.
    #[inline(always)]
    pub(super) fn max(&self) -> f32 {
        let (upper, lower) = (self.max_in_row(0), self.max_in_row(ROWS - 1));
        if upper > lower { upper } else { lower }
    }
}

#[inline(always)]
pub(super) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
