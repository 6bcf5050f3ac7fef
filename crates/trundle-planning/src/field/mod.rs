//! How far it is to the nearest obstacle, exactly, everywhere.
//!
//! Problem: every step of planning asks for the room at a point, and for the direction in which it grows. Idea: the
//! distance from each cell's centre to the nearest occupied square is computed exactly, by columns and then by rows as in
//! \[Felzenszwalb12\]; between centres it is interpolated bilinearly; where a promise hangs on it, the squares themselves are
//! measured ([`DistanceField::clearance`]). A field may tell distances apart up to a reach only: then a change reaches no further.
//! Cost: O(cells x distance told apart) once a map, the same for the cells near a change, O(1) a look.

mod blocks;
mod erosion;
mod exact;
mod transform;
mod window;

pub(crate) use blocks::{Blocks, SIDE as BLOCK};

use serde::{Deserialize, Serialize};
use std::ops::Range;
use transform::Transform;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};
use window::Window;

/// The distance given where a map has no obstacle at all, m.
pub const NO_OBSTACLE_DISTANCE_M: f64 = 1e6;

/// What unknown cells, and everything outside the grid, count as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UnknownIs {
    /// Passable.
    Free,
    /// As good as a wall.
    Obstacle,
}

impl UnknownIs {
    /// Whether a cell of this value is an obstacle.
    pub(crate) fn blocks(self, cell: Cell) -> bool {
        match cell {
            Cell::Occupied => true,
            Cell::Unknown => self == Self::Obstacle,
            Cell::Free => false,
        }
    }
}

/// From the first to the last of a row's cells that are obstacles where there were none, or the other way round.
fn differing(was: &[bool], cells: &[Cell], unknown: UnknownIs) -> Option<Range<usize>> {
    /// So many cells are compared at once, without a branch.
    const CHUNK: usize = 256;
    let unknown_blocks = unknown == UnknownIs::Obstacle;
    let differ = |(was, cell): (&bool, &Cell)| {
        ((*cell == Cell::Occupied) | ((*cell == Cell::Unknown) & unknown_blocks)) ^ *was
    };
    // In bytes, so that many are compared by one instruction.
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
    /// Cells a metre.
    per_metre: f64,
    unknown: UnknownIs,
    is_obstacle: Vec<bool>,
    /// From cell centres to squares; 0 in obstacles.
    distance: Vec<f32>,
    /// Rows to the nearest obstacle of the same column, at most `none`.
    gap: Vec<u16>,
    none: u16,
    /// The longest distance told apart, m.
    reach: f64,
    blocks: Blocks,
}

impl DistanceField {
    /// The field of a grid. Outside the grid counts as unknown.
    pub fn from_grid(grid: &OccupancyGrid, unknown: UnknownIs) -> Self {
        Self::over(*grid.geometry(), grid, unknown, NO_OBSTACLE_DISTANCE_M)
    }

    /// [`DistanceField::from_grid`] that tells distances apart up to `reach` m only, a few cells at least: what is further away
    /// than that has this distance. It is made, and brought up to date, the faster for it.
    pub fn up_to(reach: f64, grid: &OccupancyGrid, unknown: UnknownIs) -> Self {
        Self::over(*grid.geometry(), grid, unknown, reach)
    }

    /// The field of `grid` over another `geometry` of the same lattice (same resolution, origins whole cells apart), up to
    /// `reach` m; cells that the grid does not reach are unknown.
    pub(crate) fn over(geometry: GridGeometry, grid: &OccupancyGrid, unknown: UnknownIs, reach: f64) -> Self {
        /// Fewer cells a blocks' middle, and a step of the search, would not see.
        const MIN_REACH_CELLS: f64 = 4.0;
        let (distance, gap) = (vec![0.0; geometry.len()], vec![0; geometry.len()]);
        let per_metre = geometry.resolution.recip();
        let reach = reach.max(MIN_REACH_CELLS * geometry.resolution).min(NO_OBSTACLE_DISTANCE_M);
        // Saturates where columns are longer than anything that is told apart.
        let none = ((reach * per_metre).ceil() as u16).saturating_add(2);
        let blocks = Blocks::default();
        let is_obstacle = vec![false; geometry.len()];
        let mut field =
            Self { geometry, per_metre, unknown, is_obstacle, distance, gap, none, reach, blocks };
        field.blocks.resize(&geometry);
        field.refresh(grid, &Window::whole(&geometry));
        field
    }

    /// Brings the field up to date with a grid on the same lattice, exactly, at a cost that goes with the changed area.
    /// Returns the number of cells in the box around all changes, 0 when there were none.
    pub fn update(&mut self, grid: &OccupancyGrid) -> usize {
        let Some(dirty) = self.changed(grid) else { return 0 };
        self.refresh(grid, &dirty);
        dirty.cols.len() * dirty.rows.len()
    }

