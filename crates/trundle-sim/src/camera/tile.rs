//! A tile of pixels with the nearest surface and inverse depth of each.

#![expect(clippy::needless_range_loop, reason = "loops over lanes by number become SIMD")]

/// Columns of a tile. Source: ours.
pub(super) const TILE_COLUMNS: usize = 16;
/// Rows of a tile. Source: ours.
pub(super) const ROWS: usize = 8;

/// Id for "no surface" in a [`Tile`].
pub(super) const NO_SURFACE_ID: u32 = u32::MAX;

/// A row of numbers, one per pixel: plain loops over it become SIMD.
pub(super) type Row<T> = [T; TILE_COLUMNS];

/// The nearest surface of every pixel of a small rectangle of the image so far.
///
/// Inverse depth (1/m, along the optical axis) rather than depth: on a plane it is an affine function of the pixel.
#[derive(Debug, Clone)]
pub(super) struct Tile {
    pub(super) inverse_depth: [Row<f32>; ROWS],
    /// Ids of the surfaces: see [`super::world_view::WorldView`]; or [`NO_SURFACE_ID`].
    pub(super) ids: [Row<u32>; ROWS],
}

impl Tile {
    /// A tile without any surface. Pixels outside `columns` and `rows` are not in the image and never get a surface.
    #[inline(always)]
    pub(super) fn empty(columns: usize, rows: usize) -> Self {
        let mut tile =
            Self { inverse_depth: [[0.0; TILE_COLUMNS]; ROWS], ids: [[NO_SURFACE_ID; TILE_COLUMNS]; ROWS] };
        if columns < TILE_COLUMNS || rows < ROWS {
            for (row, line) in tile.inverse_depth.iter_mut().enumerate() {
                let inside = if row < rows { columns } else { 0 };
                line[inside..].fill(f32::INFINITY);
            }
        }
        tile
    }

    /// Depth of the farthest pixel, m; infinite while a pixel is empty.
    #[inline(always)]
    pub(super) fn reach(&self) -> f32 {
        let mut min = self.inverse_depth[0];
        for row in 1..ROWS {
            for i in 0..TILE_COLUMNS {
                let w = self.inverse_depth[row][i];
                min[i] = if w < min[i] { w } else { min[i] };
            }
        }
        // Halves, which makes this SIMD too.
        let mut width = TILE_COLUMNS / 2;
        while width > 0 {
            for i in 0..width {
                min[i] = if min[i + width] < min[i] { min[i + width] } else { min[i] };
            }
            width /= 2;
        }
        1.0 / min[0]
    }

    /// Records the nearer surfaces of a row, for pixels with all bits of `is_hit` set.
    #[inline(always)]
    pub(super) fn keep(&mut self, row: usize, inverse_depth: &Row<f32>, is_hit: &Row<u32>, id: &Row<u32>) {
        let (known, ids) = (&mut self.inverse_depth[row], &mut self.ids[row]);
        for i in 0..TILE_COLUMNS {
            let nearer = f32::from_bits(inverse_depth[i].to_bits() & is_hit[i]);
            // Compiles to a plain store: masked stores are slow.
            ids[i] ^= (ids[i] ^ id[i]) & mask(nearer > known[i]);
            known[i] = larger(nearer, known[i]);
        }
    }
}

/// A truth value as a mask of all bits: with masks, the compiler makes SIMD code instead of branches.
#[inline(always)]
pub(super) fn mask(is_true: bool) -> u32 {
    u32::from(is_true).wrapping_neg()
}

/// `f32::min` without its care for NaN, which costs instructions.
#[inline(always)]
pub(super) fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `f32::max` without its care for NaN, which costs instructions.
#[inline(always)]
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
