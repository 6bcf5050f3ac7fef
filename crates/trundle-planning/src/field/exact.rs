//! Distances to the squares themselves: what a promise of clearance rests on.

use super::{DistanceField, UnknownIs};
use crate::geometry::box_gap;
use trundle_core::{GridGeometry, Vector2};

/// Rounding of the stored distances (f32) that a comparison forgives, m.
const ROUNDING: f64 = 1e-6;

impl DistanceField {
    /// The exact distance from a point to the nearest obstacle's square, or `cap` if that is less, m. NaN: 0.
    pub fn clearance(&self, point: Vector2, cap: f64) -> f64 {
        if !(point.x.is_finite() && point.y.is_finite()) {
            return 0.0;
        }
        let mut best = cap;
        if let Some(cell) = self.geometry.cell_at(point) {
            let off = (point - self.geometry.center(cell)).norm();
            let centre = self.at_cell(cell);
            if centre - off >= cap {
                return cap;
            }
            best = best.min(centre + off + ROUNDING);
        }
        self.nearest_square(point, best).min(self.border_gap(point))
    }

    /// Whether a disc of `radius` about `point` touches no obstacle: interpolation where it is sure, squares else.
    pub(crate) fn keeps(&self, point: Vector2, radius: f64) -> bool {
        let quick = self.distance(point);
        if quick >= radius + self.overestimate(radius) {
            return true;
        }
        let resolution = self.geometry.resolution;
        quick + resolution >= radius && self.clearance(point, radius + resolution) >= radius - ROUNDING
    }

    /// By how much [`DistanceField::distance`] may exceed the truth where that is near `radius`: a distance's second
    /// derivative is at most 1 / distance, and bilinear interpolation errs by res^2 / 8 of it along either axis.
    pub(crate) fn overestimate(&self, radius: f64) -> f64 {
        let resolution = self.geometry.resolution;
        let diagonal = resolution * std::f64::consts::FRAC_1_SQRT_2;
        if radius > 2.0 * diagonal { resolution * resolution / (4.0 * (radius - diagonal)) } else { diagonal }
    }

    /// The lower and the upper corner of the grid, map frame, m.
    pub(crate) fn extent(&self) -> (Vector2, Vector2) {
        let GridGeometry { resolution, origin, width, height } = self.geometry;
        (origin, origin + Vector2::new(width as f64, height as f64) * resolution)
    }

    /// Whether everything outside the grid is an obstacle.
    pub(crate) fn is_walled(&self) -> bool {
        self.unknown == UnknownIs::Obstacle
    }

    /// Visits the centres of obstacle cells that lie in the box (`low`, `high`) and have a free neighbour: the nearest
    /// square to anything free is one of them.
    pub(crate) fn for_obstacle_rims_in(&self, low: Vector2, high: Vector2, mut visit: impl FnMut(Vector2)) {
        let (width, cells) = (self.geometry.width, self.distance.len());
        self.for_obstacles_in(low, high, |linear| {
            let col = linear % width;
            let free = |near: usize| self.distance[near] > 0.0;
            let rim = (col > 0 && free(linear - 1))
                || (col + 1 < width && free(linear + 1))
                || (linear >= width && free(linear - width))
                || (linear + width < cells && free(linear + width));
            if rim {
                visit(self.geometry.center(self.geometry.cell(linear)));
            }
        });
    }

    fn for_obstacles_in(&self, low: Vector2, high: Vector2, mut visit: impl FnMut(usize)) {
        let GridGeometry { resolution, origin, width, height } = self.geometry;
        let index = |at: f64, size: usize| (at / resolution).floor().clamp(0.0, size as f64 - 1.0) as usize;
        let cols = index(low.x - origin.x, width)..=index(high.x - origin.x, width);
        for row in index(low.y - origin.y, height)..=index(high.y - origin.y, height) {
            for col in cols.clone() {
                if self.distance[row * width + col] == 0.0 {
                    visit(row * width + col);
                }
            }
        }
    }

    fn nearest_square(&self, point: Vector2, cap: f64) -> f64 {
        let reach = Vector2::repeat(cap + self.geometry.resolution / 2.0);
        let half = self.geometry.resolution / 2.0;
        let mut best = cap;
        self.for_obstacles_in(point - reach, point + reach, |linear| {
            let centre = self.geometry.center(self.geometry.cell(linear));
            best = best.min(box_gap(point, centre, half).norm());
        });
        best
    }

    /// How far the point is inside the grid where outside counts as an obstacle, m.
    pub(crate) fn border_gap(&self, point: Vector2) -> f64 {
        if self.unknown == UnknownIs::Free {
            return f64::INFINITY;
        }
        let (low, high) = self.extent();
        let (a, b) = (point - low, high - point);
        a.x.min(a.y).min(b.x).min(b.y).max(0.0)
    }
}
