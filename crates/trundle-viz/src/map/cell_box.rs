//! Blocks of grid cells.

use super::bounds::Bounds;
use trundle_core::{Cell, GridGeometry, OccupancyGrid};

/// Maximum distance from the origin in cells; farther positions are moved to this distance. Source: ours.
const MAX_CELL_INDEX: f64 = 1e14;

/// A block of cells, which may reach beyond the grid: columns and rows from `low`, up to but without `high`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct CellBox {
    pub low: [i64; 2],
    pub high: [i64; 2],
}

impl CellBox {
    pub(crate) fn cols(&self) -> i64 {
        self.high[0] - self.low[0]
    }

    pub(crate) fn rows(&self) -> i64 {
        self.high[1] - self.low[1]
    }

    /// All cells of a grid.
    pub(crate) fn whole(geometry: &GridGeometry) -> Self {
        Self { low: [0, 0], high: [geometry.width.max(1) as i64, geometry.height.max(1) as i64] }
    }

    /// The cells that a rectangle of the map frame touches.
    pub(crate) fn touching(geometry: &GridGeometry, bounds: Bounds) -> Self {
        let cell = |metres: f64| {
            (metres / geometry.resolution).clamp(-MAX_CELL_INDEX, MAX_CELL_INDEX).floor() as i64
        };
        let (low, high) = (bounds.min - geometry.origin, bounds.max - geometry.origin);
        Self { low: [cell(low.x), cell(low.y)], high: [cell(high.x) + 1, cell(high.y) + 1] }
    }

    /// The smallest block around all known cells.
    pub(crate) fn known(grid: &OccupancyGrid) -> Option<Self> {
        let width = grid.geometry().width.max(1);
        let mut found: Option<Self> = None;
        for (row, cells) in grid.cells().chunks(width).enumerate() {
            let known = |cell: &Cell| *cell != Cell::Unknown;
            let (Some(first), Some(last)) = (cells.iter().position(known), cells.iter().rposition(known))
            else {
                continue;
            };
            let line = Self { low: [first as i64, row as i64], high: [last as i64 + 1, row as i64 + 1] };
            found = Some(found.map_or(line, |block| block.union(&line)));
        }
        found
    }

    fn union(&self, other: &Self) -> Self {
        let pick = |a: [i64; 2], b: [i64; 2], f: fn(i64, i64) -> i64| [f(a[0], b[0]), f(a[1], b[1])];
        Self { low: pick(self.low, other.low, i64::min), high: pick(self.high, other.high, i64::max) }
    }

    /// This block, widened to contain `other`, as far as that is within one own length around it.
    pub(crate) fn widened_to(&self, other: &Self) -> Self {
        let reach = self.cols().max(self.rows()).max(20);
        let near = |axis: usize, value: i64| value.clamp(self.low[axis] - reach, self.high[axis] + reach);
        let other = Self {
            low: [near(0, other.low[0]), near(1, other.low[1])],
            high: [near(0, other.high[0]), near(1, other.high[1])],
        };
        self.union(&other)
    }

    /// This block with a margin, and no thinner than a quarter of its length.
    pub(crate) fn with_margin(&self) -> Self {
        let long = self.cols().max(self.rows());
        let margin = (long / 40).max(1);
        let pad = |length: i64| margin + (long / 4 - length).max(0) / 2;
        let (x, y) = (pad(self.cols()), pad(self.rows()));
        Self { low: [self.low[0] - x, self.low[1] - y], high: [self.high[0] + x, self.high[1] + y] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_known_part_is_found() {
        let grid = OccupancyGrid::from_ascii(1.0, "?????\n??.??\n?#???\n?????").unwrap();
        assert_eq!(CellBox::known(&grid), Some(CellBox { low: [1, 1], high: [3, 3] }));
        assert_eq!(CellBox::known(&OccupancyGrid::from_ascii(1.0, "??").unwrap()), None);
    }

    #[test]
    fn a_stray_point_cannot_shrink_the_map_to_a_speck() {
        let block = CellBox { low: [0, 0], high: [100, 50] };
        let wide = block.widened_to(&CellBox { low: [-5, 10], high: [1_000_000, 20] });
        assert_eq!(wide, CellBox { low: [-5, 0], high: [200, 50] });
    }
}
