//! Surface points of the occupied cells of a part of the map.

use crate::grid_mapper::GridMapper;
use trundle_core::{Cell, Vector2};
use trundle_grid::GridCell;

/// The obstacles of a part of the map: of each occupied cell the mean of its hits, map frame, m.
#[derive(Debug, Clone)]
pub(crate) struct SurfacePoints {
    pub(crate) resolution: f64,
    pub(crate) corner: GridCell,
    pub(crate) width: usize,
    pub(crate) height: usize,
    cells: Vec<Option<Vector2>>,
}

impl SurfacePoints {
    /// Those within `margin` m of the bounding box of `points` (map frame, m); `None` when there is no point.
    pub(crate) fn around(mapper: &GridMapper, points: &[Vector2], margin: f64) -> Option<Self> {
        let resolution = mapper.config().resolution;
        let first = *points.first()?;
        let (low, high) = points.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        let low = GridCell::containing((low - Vector2::repeat(margin)) / resolution);
        let high = GridCell::containing((high + Vector2::repeat(margin)) / resolution);
        let site = |cell: GridCell| {
            let evidence = mapper.evidence().get(cell)?;
            let within = evidence.hit().filter(|_| mapper.classify(evidence.log_odds) == Cell::Occupied)?;
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

    /// All sites, by rising y, then x of their cells.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Vector2> {
        self.cells.iter().flatten().copied()
    }

    /// The sites whose cells are at most `reach` cells away from the cell of `point`.
    pub(crate) fn near(&self, point: Vector2, reach: i32) -> impl Iterator<Item = Vector2> {
        let (col, row) = self.column_and_row(point);
        let span = |at: i32, size: usize| (at - reach).max(0)..(at + reach + 1).min(size as i32);
        let cols = span(col, self.width);
        span(row, self.height)
            .flat_map(move |row| cols.clone().map(move |col| (row, col)))
            .filter_map(|(row, col)| self.cells[row as usize * self.width + col as usize])
    }

    /// Column and row of the cell that holds `point`, which may lie outside.
    pub(crate) fn column_and_row(&self, point: Vector2) -> (i32, i32) {
        let cell = GridCell::containing(point / self.resolution);
        (cell.x - self.corner.x, cell.y - self.corner.y)
    }

    /// The middle of a cell, map frame, m.
    pub(crate) fn center(&self, col: i32, row: i32) -> Vector2 {
        GridCell { x: self.corner.x + col, y: self.corner.y + row }.center_cells() * self.resolution
    }
}
