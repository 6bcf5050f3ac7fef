//! The occupancy grid: its cells, its geometry, and conversion between cells and points of the map frame.

use crate::{Invalid, Vector2, require_finite, require_positive};
use serde::{Deserialize, Serialize};

/// Occupancy of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cell {
    /// Never observed, or undecided.
    Unknown,
    /// The cell contains no obstacle.
    Free,
    /// An obstacle.
    Occupied,
}

/// A cell's column (from the left, +x) and row (from the bottom, +y).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CellIndex {
    /// Column, along x.
    pub col: usize,
    /// Row, along y: row 0 is the lowest y.
    pub row: usize,
}

/// Position of a grid's cells in the map frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridGeometry {
    /// Side of a cell, m.
    pub resolution: f64,
    /// Lower-left corner of cell (0, 0), map frame, m.
    pub origin: Vector2,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// 2^40: f64 resolves the position in such a cell to 1/4096 of its side. Source: ours.
const FARTHEST_CELLS: f64 = 1_099_511_627_776.0;

/// Largest difference \[m\] of two resolutions that count as one: what text of 9 decimals loses. Source: ours.
const MAX_RESOLUTION_ERROR_M: f64 = 1e-9;
/// Largest distance \[cells\] of a corner from the lattice. Source: ours; 50 um with cells of 5 cm.
const MAX_CORNER_ERROR_CELLS: f64 = 1e-3;

impl GridGeometry {
    /// Checked geometry: resolution in m, origin in m, size in cells.
    ///
    /// # Errors
    /// When the resolution is not positive, a side is zero, or the grid has more than 2^31 cells. Also when the origin is not finite or
    /// more than 2^40 cells from zero, beyond which f64 does not separate points of a cell.
    pub fn new(resolution: f64, origin: Vector2, width: usize, height: usize) -> Result<Self, Invalid> {
        require_positive("resolution", resolution, "m")?;
        for (name, value) in [("origin x", origin.x), ("origin y", origin.y)] {
            require_finite(name, value, "m")?;
            if value.abs() > FARTHEST_CELLS * resolution {
                let expected = format!("at most 2^40 cells of {resolution} m from zero");
                return Err(Invalid::new(name, value, "m", expected));
            }
        }
        let cells = width.checked_mul(height).filter(|n| (1..=1 << 31).contains(n));
        if cells.is_none() {
            return Err(Invalid::new("grid size", format!("{width} x {height}"), "cells", "1 to 2^31 cells"));
        }
        Ok(Self { resolution, origin, width, height })
    }

    /// Requires cells of the lattice of this resolution \[m\] with a corner at the map's origin, as in a growing map.
    ///
    /// # Errors
    /// When the resolution differs, or the origin is not a multiple of it.
    pub fn require_lattice(&self, resolution: f64) -> Result<(), Invalid> {
        if (self.resolution - resolution).abs() > MAX_RESOLUTION_ERROR_M {
            return Err(Invalid::new("resolution of the map", self.resolution, "m", format!("{resolution}")));
        }
        let corner = self.origin / resolution;
        if (corner - corner.map(f64::round)).norm() > MAX_CORNER_ERROR_CELLS {
            let value = format!("({}, {})", self.origin.x, self.origin.y);
            return Err(Invalid::new("origin of the map", value, "m", format!("multiples of {resolution}")));
        }
        Ok(())
    }

    /// The number of cells.
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Whether the grid has no cell.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The cell that contains a point of the map frame; `None` outside the grid. `None` for NaN.
    pub fn cell_at(&self, point: Vector2) -> Option<CellIndex> {
        let col = ((point.x - self.origin.x) / self.resolution).floor();
        let row = ((point.y - self.origin.y) / self.resolution).floor();
        let inside = col >= 0.0 && row >= 0.0 && col < self.width as f64 && row < self.height as f64;
        inside.then_some(CellIndex { col: col as usize, row: row as usize })
    }

    /// The centre of a cell, map frame, m.
    pub fn center(&self, cell: CellIndex) -> Vector2 {
        self.origin + Vector2::new(cell.col as f64 + 0.5, cell.row as f64 + 0.5) * self.resolution
    }

    /// Row-major index of a cell.
    pub fn linear(&self, cell: CellIndex) -> usize {
        debug_assert!(cell.col < self.width && cell.row < self.height, "cell {cell:?} outside");
        cell.row * self.width + cell.col
    }

