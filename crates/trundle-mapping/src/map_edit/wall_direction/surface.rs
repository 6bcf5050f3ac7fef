//! Occupied cells beside free ones.

use std::f64::consts::PI;
use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Vector2};

/// Directions of the sides of a cell: right, up, left, down. Source: ours, the axes of the grid.
const SIDE_DIRECTIONS: [[f64; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
/// Cosine between a wall's normal and a free side from which the side shows the wall's face. Source: ours, 60 deg.
const MIN_FACING_COS: f64 = 0.5;

/// Reach of the neighbourhood that shows the direction of a wall at a cell \[cells\]. Source: ours.
const NEIGHBOURHOOD_CELLS: i64 = 5;

/// An occupied cell beside a free one.
pub(crate) struct SurfaceCell {
    /// Its centre about the middle of the map \[cells\].
    pub center: Vector2,
    /// Direction of the wall at the cell \[rad\], defined up to half a turn.
    direction: f64,
    /// Which sides are free: right, up, left, down.
    free: [bool; 4],
}

impl SurfaceCell {
    /// Angle between the wall at the cell and a line in this direction \[rad\], 0 to a quarter.
    pub(super) fn angle_to(&self, direction: f64) -> f64 {
        let half_turns = (self.direction - direction) / PI;
        ((half_turns - half_turns.round()) * PI).abs()
    }

    /// Whether a free side faces this direction.
    pub(super) fn is_free_towards(&self, direction: Vector2) -> bool {
        SIDE_DIRECTIONS
            .iter()
            .zip(self.free)
            .any(|(side, is_free)| is_free && Vector2::from(*side).dot(&direction) > MIN_FACING_COS)
    }
}

/// The surface cells of a map.
pub(super) fn surface_cells(grid: &OccupancyGrid) -> Vec<SurfaceCell> {
    let geometry = grid.geometry();
    let middle = Vector2::new(geometry.width as f64, geometry.height as f64) / 2.0;
    let is_member: Vec<bool> = (0..geometry.len()).map(|i| is_surface(grid, geometry.cell(i))).collect();
    let members = (0..geometry.len()).filter(|i| is_member[*i]).map(|i| geometry.cell(i));
    let surface = |cell: CellIndex| SurfaceCell {
        center: Vector2::new(cell.col as f64 + 0.5, cell.row as f64 + 0.5) - middle,
        direction: local_direction(geometry, &is_member, cell),
        free: free_sides(grid, cell),
    };
    members.map(surface).collect()
}

/// The principal direction of the surface cells about a cell \[rad\].
fn local_direction(geometry: &GridGeometry, is_member: &[bool], cell: CellIndex) -> f64 {
    let reach = -NEIGHBOURHOOD_CELLS..=NEIGHBOURHOOD_CELLS;
    let (mut xx, mut xy, mut yy) = (0_i64, 0_i64, 0_i64);
    for (x, y) in reach.clone().flat_map(|y| reach.clone().map(move |x| (x, y))) {
        let (col, row) = (cell.col as i64 + x, cell.row as i64 + y);
        let is_inside =
            (0..geometry.width as i64).contains(&col) && (0..geometry.height as i64).contains(&row);
        if is_inside && is_member[row as usize * geometry.width + col as usize] {
            (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
        }
    }
    0.5 * (2.0 * xy as f64).atan2((xx - yy) as f64)
}

/// Whether a cell is occupied and a free cell is beside it.
pub(crate) fn is_surface(grid: &OccupancyGrid, cell: CellIndex) -> bool {
    grid.get(cell) == Cell::Occupied && free_sides(grid, cell).contains(&true)
}

fn free_sides(grid: &OccupancyGrid, CellIndex { col, row }: CellIndex) -> [bool; 4] {
    let (width, height) = (grid.geometry().width, grid.geometry().height);
    let sides = [(col + 1, row), (col, row + 1), (col.wrapping_sub(1), row), (col, row.wrapping_sub(1))];
    sides.map(|(col, row)| col < width && row < height && grid.get(CellIndex { col, row }) == Cell::Free)
}
