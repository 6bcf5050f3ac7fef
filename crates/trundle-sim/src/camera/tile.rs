/// Columns of a tile.
pub(super) const COLUMNS: usize = 16;
/// Rows of a tile.
pub(super) const ROWS: usize = 8;

/// "Nothing" among the ids of a [`Tile`].
pub(super) const NOTHING: u32 = u32::MAX;

/// A row of numbers, one a pixel: plain loops over it become SIMD.
pub(super) type Row<T> = [T; COLUMNS];

/// The nearest surface of every pixel of a small rectangle of the image so far.
///
/// Inverse depth (1/m, along the optical axis) rather than depth: on a plane it is an affine function of the pixel.
#[derive(Debug, Clone)]
pub(super) struct Tile {
    pub(super) inverse_depth: [Row<f32>; ROWS],
    /// What is there: see [`super::eye::Eye`]; or [`NOTHING`].
    pub(super) ids: [Row<u32>; ROWS],
}

impl Tile {
    /// Nothing seen yet. Pixels beyond `columns` and `rows` are not in the image: nothing will be nearer there.
    #[inline(always)]
    pub(super) fn empty(columns: usize, rows: usize) -> Self {
        let mut tile = Self { inverse_depth: [[0.0; COLUMNS]; ROWS], ids: [[NOTHING; COLUMNS]; ROWS] };
        if columns < COLUMNS || rows < ROWS {
            for (row, line) in tile.inverse_depth.iter_mut().enumerate() {
                let inside = if row < rows { columns } else { 0 };
                line[inside..].fill(f32::INFINITY);
            }
        }
        tile
    }

    /// Depth of the farthest pixel, m; infinite while one sees nothing.
    #[inline(always)]
    pub(super) fn reach(&self) -> f32 {
        let mut least = [f32::INFINITY; COLUMNS];
        for row in &self.inverse_depth {
            for (least, &w) in least.iter_mut().zip(row) {
                *least = if w < *least { w } else { *least };
            }
        }
        1.0 / least.iter().fold(f32::INFINITY, |a, &b| if b < a { b } else { a })
    }

    /// Keeps what a pixel meets if it is nearer than what it sees.
    #[inline(always)]
    pub(super) fn keep(&mut self, row: usize, column: usize, inverse_depth: f32, is_met: bool, id: u32) {
        let (w, known) = (&mut self.inverse_depth[row][column], &mut self.ids[row][column]);
        let is_nearer = is_met & (inverse_depth > *w);
        *w = if is_nearer { inverse_depth } else { *w };
        *known = if is_nearer { id } else { *known };
    }
}
