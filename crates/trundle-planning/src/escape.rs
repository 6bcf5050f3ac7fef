//! The way out of a start that is too near to something: one rule for discs, for outlines, and for plans under way.
//!
//! Near where it stands the robot may overlap what it overlaps there, no deeper; from everything else it keeps its distance, and
//! further off from everything. What it overlaps is more than the squares that it covers: a wall goes on to both sides, so the
//! obstacles that hang together with them belong to it, as far as two cells beside the robot. Cost: a field of the cells around.

use crate::{DistanceField, UnknownIs};
use trundle_core::{Cell, GridGeometry, OccupancyGrid, Vector2};

/// How far the robot may have gone before it must have left, m, beside what is missing; in coarse maps, cells.
const ZONE: f64 = 0.2;
const ZONE_CELLS: f64 = 3.0;
/// How far beside the robot an obstacle that it overlaps is still the same one, cells.
const BESIDE: f64 = 2.0;
/// Cells to interpolate between.
const EDGE: f64 = 3.0;

/// Where a robot stands that is too near to something.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Escape {
    start: Vector2,
    zone: f64,
    /// How deep it is inside, m: so much smaller it is taken to be against what it overlaps.
    pub(crate) depth: f64,
    /// All obstacles around but what it overlaps; none where any may be overlapped so deep.
    others: Option<DistanceField>,
}

impl Escape {
    /// For a robot that is `depth` m inside something where its axle is at `start`; near there it may overlap anything so deep.
    pub(crate) fn new(start: Vector2, depth: f64, resolution: f64) -> Self {
        Self { start, zone: zone(depth, resolution), depth, others: None }
    }

    /// The same, keeping off all that it does not overlap at its start. `gap` is the distance between its points there and a
    /// square of the field with this centre, m, 0 where they overlap; no point is further than `radius` m from the axle.
    pub(crate) fn keeping_off_the_rest(
        self,
        field: &DistanceField,
        radius: f64,
        gap: impl Fn(Vector2) -> f64,
    ) -> Self {
        let reach = radius + EDGE * field.geometry().resolution;
        let around = Surroundings::new(field, self.start, self.zone + reach).without_what_is_overlapped(gap);
        Self { others: Some(DistanceField::up_to(reach, &around, UnknownIs::Free)), ..self }
    }

    /// Whether the robot is still near where it stood.
    pub(crate) fn covers(&self, at: Vector2) -> bool {
        (at - self.start).norm() <= self.zone
    }

    /// What must not be overlapped at all; none where nothing is told apart.
    pub(crate) fn others(&self) -> Option<&DistanceField> {
        self.others.as_ref()
    }
}

/// How far from a start that is `depth` m inside something less room is enough, m.
pub(crate) fn zone(depth: f64, resolution: f64) -> f64 {
    depth + ZONE.max(ZONE_CELLS * resolution)
}

/// The cells that a robot which is at most `depth` m inside something at `start` comes near while it leaves.
pub(crate) fn cells_around(lattice: &GridGeometry, start: Vector2, depth: f64, radius: f64) -> GridGeometry {
    let resolution = lattice.resolution;
    let reach = zone(depth, resolution) + radius + 2.0 * EDGE * resolution;
    window(lattice, start, reach).0
}

/// The cells of a lattice within `reach` m of a point, and column and row of the first.
fn window(lattice: &GridGeometry, middle: Vector2, reach: f64) -> (GridGeometry, (i64, i64)) {
    let at = (middle - lattice.origin) / lattice.resolution;
    let cells = (reach / lattice.resolution).ceil() + 1.0;
    let low = at.map(|c| (c - cells).floor());
    let size = 2 * cells as usize + 1;
    let origin = lattice.origin + low * lattice.resolution;
    let geometry = GridGeometry { resolution: lattice.resolution, origin, width: size, height: size };
    (geometry, (low.x as i64, low.y as i64))
}

/// The obstacles around a start.
struct Surroundings {
    geometry: GridGeometry,
    is_obstacle: Vec<bool>,
}

impl Surroundings {
    fn new(field: &DistanceField, start: Vector2, reach: f64) -> Self {
        let (geometry, (left, low)) = window(field.geometry(), start, reach);
        let blocks =
            |i: usize| field.blocks_at(left + (i % geometry.width) as i64, low + (i / geometry.width) as i64);
        Self { geometry, is_obstacle: (0..geometry.len()).map(blocks).collect() }
    }

    /// The same, free where a robot with these gaps overlaps something.
    fn without_what_is_overlapped(mut self, gap: impl Fn(Vector2) -> f64) -> OccupancyGrid {
        let beside = BESIDE * self.geometry.resolution;
        let gap = |cell: usize| gap(self.geometry.center(self.geometry.cell(cell)));
        let gaps: Vec<f64> = (0..self.geometry.len())
            .map(|i| if self.is_obstacle[i] { gap(i) } else { f64::INFINITY })
            .collect();
        let mut stack: Vec<usize> = (0..gaps.len()).filter(|cell| gaps[*cell] <= 0.0).collect();
        while let Some(cell) = stack.pop() {
            if std::mem::replace(&mut self.is_obstacle[cell], false) {
                stack.extend(neighbours(&self.geometry, cell).filter(|near| gaps[*near] <= beside));
            }
        }
        let cells = self.is_obstacle.into_iter().map(|is| if is { Cell::Occupied } else { Cell::Free });
        OccupancyGrid::new(self.geometry, cells.collect()).expect("invariant: a cell for each")
    }
}

fn neighbours(geometry: &GridGeometry, cell: usize) -> impl Iterator<Item = usize> {
    let (width, height) = (geometry.width as i64, geometry.height as i64);
    let (col, row) = (cell as i64 % width, cell as i64 / width);
    let around = (-1..=1).flat_map(move |dy| (-1..=1).map(move |dx| (col + dx, row + dy)));
    around
        .filter(move |(c, r)| (0..width).contains(c) && (0..height).contains(r))
        .map(move |(c, r)| (r * width + c) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::box_gap;

    /// A wall below, overlapped; a box that hangs on nothing; a bar on the wall, further along.
    const AROUND: &str = "
        ...............
        ...............
        .........##....
        .........##....
        ...............
        .............##
        .............##
        ###############
        ###############";

    #[test]
    fn what_is_overlapped_is_the_wall_beside_and_nothing_else() {
        let grid = OccupancyGrid::from_ascii(0.1, AROUND).unwrap();
        let field = DistanceField::from_grid(&grid, UnknownIs::Obstacle);
        let (start, radius) = (Vector2::new(0.65, 0.35), 0.2);
        let gap = |centre| (box_gap(start, centre, 0.05).norm() - radius).max(0.0);
        let escape = Escape::new(start, 0.05, 0.1).keeping_off_the_rest(&field, radius, gap);
        let away = |x: f64, y: f64| escape.others().unwrap().distance(Vector2::new(x, y));
        assert!(away(0.65, 0.15) > 0.15 && away(0.45, 0.15) > 0.0, "the wall that it overlaps");
        assert_eq!((away(0.95, 0.65), away(1.35, 0.35)), (0.0, 0.0), "what it does not");
        assert!(escape.covers(Vector2::new(0.65, 0.69)) && !escape.covers(Vector2::new(0.65, 0.71)));
    }

    #[test]
    fn in_coarse_maps_the_zone_is_counted_in_cells() {
        assert_eq!(zone(0.05, 0.05), 0.25);
        assert!((zone(0.05, 0.2) - 0.65).abs() < 1e-12);
    }
}
