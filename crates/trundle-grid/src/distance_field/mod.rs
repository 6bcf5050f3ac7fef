//! Distance to the nearest obstacle, exact at the centres of all cells.
//!
//! Problem: each step of planning needs the distance to the nearest obstacle at a point, and its gradient. Idea: the distance from the
//! centre of each cell to the nearest occupied square is computed exactly, first along columns and then along rows \[Felzenszwalb12\].
//! Between centres the distance is interpolated bilinearly. Guarantees use the distances to the squares themselves
//! ([`DistanceField::clearance`]). A field can be limited to a reach, which bounds the effect of a change. Cost: O(cells x reach) for a
//! map, the same for the cells near a change, O(1) for a lookup.

mod blocks;
mod erosion;
mod exact;
mod transform;
mod window;

pub use blocks::{BLOCK_SIDE_CELLS, BlockMaxima};

use serde::{Deserialize, Serialize};
use std::ops::Range;
use transform::Transform;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};
use window::Window;

/// Distance in a map without obstacles, m. Source: ours.
pub const NO_OBSTACLE_DISTANCE_M: f64 = 1e6;

/// State assumed for unknown cells and the space outside the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UnknownIs {
    /// Passable.
    Free,
    /// Counts as an obstacle.
    Obstacle,
}

impl UnknownIs {
    /// Whether a cell of this value is an obstacle.
    pub fn blocks(self, cell: Cell) -> bool {
        match cell {
            Cell::Occupied => true,
            Cell::Unknown => self == Self::Obstacle,
            Cell::Free => false,
        }
    }
}

/// From the first to the last cell of a row that changed between obstacle and no obstacle.
fn differing(was: &[bool], cells: &[Cell], unknown: UnknownIs) -> Option<Range<usize>> {
    /// Number of cells that are compared together, without a branch. Source: ours.
    const CHUNK: usize = 256;
    let unknown_blocks = unknown == UnknownIs::Obstacle;
    let differ = |(was, cell): (&bool, &Cell)| {
        ((*cell == Cell::Occupied) | ((*cell == Cell::Unknown) & unknown_blocks)) ^ *was
    };
    // Bytes, many of which are compared by one instruction.
    let any = |(was, cells): (&[bool], &[Cell])| {
        was.iter().zip(cells).fold(0_u8, |any, pair| any | u8::from(differ(pair))) != 0
    };
    let chunks = || was.chunks(CHUNK).zip(cells.chunks(CHUNK));
    let first = chunks().position(any)? * CHUNK;
    let last = chunks().rposition(any)? * CHUNK;
    let first = first + was[first..].iter().zip(&cells[first..]).position(differ)?;
    let end = (last + CHUNK).min(was.len());
    let last = last + was[last..end].iter().zip(&cells[last..end]).rposition(differ)?;
    Some(first..last + 1)
}

/// Distance to the nearest obstacle over a grid, metres.
#[derive(Debug, Clone, PartialEq)]
pub struct DistanceField {
    geometry: GridGeometry,
    /// Cells per metre.
    per_metre: f64,
    unknown: UnknownIs,
    is_obstacle: Vec<bool>,
    /// Distances from cell centres to the squares of obstacles; 0 in obstacles.
    distance: Vec<f32>,
    /// Rows to the nearest obstacle of the same column, at most `none`.
    gap: Vec<u16>,
    none: u16,
    /// Largest stored distance, m.
    reach: f64,
    blocks: BlockMaxima,
}

impl DistanceField {
    /// The field of a grid. The outside of the grid counts as unknown.
    pub fn from_grid(grid: &OccupancyGrid, unknown: UnknownIs) -> Self {
        Self::over(*grid.geometry(), grid, unknown, NO_OBSTACLE_DISTANCE_M)
    }

    /// [`DistanceField::from_grid`] with distances up to `reach` m, at least a few cells; farther cells have this distance. A smaller reach
    /// makes creation and updates faster.
    pub fn up_to(reach: f64, grid: &OccupancyGrid, unknown: UnknownIs) -> Self {
        Self::over(*grid.geometry(), grid, unknown, reach)
    }

