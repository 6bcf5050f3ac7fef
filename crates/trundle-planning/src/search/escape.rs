//! Leaving a start with too little clearance: one rule for discs, for polygons, and for plans of a moving robot.
//!
//! Near the start the robot may overlap the obstacles that it overlaps at the start, but no deeper. All other obstacles, and all obstacles
//! farther away, require the full clearance. The overlapped obstacle is larger than the covered cells, as a wall continues on both sides.
//! Connected obstacle cells therefore belong to it, up to two cells from the robot. Cost: a distance field of the cells around.

use trundle_core::{Cell, GridGeometry, OccupancyGrid, Vector2};
use trundle_grid::{DistanceField, UnknownIs};

/// Distance within which the robot must have left the overlap, m, in addition to its depth. Source: ours.
const ESCAPE_ZONE_M: f64 = 0.2;
/// The same distance in coarse maps, cells; the larger of the two counts. Source: ours.
const ESCAPE_ZONE_CELLS: f64 = 3.0;
/// Distance from the robot up to which a connected cell belongs to the overlapped obstacle, cells. Source: ours.
const SAME_OBSTACLE_CELLS: f64 = 2.0;
/// Margin of cells for interpolation in the distance field. Source: ours.
const INTERPOLATION_MARGIN_CELLS: f64 = 3.0;

/// The zone around a start with too little clearance.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Escape {
    start: Vector2,
    zone: f64,
    /// Depth of the overlap, m: the robot counts as smaller by this amount against the overlapped obstacles.
    pub(crate) depth: f64,
    /// All obstacles around except the overlapped one; `None` if any obstacle may be overlapped by `depth`.
    others: Option<DistanceField>,
}

impl Escape {
    /// A zone for a robot that overlaps an obstacle by `depth` m with its axle at `start`. Near this position it may overlap any obstacle
    /// by that depth.
    pub(crate) fn new(start: Vector2, depth: f64, resolution: f64) -> Self {
        Self { start, zone: zone(depth, resolution), depth, others: None }
    }

    /// The same zone with full clearance from all obstacles that are not overlapped at the start. `gap` is the distance between the
    /// footprint at the start and a cell with this centre, m, 0 if they overlap. No point is farther than `radius` m from the axle.
    pub(crate) fn with_clearance_from_others(
        self,
        field: &DistanceField,
        radius: f64,
        gap: impl Fn(Vector2) -> f64,
    ) -> Self {
        let reach = radius + INTERPOLATION_MARGIN_CELLS * field.geometry().resolution;
        let around = LocalObstacles::new(field, self.start, self.zone + reach).without_overlapped(gap);
        Self { others: Some(DistanceField::up_to(reach, &around, UnknownIs::Free)), ..self }
    }

    /// Whether a point is inside the zone.
    pub(crate) fn covers(&self, at: Vector2) -> bool {
        (at - self.start).norm() <= self.zone
    }

    /// Obstacles that require full clearance; `None` if all may be overlapped.
    pub(crate) fn others(&self) -> Option<&DistanceField> {
        self.others.as_ref()
    }
}

/// Radius of the zone around a start that overlaps by `depth` m, m.
pub(crate) fn zone(depth: f64, resolution: f64) -> f64 {
    depth + ESCAPE_ZONE_M.max(ESCAPE_ZONE_CELLS * resolution)
}

/// The cells that matter to a robot that leaves an overlap of at most `depth` m at `start`.
pub(crate) fn cells_around(lattice: &GridGeometry, start: Vector2, depth: f64, radius: f64) -> GridGeometry {
    let resolution = lattice.resolution;
    let reach = zone(depth, resolution) + radius + 2.0 * INTERPOLATION_MARGIN_CELLS * resolution;
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
struct LocalObstacles {
    geometry: GridGeometry,
    is_obstacle: Vec<bool>,
}

impl LocalObstacles {
    fn new(field: &DistanceField, start: Vector2, reach: f64) -> Self {
        let (geometry, (left, low)) = window(field.geometry(), start, reach);
        let blocks =
            |i: usize| field.blocks_at(left + (i % geometry.width) as i64, low + (i / geometry.width) as i64);
        Self { geometry, is_obstacle: (0..geometry.len()).map(blocks).collect() }
    }

    /// The same cells, free where a footprint with these gaps overlaps an obstacle.
    fn without_overlapped(mut self, gap: impl Fn(Vector2) -> f64) -> OccupancyGrid {
        let beside = SAME_OBSTACLE_CELLS * self.geometry.resolution;
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
    use trundle_collision::square::point_to_square;

    /// An overlapped wall at the bottom, a separate box, and a bar on the wall farther along.
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
    fn only_the_overlapped_wall_may_be_overlapped() {
        let grid = OccupancyGrid::from_ascii(0.1, AROUND).unwrap();
        let field = DistanceField::from_grid(&grid, UnknownIs::Obstacle);
        let (start, radius) = (Vector2::new(0.65, 0.35), 0.2);
        let gap = |centre| (point_to_square(start, centre, 0.05).norm() - radius).max(0.0);
        let escape = Escape::new(start, 0.05, 0.1).with_clearance_from_others(&field, radius, gap);
        let away = |x: f64, y: f64| escape.others().unwrap().distance(Vector2::new(x, y));
        assert!(away(0.65, 0.15) > 0.15 && away(0.45, 0.15) > 0.0, "the overlapped wall");
        assert_eq!((away(0.95, 0.65), away(1.35, 0.35)), (0.0, 0.0), "other obstacles");
        assert!(escape.covers(Vector2::new(0.65, 0.69)) && !escape.covers(Vector2::new(0.65, 0.71)));
    }

    #[test]
    fn the_zone_of_a_coarse_map_is_counted_in_cells() {
        assert_eq!(zone(0.05, 0.05), 0.25);
        assert!((zone(0.05, 0.2) - 0.65).abs() < 1e-12);
    }
}