    /// The longest distance that is told apart, m.
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

    pub(crate) fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    /// Where the cells lie.
    pub fn geometry(&self) -> &GridGeometry {
        &self.geometry
    }

    /// The exact distance from a cell's centre to the nearest obstacle's square, m; 0 in obstacles. Panics outside.
    pub fn at_cell(&self, cell: CellIndex) -> f64 {
        f64::from(self.distance[self.geometry.linear(cell)])
    }

    /// [`DistanceField::at_cell`] by the place in row-major storage.
    pub(crate) fn at_linear(&self, linear: usize) -> f64 {
        f64::from(self.distance[linear])
    }

    /// The distance to the nearest obstacle at a point of the map frame, m, bilinear between cell centres.
    ///
    /// Never more than res^2 / 4d above the truth, d the distance. Outside the grid: the border's value where unknown
    /// is free (a lower bound), 0 where unknown is an obstacle. NaN: 0.
    #[inline]
    pub fn distance(&self, point: Vector2) -> f64 {
        self.among_centres(point).unwrap_or_else(|| self.distance_anywhere(point))
    }

    /// [`DistanceField::distance`] between four centres; `None` where there are none around the point.
    #[inline]
    fn among_centres(&self, point: Vector2) -> Option<f64> {
        let GridGeometry { origin, width, .. } = self.geometry;
        let (x, y) =
            ((point.x - origin.x) * self.per_metre - 0.5, (point.y - origin.y) * self.per_metre - 0.5);
        let (col, row) = (x as usize, y as usize);
        // A whole column and row further on, so that neither wraps.
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
    /// Their distances, by row then column.
    corners: [[f64; 2]; 2],
    /// Fraction along x.
    u: f64,
    /// Fraction along y.
    v: f64,
    /// From the nearest point among the centres to the point, m; zero inside.
    beyond: Vector2,
}

/// Along one axis: the lower centre, the fraction towards the next, and how far `at` (cells) lies beyond the outermost.
fn place(at: f64, size: usize) -> (usize, f64, f64) {
    let clamped = at.clamp(0.0, size as f64 - 1.0);
    let low = (clamped as usize).min(size.saturating_sub(2));
    (low, clamped - low as f64, at - clamped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brute_force(grid: &OccupancyGrid, unknown: UnknownIs, point: Vector2) -> f64 {
        let geometry = grid.geometry();
        let mut best = NO_OBSTACLE_DISTANCE_M;
        for (i, cell) in grid.cells().iter().enumerate() {
            if *cell == Cell::Occupied || (*cell == Cell::Unknown && unknown == UnknownIs::Obstacle) {
                let off = (point - geometry.center(geometry.cell(i))).abs();
                let gap = off.map(|d| (d - geometry.resolution / 2.0).max(0.0));
                best = best.min(gap.norm());
            }
        }
        if unknown == UnknownIs::Obstacle {
            let p = (point - geometry.origin) / geometry.resolution;
            let (w, h) = (geometry.width as f64, geometry.height as f64);
            let border = p.x.min(p.y).min(w - p.x).min(h - p.y).max(0.0);
            best = best.min(border * geometry.resolution);
        }
        best
    }

    prop_compose! {
        fn any_grid()(w in 1usize..17, h in 1usize..17)
            (w in Just(w), h in Just(h), cells in prop::collection::vec(0u8..12, w * h)) -> OccupancyGrid {
            let geometry = GridGeometry::new(0.1, Vector2::new(-0.3, 0.7), w, h).unwrap();
            let cell = |c: u8| match c { 0 => Cell::Occupied, 1 => Cell::Unknown, _ => Cell::Free };
            OccupancyGrid::new(geometry, cells.into_iter().map(cell).collect()).unwrap()
        }
    }

    proptest! {
        #[test]
        fn centres_agree_with_brute_force(grid in any_grid(), obstacle in any::<bool>()) {
            let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
            let field = DistanceField::from_grid(&grid, unknown);
            for i in 0..grid.geometry().len() {
                let cell = grid.geometry().cell(i);
                let truth = brute_force(&grid, unknown, grid.geometry().center(cell));
                prop_assert!((field.at_cell(cell) - truth).abs() <= 1e-6 * truth.max(1.0));
            }
        }

        #[test]
        fn an_update_is_what_a_new_field_would_be(
            grid in any_grid(), obstacle in any::<bool>(), reach in prop::sample::select(vec![0.0, 0.45, 0.8, NO_OBSTACLE_DISTANCE_M]),
            changes in prop::collection::vec((0usize..17, 0usize..17, 0u8..3), 1..9),
        ) {
            let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
            let mut field = DistanceField::up_to(reach, &grid, unknown);
            let mut grid = grid;
            for part in changes.chunks(3) {
                for (col, row, value) in part {
                    let cell = CellIndex { col: col % grid.geometry().width, row: row % grid.geometry().height };
                    grid.set(cell, [Cell::Occupied, Cell::Unknown, Cell::Free][usize::from(*value)]);
                }
                field.update(&grid);
                prop_assert_eq!(&field, &DistanceField::up_to(reach, &grid, unknown));
            }
        }

        #[test]
        fn what_is_told_apart_is_exact(grid in any_grid(), reach in 0.4..2.0, x in -0.3..1.3, y in 0.7..2.3) {
            let whole = DistanceField::from_grid(&grid, UnknownIs::Free);
            let field = DistanceField::up_to(reach, &grid, UnknownIs::Free);
            for i in 0..grid.geometry().len() {
                let cell = grid.geometry().cell(i);
                prop_assert_eq!(field.at_cell(cell), f64::from(whole.at_cell(cell).min(reach) as f32));
            }
            let point = Vector2::new(x, y);
            let truth = brute_force(&grid, UnknownIs::Free, point).min(5.0).min(reach);
            prop_assert!((field.clearance(point, 5.0) - truth).abs() < 1e-6);
        }

        /// Rows longer than a block.
        #[test]
        fn long_rows_agree_with_brute_force(
            w in 60usize..140, h in 1usize..9, obstacle in any::<bool>(),
            marks in prop::collection::vec((0usize..140, 0usize..9), 1..12),
        ) {
            let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
            let geometry = GridGeometry::new(0.1, Vector2::new(-0.3, 0.7), w, h).unwrap();
            let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
            marks.iter().for_each(|(c, r)| grid.set(CellIndex { col: c % w, row: r % h }, Cell::Occupied));
            let field = DistanceField::from_grid(&grid, unknown);
            for i in 0..geometry.len() {
                let truth = brute_force(&grid, unknown, geometry.center(geometry.cell(i)));
                prop_assert!((field.at_linear(i) - truth).abs() <= 1e-6 * truth.max(1.0));
            }
        }

        #[test]
        fn clearance_is_exact_anywhere(grid in any_grid(), x in -0.3..1.3, y in 0.7..2.3) {
            let field = DistanceField::from_grid(&grid, UnknownIs::Free);
            let point = Vector2::new(x, y);
            let truth = brute_force(&grid, UnknownIs::Free, point).min(0.5);
            prop_assert!((field.clearance(point, 0.5) - truth).abs() < 1e-9);
        }

        #[test]
        fn gradient_agrees_with_differences(grid in any_grid(), x in -0.5..1.5, y in 0.5..2.5, obstacle in any::<bool>()) {
            let unknown = if obstacle { UnknownIs::Obstacle } else { UnknownIs::Free };
            let field = DistanceField::from_grid(&grid, unknown);
            let at = |dx: f64, dy: f64| field.distance(Vector2::new(x + dx, y + dy));
            prop_assume!(at(0.0, 0.0) < NO_OBSTACLE_DISTANCE_M / 2.0);
            let h = 1e-6;
            let numeric = Vector2::new(at(h, 0.0) - at(-h, 0.0), at(0.0, h) - at(0.0, -h)) / (2.0 * h);
            let kink = |p: f64, o: f64| (((p - o) / 0.1 - 0.5).rem_euclid(1.0) - 0.5).abs() > 0.5 - 1e-3;
            prop_assume!(!kink(x, -0.3) && !kink(y, 0.7) && (!obstacle || at(0.0, 0.0) > 1e-3));
            prop_assert!((numeric - field.gradient(Vector2::new(x, y))).norm() < 1e-4);
        }
    }

    #[test]
    fn nowhere_and_outside_follow_the_policy() {
        let grid = OccupancyGrid::from_ascii(0.5, "....\n....").unwrap();
        let free = DistanceField::from_grid(&grid, UnknownIs::Free);
        let walled = DistanceField::from_grid(&grid, UnknownIs::Obstacle);
        assert_eq!(free.distance(Vector2::new(9.0, 9.0)), NO_OBSTACLE_DISTANCE_M);
        assert_eq!(walled.distance(Vector2::new(9.0, 9.0)), 0.0);
        assert_eq!(free.distance(Vector2::new(f64::NAN, 0.0)), 0.0);
        assert!((walled.distance(Vector2::new(1.0, 0.2)) - 0.2).abs() < 1e-6);
    }
}
