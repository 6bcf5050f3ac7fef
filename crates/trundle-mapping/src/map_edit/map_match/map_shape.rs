//! The walls of a map, for matching.

use super::super::wall_direction::is_surface;
use trundle_core::{Cell, GridGeometry, OccupancyGrid, Vector2};
use trundle_grid::{DistanceField, UnknownIs};

/// Largest distance from a wall in the field; farther points have this distance \[m\]. Source: ours.
const FIELD_REACH_M: f64 = 1.5;

/// The walls of a map.
pub(super) struct MapShape<'a> {
    pub grid: &'a OccupancyGrid,
    /// Distance to the nearest occupied cell.
    pub field: DistanceField,
    /// Centres of the occupied cells beside free ones, map frame \[m\].
    pub surface: Vec<Vector2>,
    /// Mean of the surface \[m\].
    pub middle: Vector2,
    /// Distance of the farthest surface from the middle \[m\].
    pub radius: f64,
}

impl<'a> MapShape<'a> {
    /// The shape of a map; `None` without an occupied cell beside a free one.
    pub(super) fn new(grid: &'a OccupancyGrid) -> Option<Self> {
        let geometry = grid.geometry();
        let cells = (0..geometry.len()).map(|i| geometry.cell(i)).filter(|cell| is_surface(grid, *cell));
        let surface: Vec<Vector2> = cells.map(|cell| geometry.center(cell)).collect();
        let count = surface.len();
        if count == 0 {
            return None;
        }
        let middle = surface.iter().sum::<Vector2>() / count as f64;
        let radius = surface.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
        let field = DistanceField::up_to(FIELD_REACH_M, grid, UnknownIs::Free);
        Some(Self { grid, field, surface, middle, radius })
    }

    /// Distance to the nearest occupied cell \[m\]; `None` outside the map.
    pub(super) fn distance(&self, point: Vector2) -> Option<f64> {
        self.grid.geometry().cell_at(point)?;
        Some(self.field.distance(point))
    }

    /// The value of the map at a point.
    pub(super) fn at(&self, point: Vector2) -> Cell {
        self.grid.at(point)
    }

    /// Side of a cell \[m\].
    pub(super) fn resolution(&self) -> f64 {
        self.grid.geometry().resolution
    }

    /// Lower left corner and size of the grid \[m\].
    pub(super) fn extent(&self) -> (Vector2, Vector2) {
        let GridGeometry { resolution, origin, width, height } = *self.grid.geometry();
        (origin, Vector2::new(width as f64, height as f64) * resolution)
    }
}
