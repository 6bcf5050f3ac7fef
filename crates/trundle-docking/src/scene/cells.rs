//! The blocking cells of a grid in a box.

use trundle_core::{Cell, CellIndex, GridGeometry, Vector2};

/// The cells of a grid in a box, and their blocking state.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    geometry: GridGeometry,
    /// First and one past the last, columns and rows.
    pub cols: (usize, usize),
    pub rows: (usize, usize),
    /// Row by row; free cells do not block.
    kinds: Vec<Cell>,
    /// Whether the space outside the grid blocks too.
    beyond: bool,
}

impl Cells {
    /// The cells of a grid that overlap the box of half side `half` (m) around `center`; `kind` gives the state of each: all but free ones
    /// block.
    pub fn new(
        geometry: GridGeometry,
        center: Vector2,
        half: f64,
        beyond: bool,
        kind: impl Fn(CellIndex) -> Cell,
    ) -> Self {
        let part = |middle: f64, origin: f64, count: usize| {
            let at = |x: f64| ((x - origin) / geometry.resolution).clamp(0.0, count as f64);
            (at(middle - half).floor() as usize, at(middle + half).ceil() as usize)
        };
        let cols = part(center.x, geometry.origin.x, geometry.width);
        let rows = part(center.y, geometry.origin.y, geometry.height);
        let mut kinds = Vec::with_capacity((cols.1 - cols.0) * (rows.1 - rows.0));
        for row in rows.0..rows.1 {
            kinds.extend((cols.0..cols.1).map(|col| kind(CellIndex { col, row })));
        }
        Self { geometry, cols, rows, kinds, beyond }
    }

    /// The geometry of the grid.
    pub fn geometry(&self) -> &GridGeometry {
        &self.geometry
    }

    /// Whether a cell blocks; no cell outside the box does.
    pub fn blocks(&self, col: usize, row: usize) -> bool {
        self.kind(col, row) != Cell::Free
    }

    fn kind(&self, col: usize, row: usize) -> Cell {
        let inside = (self.cols.0..self.cols.1).contains(&col) && (self.rows.0..self.rows.1).contains(&row);
        let index = || (row - self.rows.0) * (self.cols.1 - self.cols.0) + col - self.cols.0;
        if inside { self.kinds[index()] } else { Cell::Free }
    }

    /// The blocking cell at a point inside it or on its outline: its state, and its centre, m; `None` at the grid's border.
    pub fn at(&self, p: Vector2) -> Option<(Cell, Vector2)> {
        let off = 1e-3 * self.geometry.resolution;
        let about = [(0.0, 0.0), (off, off), (-off, off), (-off, -off), (off, -off)];
        about.into_iter().find_map(|(x, y)| {
            let cell = self.geometry.cell_at(p + Vector2::new(x, y))?;
            let kind = self.kind(cell.col, cell.row);
            (kind != Cell::Free).then(|| (kind, self.geometry.center(cell)))
        })
    }

    /// Whether a point is in a blocking cell, or outside the grid if the outside blocks.
    pub fn hold(&self, p: Vector2) -> bool {
        self.geometry.cell_at(p).map_or(self.beyond, |cell| self.blocks(cell.col, cell.row))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_cells_in_the_box_block_and_the_outside_where_it_counts() {
        let geometry = GridGeometry::new(0.1, Vector2::zeros(), 20, 10).unwrap();
        let at = |x: f64, y: f64| Vector2::new(x, y);
        let kind = |cell: CellIndex| if cell.col.is_multiple_of(2) { Cell::Occupied } else { Cell::Free };
        let cells = |beyond| Cells::new(geometry, at(0.5, 0.5), 0.3, beyond, kind);
        let some = cells(false);
        assert!(some.hold(at(0.45, 0.5)) && !some.hold(at(0.55, 0.5)) && !some.hold(at(1.65, 0.5)));
        assert!(!some.hold(at(-0.5, 0.5)) && cells(true).hold(at(-0.5, 0.5)));
        assert_eq!((some.cols, some.rows), ((2, 8), (2, 8)));
        let (kind, middle) = some.at(at(0.5, 0.43)).unwrap();
        assert!(kind == Cell::Occupied && (middle - at(0.45, 0.45)).norm() < 1e-9, "{middle}");
        assert!(some.at(at(0.55, 0.5)).is_none() && some.at(at(5.0, 5.0)).is_none());
    }
}
