//! Two maps on coarse cells: values of the first one, and points of the second one.

use super::map_shape::MapShape;
use std::collections::BTreeMap;
use trundle_core::{Cell, Vector2};

/// Value of a wall on a wall. Source: ours; sums of all walls fit 16 bits.
pub(super) const WALL_VALUE: f64 = 32.0;
/// Value of a wall on free floor, as a part of the value of a wall on a wall. Source: ours.
const CONTRADICTION_SHARE: f64 = -1.0;
/// Width of the likelihood of a wall \[coarse cells\]. Source: ours.
const WALL_WIDTH_CELLS: f64 = 0.6;
/// Likelihood below which a wall does not agree. Source: ours.
const MIN_LIKELIHOOD: f64 = 0.1;
/// Smallest value of a free place: sums of all places fit 16 bits. Source: ours.
const MIN_FREE_VALUE: f64 = -64.0;
/// Maximum numbers of points on walls and on free floor: sums of their values fit 16 bits. Source: ours.
const MAX_WALL_POINTS: usize = 400;
const MAX_FREE_POINTS: usize = 200;

/// The second map as points about its middle \[m\].
pub(super) struct CoarsePoints {
    /// Points on walls.
    pub walls: Vec<Vector2>,
    /// Points on free floor.
    pub free: Vec<Vector2>,
    /// Area that a point on free floor stands for, over the length that a point on a wall stands for \[coarse cells\].
    pub free_weight: f64,
}

impl CoarsePoints {
    /// Points of a map, one for each cell of `cell` m.
    pub(super) fn of(second: &MapShape, cell: f64) -> Self {
        let key = |p: &Vector2| ((p.y / cell).floor() as i64, (p.x / cell).floor() as i64);
        let mut walls: BTreeMap<(i64, i64), (Vector2, f64)> = BTreeMap::new();
        for point in &second.surface {
            let sum = walls.entry(key(point)).or_insert((Vector2::zeros(), 0.0));
            *sum = (sum.0 + point, sum.1 + 1.0);
        }
        let walls: Vec<Vector2> =
            walls.into_values().map(|(sum, count)| sum / count - second.middle).collect();
        let free = free_places(second, cell);
        let (all_walls, all_free) = (walls.len() as f64, free.len() as f64);
        let (walls, free) = (thinned(walls, MAX_WALL_POINTS), thinned(free, MAX_FREE_POINTS));
        let per_point = |all: f64, points: usize| all / points.max(1) as f64;
        let free_weight = per_point(all_free, free.len()) / per_point(all_walls, walls.len());
        Self { walls, free, free_weight }
    }
}

/// Points at equal steps of the list, at most `max`.
fn thinned(points: Vec<Vector2>, max: usize) -> Vec<Vector2> {
    let stride = points.len().div_ceil(max).max(1);
    points.into_iter().step_by(stride).collect()
}

/// Middles of coarse cells on free floor, a coarse cell away from walls, about the middle of the map.
fn free_places(map: &MapShape, cell: f64) -> Vec<Vector2> {
    let (corner, size) = map.extent();
    let (cols, rows) = ((size.x / cell) as usize, (size.y / cell) as usize);
    let middle = |i: usize| corner + Vector2::new((i % cols) as f64 + 0.5, (i / cols) as f64 + 0.5) * cell;
    let is_free = |p: &Vector2| map.at(*p) == Cell::Free && map.distance(*p).is_some_and(|d| d > cell);
    let places = (0..cols * rows).map(middle).filter(is_free).map(|p| p - map.middle);
    // The search reaches as far as the walls.
    places.filter(|p| p.norm() <= map.radius).collect()
}

/// The first map on coarse cells, with a border of zeros.
pub(super) struct CoarseField {
    /// Side of a cell \[m\].
    pub cell: f64,
    /// Lower left corner of the border \[m\].
    pub corner: Vector2,
    pub width: usize,
    pub height: usize,
    /// Value of a wall of the second map in each cell.
    pub walls: Vec<i16>,
    /// Value of free floor of the second map in each cell.
    pub free: Vec<i16>,
}

impl CoarseField {
    /// The field of a map with `border` cells about it.
    pub(super) fn of(first: &MapShape, cell: f64, border: usize, free_weight: f64) -> Self {
        let (low, size) = first.extent();
        let side = |length: f64| (length / cell).ceil() as usize + 2 * border;
        let (width, height) = (side(size.x), side(size.y));
        let corner = low - Vector2::repeat(border as f64 * cell);
        let middles = (0..width * height)
            .map(|i| corner + Vector2::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5) * cell);
        let walls = middles.map(|at| wall_value(first, at, cell).round() as i16).collect();
        let mut field = Self { cell, corner, width, height, walls, free: vec![0; width * height] };
        field.set_free(first, free_weight);
        field
    }

    /// The contradiction of free floor in each cell: the walls of the first map in it.
    fn set_free(&mut self, first: &MapShape, free_weight: f64) {
        let mut lengths = vec![0.0; self.free.len()];
        for point in &first.surface {
            let at = (point - self.corner) / self.cell;
            lengths[at.y as usize * self.width + at.x as usize] += first.resolution() / self.cell;
        }
        for (value, length) in self.free.iter_mut().zip(lengths) {
            let contradiction: f64 = CONTRADICTION_SHARE * WALL_VALUE * free_weight * f64::min(length, 1.0);
            *value = contradiction.max(MIN_FREE_VALUE).round() as i16;
        }
    }
}

fn wall_value(first: &MapShape, at: Vector2, cell: f64) -> f64 {
    let Some(distance) = first.distance(at) else { return 0.0 };
    let likelihood = (-0.5 * (distance / (WALL_WIDTH_CELLS * cell)).powi(2)).exp();
    if likelihood >= MIN_LIKELIHOOD {
        WALL_VALUE * likelihood
    } else if first.at(at) == Cell::Free {
        WALL_VALUE * CONTRADICTION_SHARE
    } else {
        0.0
    }
}
