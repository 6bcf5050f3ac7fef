//! Distances to the squares themselves, the basis of guaranteed clearances.

use super::{DistanceField, UnknownIs};
use trundle_core::{GridGeometry, Vector2};

/// Rounding of the stored distances (f32) that a comparison forgives, m. Source: ours.
const FIELD_ROUNDING_M: f64 = 1e-6;

impl DistanceField {
    /// The exact distance from a point to the nearest obstacle's square, or `cap` if that is less, m; never more than
    /// [`DistanceField::reach`]. NaN: 0.
    pub fn clearance(&self, point: Vector2, cap: f64) -> f64 {
        if !(point.x.is_finite() && point.y.is_finite()) {
            return 0.0;
        }
        let cap = cap.min(self.reach);
        let mut best = cap;
        if let Some(cell) = self.geometry.cell_at(point) {
            let off = (point - self.geometry.center(cell)).norm();
            let centre = self.at_cell(cell);
            if centre - off >= cap {
                return cap;
            }
            if centre < self.reach {
                best = best.min(centre + off + FIELD_ROUNDING_M);
            }
        }
        self.nearest_square(point, best).min(self.border_gap(point))
    }

    /// Whether a disc of `radius` around `point` is free of contact: by interpolation if that is certain, else by cell squares.
    #[inline]
    pub fn has_clearance(&self, point: Vector2, radius: f64) -> bool {
        let quick = self.distance(point);
        if quick >= radius + self.overestimate(radius) {
            return true;
        }
        let resolution = self.geometry.resolution;
        quick + resolution >= radius
            && self.clearance(point, radius + resolution) >= radius - FIELD_ROUNDING_M
    }

    /// Largest excess of [`DistanceField::distance`] over the truth near `radius`. A distance's second derivative is at most 1 / distance,
    /// and bilinear interpolation errs by res^2 / 8 of it along either axis.
    #[inline]
    pub fn overestimate(&self, radius: f64) -> f64 {
        let resolution = self.geometry.resolution;
        let diagonal = resolution * std::f64::consts::FRAC_1_SQRT_2;
        if radius > 2.0 * diagonal { resolution * resolution / (4.0 * (radius - diagonal)) } else { diagonal }
    }

    /// The lower and the upper corner of the grid, map frame, m.
    pub fn extent(&self) -> (Vector2, Vector2) {
        let GridGeometry { resolution, origin, width, height } = self.geometry;
        (origin, origin + Vector2::new(width as f64, height as f64) * resolution)
    }

    /// Whether the space outside the grid is an obstacle.
    #[inline]
    pub fn is_walled(&self) -> bool {
        self.unknown == UnknownIs::Obstacle
    }

    /// Whether the cell in this column and row of the lattice is an obstacle, inside the grid or outside.
    pub fn blocks_at(&self, col: i64, row: i64) -> bool {
        let (width, height) = (self.geometry.width as i64, self.geometry.height as i64);
        let inside = (0..width).contains(&col) && (0..height).contains(&row);
        if inside { self.distance[(row * width + col) as usize] == 0.0 } else { self.is_walled() }
    }

    /// Visits the centres of obstacle cells in the box (`low`, `high`) that have a free neighbour: the square nearest to any free point is
    /// among them.
    pub fn for_obstacle_rims_in(&self, low: Vector2, high: Vector2, mut visit: impl FnMut(Vector2)) {
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

    /// In each column, the nearest square is above or below the point's row by the column's gap. A square farther away on the other side is
    /// not nearer to any point of the row.
    fn nearest_square(&self, point: Vector2, cap: f64) -> f64 {
        let GridGeometry { resolution, origin, width, height } = self.geometry;
        let at = (point - origin) / resolution;
        let reach = cap / resolution;
        let index = |at: f64, size: usize| at.floor().clamp(0.0, size as f64 - 1.0) as usize;
        let row = index(at.y, height);
        let mut best = reach * reach;
        for col in index(at.x - reach, width)..=index(at.x + reach, width) {
            let gap = usize::from(self.gap[row * width + col]);
            let across = (at.x - (col as f64 + 0.5)).abs() - 0.5;
            let beside = across.max(0.0).powi(2);
            if gap as f64 - 1.0 > reach || beside >= best {
                continue;
            }
            for other in [row.checked_sub(gap), Some(row + gap)].into_iter().flatten() {
                if other < height && self.gap[other * width + col] == 0 {
                    let along = (at.y - (other as f64 + 0.5)).abs() - 0.5;
                    best = best.min(beside + along.max(0.0).powi(2));
                }
            }
        }
        (best.sqrt() * resolution).min(cap)
    }

    /// Distance of the point from the grid's border if the outside is an obstacle, m.
    #[inline]
    pub fn border_gap(&self, point: Vector2) -> f64 {
        if self.unknown == UnknownIs::Free {
            return f64::INFINITY;
        }
        let (low, high) = self.extent();
        let (a, b) = (point - low, high - point);
        a.x.min(a.y).min(b.x).min(b.y).max(0.0)
    }
}
