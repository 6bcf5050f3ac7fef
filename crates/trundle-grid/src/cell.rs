//! Index of one cell of an unbounded grid.

use trundle_core::Vector2;

/// Index of a cell of an unbounded grid. The lower-left corner of cell (0, 0) is the origin of the map frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GridCell {
    /// Column, along x.
    pub x: i32,
    /// Row, along y.
    pub y: i32,
}

impl GridCell {
    /// Cell that contains a point given in cells. The index saturates at the ends of `i32`.
    pub fn containing(point_cells: Vector2) -> Self {
        Self { x: point_cells.x.floor() as i32, y: point_cells.y.floor() as i32 }
    }

    /// Centre of the cell, in cells.
    pub fn center_cells(self) -> Vector2 {
        Vector2::new(f64::from(self.x) + 0.5, f64::from(self.y) + 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_contains_its_lower_edges_and_its_centre() {
        for (x, y) in [(0, 0), (-3, 7), (1 << 20, -(1 << 20))] {
            let cell = GridCell { x, y };
            assert_eq!(GridCell::containing(cell.center_cells()), cell);
            assert_eq!(GridCell::containing(Vector2::new(f64::from(x), f64::from(y))), cell);
        }
        assert_eq!(GridCell::containing(Vector2::new(1e300, -1e300)), GridCell { x: i32::MAX, y: i32::MIN });
    }
}