    /// The field of `grid` over another `geometry` of the same lattice (same resolution, origins whole cells apart), up to `reach` m; cells
    /// outside the grid are unknown.
    pub fn over(geometry: GridGeometry, grid: &OccupancyGrid, unknown: UnknownIs, reach: f64) -> Self {
        /// Fewer cells a blocks' middle, and a step of the search, would not see. Source: ours.
        const MIN_REACH_CELLS: f64 = 4.0;
        let (distance, gap) = (vec![0.0; geometry.len()], vec![0; geometry.len()]);
        let per_metre = geometry.resolution.recip();
        let reach = reach.max(MIN_REACH_CELLS * geometry.resolution).min(NO_OBSTACLE_DISTANCE_M);
        // Saturates for columns longer than the reach.
        let none = ((reach * per_metre).ceil() as u16).saturating_add(2);
        let blocks = BlockMaxima::default();
        let is_obstacle = vec![false; geometry.len()];
        let mut field =
            Self { geometry, per_metre, unknown, is_obstacle, distance, gap, none, reach, blocks };
        field.blocks.resize(&geometry);
        field.refresh(grid, &Window::whole(&geometry));
        field
    }

    /// Updates the field exactly to a grid on the same lattice, at a cost proportional to the changed area. Returns the number of cells in
    /// the box around all changes, 0 without changes.
    pub fn update(&mut self, grid: &OccupancyGrid) -> usize {
        let Some(dirty) = self.changed(grid) else { return 0 };
        self.refresh(grid, &dirty);
        dirty.cols.len() * dirty.rows.len()
    }

    /// Largest stored distance, m.
    #[inline]
    pub fn reach(&self) -> f64 {
        self.reach
    }

    fn refresh(&mut self, grid: &OccupancyGrid, dirty: &Window) {
        let (geometry, unknown) = (self.geometry, self.unknown);
        let same = geometry == *grid.geometry();
        for row in dirty.rows.clone() {
            let now = &mut self.is_obstacle[row * geometry.width..][dirty.cols.clone()];
            if same {
                let cells = &grid.cells()[row * geometry.width..][dirty.cols.clone()];
                now.iter_mut().zip(cells).for_each(|(is, cell)| *is = unknown.blocks(*cell));
            } else {
                let at = |col| unknown.blocks(grid.at(geometry.center(CellIndex { col, row })));
                now.iter_mut().zip(dirty.cols.clone()).for_each(|(is, col)| *is = at(col));
            }
        }
        let mut transform = Transform {
            geometry: &geometry,
            is_obstacle: &self.is_obstacle,
            outside: unknown == UnknownIs::Obstacle,
            gap: &mut self.gap,
            distance: &mut self.distance,
            none: self.none,
            reach: self.reach,
        };
        let touched = transform.update(dirty);
        self.blocks.update(&geometry, &self.distance, &touched);
    }

    /// The box around all cells that became obstacles, or ceased to be.
    fn changed(&self, grid: &OccupancyGrid) -> Option<Window> {
        let (geometry, unknown) = (self.geometry, self.unknown);
        let width = geometry.width;
        let same = geometry == *grid.geometry();
        Window::around(&geometry, |row| {
            let was = &self.is_obstacle[row * width..][..width];
            if same {
                return differing(was, &grid.cells()[row * width..][..width], unknown);
            }
            let now = |col: &usize| unknown.blocks(grid.at(geometry.center(CellIndex { col: *col, row })));
            let differs = |col: &usize| now(col) != was[*col];
            Some((0..width).find(differs)?..(0..width).rfind(differs)? + 1)
        })
    }

    /// Maximum distances of blocks of 4 x 4 cells.
    #[inline]
    pub fn blocks(&self) -> &BlockMaxima {
        &self.blocks
    }

    /// Position of the cells.
    #[inline]
    pub fn geometry(&self) -> &GridGeometry {
        &self.geometry
    }

    /// The exact distance from a cell's centre to the nearest obstacle's square, m; 0 in obstacles. Panics outside.
    #[inline]
    pub fn at_cell(&self, cell: CellIndex) -> f64 {
        f64::from(self.distance[self.geometry.linear(cell)])
    }

    /// [`DistanceField::at_cell`] by the place in row-major storage.
    #[inline]
    pub fn at_linear(&self, linear: usize) -> f64 {
        f64::from(self.distance[linear])
    }

    /// The distance to the nearest obstacle at a point of the map frame, m, bilinear between cell centres.
    ///
    /// Exceeds the truth by at most res^2 / 4d, d the distance. Outside the grid: the border's value if unknown is free (a lower bound), 0
    /// if unknown is an obstacle. NaN: 0.
    #[inline]
    pub fn distance(&self, point: Vector2) -> f64 {
        self.among_centres(point).unwrap_or_else(|| self.distance_anywhere(point))
    }