    /// The cell at a place of row-major storage.
    pub fn cell(&self, linear: usize) -> CellIndex {
        CellIndex { col: linear % self.width, row: linear / self.width }
    }
}

/// A 2-D occupancy grid in the map frame, row-major from the lowest y.
#[derive(Debug, Clone, PartialEq)]
pub struct OccupancyGrid {
    geometry: GridGeometry,
    cells: Vec<Cell>,
}

impl OccupancyGrid {
    /// A grid over `cells`, row by row from the lowest y.
    ///
    /// # Errors
    /// When the number of cells differs from that of the geometry.
    pub fn new(geometry: GridGeometry, cells: Vec<Cell>) -> Result<Self, Invalid> {
        if cells.len() != geometry.len() {
            return Err(Invalid::new("number of cells", cells.len(), "", geometry.len().to_string()));
        }
        Ok(Self { geometry, cells })
    }

    /// A grid of one value.
    pub fn filled(geometry: GridGeometry, value: Cell) -> Self {
        Self { geometry, cells: vec![value; geometry.len()] }
    }

    /// A grid from ASCII art for tests: `#` occupied, `.` free, anything else unknown; the first line is the highest y.
    ///
    /// # Errors
    /// When the resolution is not positive, the text has no line, or lines differ in length.
    pub fn from_ascii(resolution: f64, art: &str) -> Result<Self, Invalid> {
        let lines: Vec<&str> = art.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
        let width = lines.first().map_or(0, |line| line.chars().count());
        let geometry = GridGeometry::new(resolution, Vector2::zeros(), width, lines.len())?;
        let cell = |c| match c {
            '#' => Cell::Occupied,
            '.' => Cell::Free,
            _ => Cell::Unknown,
        };
        Self::new(geometry, lines.iter().rev().flat_map(|line| line.chars().map(cell)).collect())
    }

    /// Position of the cells in the map frame.
    pub fn geometry(&self) -> &GridGeometry {
        &self.geometry
    }

    /// All cells, row by row from the lowest y.
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The cell's value. Panics outside.
    pub fn get(&self, cell: CellIndex) -> Cell {
        self.cells[self.geometry.linear(cell)]
    }

    /// Sets a cell. Panics outside.
    pub fn set(&mut self, cell: CellIndex, value: Cell) {
        let linear = self.geometry.linear(cell);
        self.cells[linear] = value;
    }

    /// The value at a point of the map frame; [`Cell::Unknown`] outside the grid.
    pub fn at(&self, point: Vector2) -> Cell {
        self.geometry.cell_at(point).map_or(Cell::Unknown, |cell| self.get(cell))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ascii_puts_the_first_line_on_top() {
        let grid = OccupancyGrid::from_ascii(0.5, "#.\n.?").unwrap();
        assert_eq!(grid.at(Vector2::new(0.1, 0.9)), Cell::Occupied);
        assert_eq!(grid.at(Vector2::new(0.1, 0.1)), Cell::Free);
        assert_eq!(grid.at(Vector2::new(0.9, 0.1)), Cell::Unknown);
        assert_eq!(grid.at(Vector2::new(f64::NAN, 0.1)), Cell::Unknown);
        assert!(OccupancyGrid::from_ascii(0.5, "#.\n.").is_err());
    }

    #[test]
    fn origins_beyond_the_resolution_of_cells_are_refused() {
        let at = |x: f64, resolution| GridGeometry::new(resolution, Vector2::new(x, 0.0), 1, 1);
        let refused = at(8.126587341910605e94, 1e-9).unwrap_err().to_string();
        assert!(
            refused.contains("origin x") && refused.contains("at most 2^40 cells of 0.000000001 m"),
            "{refused}"
        );
        assert!(at(f64::NAN, 0.05).is_err() && at(-1e12, 0.05).is_err());
        assert!(at(-5e10, 0.05).is_ok() && at(1e3, 1e-9).is_ok());
    }

    #[test]
    fn centers_lie_in_their_cells() {
        let geometry = GridGeometry::new(0.05, Vector2::new(-1.0, 2.0), 40, 30).unwrap();
        for linear in 0..geometry.len() {
            let cell = geometry.cell(linear);
            assert_eq!(geometry.cell_at(geometry.center(cell)), Some(cell));
            assert_eq!(geometry.linear(cell), linear);
        }
    }
}
