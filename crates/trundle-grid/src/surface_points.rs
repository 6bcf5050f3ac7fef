//! Surface points of the occupied cells of a part of the map.

use crate::GridCell;
use trundle_core::Vector2;

/// Surface points of a part of a map: the mean of the hits of each occupied cell, map frame, m.
#[derive(Debug, Clone)]
pub struct SurfacePoints {
    /// Side of a cell, m.
    pub resolution: f64,
    /// Lowest cell of the part.
    pub corner: GridCell,
    /// Columns of the part.
    pub width: usize,
    /// Rows of the part.
    pub height: usize,
    cells: Vec<Option<Vector2>>,
}

impl SurfacePoints {
    /// Surface points within `margin` m of the bounding box of `points` (map frame, m); `None` without points. `resolution` is the side of
    /// a cell of the map, m. `surface` is the surface point of a cell, from its lower-left corner, in cells.
    pub fn around(
        surface: impl Fn(GridCell) -> Option<Vector2>,
        resolution: f64,
        points: &[Vector2],
        margin: f64,
    ) -> Option<Self> {
        let first = *points.first()?;
        let (low, high) = points.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        let low = GridCell::containing((low - Vector2::repeat(margin)) / resolution);
        let high = GridCell::containing((high + Vector2::repeat(margin)) / resolution);
        let site = |cell: GridCell| {
            let within = surface(cell)?;
            Some((Vector2::new(f64::from(cell.x), f64::from(cell.y)) + within) * resolution)
        };
        let row = |y: i32| (low.x..=high.x).map(move |x| GridCell { x, y });
        Some(Self {
            resolution,
            corner: low,
            width: (high.x - low.x + 1) as usize,
            height: (high.y - low.y + 1) as usize,
            cells: (low.y..=high.y).flat_map(row).map(site).collect(),
        })
    }

    /// All surface points, by rising y, then x of their cells.
    pub fn iter(&self) -> impl Iterator<Item = Vector2> {
        self.cells.iter().flatten().copied()
    }

    /// Surface points whose cells are at most `reach` cells away from the cell of `point`.
    pub fn near(&self, point: Vector2, reach: i32) -> impl Iterator<Item = Vector2> {
        let (col, row) = self.column_and_row(point);
        let span = |at: i32, size: usize| (at - reach).max(0)..(at + reach + 1).min(size as i32);
        let cols = span(col, self.width);
        span(row, self.height)
            .flat_map(move |row| cols.clone().map(move |col| (row, col)))
            .filter_map(|(row, col)| self.cells[row as usize * self.width + col as usize])
    }

    /// Column and row of the cell that contains `point`; the point may be outside the part.
    pub fn column_and_row(&self, point: Vector2) -> (i32, i32) {
        let cell = GridCell::containing(point / self.resolution);
        (cell.x - self.corner.x, cell.y - self.corner.y)
    }

    /// Centre of a cell, map frame, m.
    pub fn center(&self, col: i32, row: i32) -> Vector2 {
        GridCell { x: self.corner.x + col, y: self.corner.y + row }.center_cells() * self.resolution
    }
}