    /// [`DistanceField::distance`] between four centres; `None` outside of them.
    #[inline]
    fn among_centres(&self, point: Vector2) -> Option<f64> {
        let GridGeometry { origin, width, .. } = self.geometry;
        let (x, y) =
            ((point.x - origin.x) * self.per_metre - 0.5, (point.y - origin.y) * self.per_metre - 0.5);
        let (col, row) = (x as usize, y as usize);
        // The next column and row must exist, which prevents a wrap to the next row.
        if !(x >= 0.0 && y >= 0.0 && col + 1 < width) {
            return None;
        }
        let at = row * width + col;
        let (below, above) = (self.distance.get(at..at + 2)?, self.distance.get(at + width..at + width + 2)?);
        let (u, v) = (x - col as f64, y - row as f64);
        let along = |pair: &[f32]| {
            let (a, b) = (f64::from(pair[0]), f64::from(pair[1]));
            a + (b - a) * u
        };
        let (low, high) = (along(below), along(above));
        Some(low + (high - low) * v)
    }

    fn distance_anywhere(&self, point: Vector2) -> f64 {
        let Some(stencil) = self.stencil(point) else { return 0.0 };
        let [[a, b], [c, d]] = stencil.corners;
        let (u, v) = (stencil.u, stencil.v);
        let inside = (a * (1.0 - u) + b * u) * (1.0 - v) + (c * (1.0 - u) + d * u) * v;
        match self.unknown {
            UnknownIs::Free => inside,
            UnknownIs::Obstacle => (inside - stencil.beyond.norm()).max(0.0),
        }
    }

    /// The gradient of [`DistanceField::distance`]: the direction in which the room grows, about 1 long.
    pub fn gradient(&self, point: Vector2) -> Vector2 {
        let Some(stencil) = self.stencil(point) else { return Vector2::zeros() };
        let [[a, b], [c, d]] = stencil.corners;
        let (u, v) = (stencil.u, stencil.v);
        let along_x = (b - a) * (1.0 - v) + (d - c) * v;
        let along_y = (c - a) * (1.0 - u) + (d - b) * u;
        let mut gradient = Vector2::new(along_x, along_y) / self.geometry.resolution;
        for axis in 0..2 {
            if stencil.beyond[axis] != 0.0 {
                gradient[axis] = 0.0;
            }
        }
        if self.unknown == UnknownIs::Obstacle && stencil.beyond != Vector2::zeros() {
            gradient -= stencil.beyond.normalize();
        }
        gradient
    }

    fn stencil(&self, point: Vector2) -> Option<Stencil> {
        if !(point.x.is_finite() && point.y.is_finite()) {
            return None;
        }
        let GridGeometry { resolution, origin, width, height } = self.geometry;
        let (low_x, u, beyond_x) = place((point.x - origin.x) / resolution - 0.5, width);
        let (low_y, v, beyond_y) = place((point.y - origin.y) / resolution - 0.5, height);
        let high_x = (low_x + 1).min(width - 1);
        let high_y = (low_y + 1).min(height - 1);
        let value = |col: usize, row: usize| f64::from(self.distance[row * width + col]);
        let corners =
            [[value(low_x, low_y), value(high_x, low_y)], [value(low_x, high_y), value(high_x, high_y)]];
        Some(Stencil { corners, u, v, beyond: Vector2::new(beyond_x, beyond_y) * resolution })
    }
}

/// The four cell centres around a point.
struct Stencil {
    /// Distances at the corners, by row then column.
    corners: [[f64; 2]; 2],
    /// Fraction along x.
    u: f64,
    /// Fraction along y.
    v: f64,
    /// Offset from the nearest point among the centres to the point, m; zero inside.
    beyond: Vector2,
}

/// Position along one axis: the lower centre, the fraction towards the next one, and the distance of `at` (cells) outside the outermost
/// centres.
fn place(at: f64, size: usize) -> (usize, f64, f64) {
    let clamped = at.clamp(0.0, size as f64 - 1.0);
    let low = (clamped as usize).min(size.saturating_sub(2));
    (low, clamped - low as f64, at - clamped)
}

#[cfg(test)]
mod tests;
