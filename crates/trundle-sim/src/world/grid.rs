//! The true occupancy grid of a world.

use super::region::Region;
use super::{HeightBand, World};
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, require_positive};

/// Fraction of their side by which cells are shrunk: a wall that ends at a cell's border does not fill the cell. Source: ours.
const CELL_SHRINK_RATIO: f64 = 1e-6;

/// Maximum number of cells of a grid: one byte each. Source: ours.
const MAX_CELLS: f64 = (1_u64 << 31) as f64;

impl World {
    /// The true map: every cell that overlaps a solid in the height band is occupied, all others are free.
    ///
    /// Meshes count with their surface: cells inside a closed shell are free. The grid is in the world frame and covers the whole world;
    /// cells are `resolution` m wide, with borders at multiples of it. Cost: the cells, and the triangles of the band.
    ///
    /// # Errors
    /// When the resolution is not positive or gives more than 2^31 cells.
    pub fn true_grid(&self, resolution: f64, band: HeightBand) -> Result<OccupancyGrid, Invalid> {
        let mut grid = OccupancyGrid::filled(self.grid_geometry(resolution)?, Cell::Free);
        for outlines in self.outlines_in(band) {
            for outline in outlines.iter() {
                fill(&mut grid, &outline);
            }
        }
        Ok(grid)
    }

    fn grid_geometry(&self, resolution: f64) -> Result<GridGeometry, Invalid> {
        require_positive("resolution", resolution, "m")?;
        let low = (self.bounds.min.xy() / resolution).map(f64::floor);
        let high = (self.bounds.max.xy() / resolution).map(f64::ceil);
        let size = (high - low).map(|n| n.max(1.0));
        if size.x * size.y > MAX_CELLS {
            let min = ((self.bounds.max - self.bounds.min).xy().product() / MAX_CELLS).sqrt();
            let value = format!("{resolution} m, {:.3e} x {:.3e} cells", size.x, size.y);
            let expected = format!("at most 2^31 cells: {min:.1e} m or more for this world");
            return Err(Invalid::new("resolution", value, "", expected));
        }
        GridGeometry::new(resolution, low * resolution, size.x as usize, size.y as usize)
    }
}

/// Occupies the cells that an outline reaches into, row by row: of a convex outline each row holds one run of cells.
fn fill(grid: &mut OccupancyGrid, outline: &Region<'_>) {
    let GridGeometry { resolution, origin, width, height } = *grid.geometry();
    let (low, high) = outline.box_of_corners();
    let (bottom, top) = (low.y - outline.radius, high.y + outline.radius);
    let rows = run((bottom - origin.y) / resolution, (top - origin.y) / resolution, height);
    let is_flat = rows.len() == 1;
    for row in rows {
        let line = |row: f64| origin.y + row * resolution;
        let slice = (line(row as f64 + CELL_SHRINK_RATIO), line(row as f64 + 1.0 - CELL_SHRINK_RATIO));
        let (from, to) = if is_flat { (bottom, top) } else { slice };
        let Some((left, right)) = outline.span_between(from, to) else { continue };
        for col in run((left - origin.x) / resolution, (right - origin.x) / resolution, width) {
            grid.set(CellIndex { col, row }, Cell::Occupied);
        }
    }
}

/// Range of cells, of `count`, that overlap the interval from `low` to `high` (in cells); an interval on a border only belongs to one side.
fn run(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
    let (first, last) = ((low - 1.0 + CELL_SHRINK_RATIO).ceil(), (high - CELL_SHRINK_RATIO).floor());
    let seam = ((low + high) / 2.0).floor();
    let (first, last) = if first <= last { (first, last) } else { (seam, seam) };
    first.max(0.0) as usize..((last + 1.0).max(0.0) as usize).min(count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::materials::{Finish, Paint};
    use crate::world::{Cuboid, Cylinder, Shape, Solid};
    use trundle_core::Vector3;

    fn world(shapes: &[Shape]) -> World {
        let solid = |&shape| Solid { shape, finish: Finish::all(Paint::Flat { color: [128; 3] }) };
        World::new(shapes.iter().map(solid).collect(), 1).unwrap()
    }

    fn occupied(world: &World, resolution: f64, low: f64, high: f64) -> usize {
        let grid = world.true_grid(resolution, HeightBand::new(low, high).unwrap()).unwrap();
        grid.cells().iter().filter(|&&cell| cell == Cell::Occupied).count()
    }

    #[test]
    fn a_table_is_four_legs_below_and_a_top_above() {
        let top = Cuboid { center: Vector3::new(1.0, 1.0, 0.7), size: Vector3::new(2.0, 2.0, 0.1), yaw: 0.0 };
        let leg = Cylinder { base: Vector3::new(0.25, 0.25, 0.0), radius: 0.1, height: 0.65 };
        let world = world(&[Shape::Cuboid(top), Shape::Cylinder(leg)]);
        assert_eq!(occupied(&world, 0.5, 0.02, 0.6), 1);
        assert_eq!(occupied(&world, 0.5, 0.02, 0.7), 16);
    }

    #[test]
    fn areas_of_discs_and_turned_boxes_are_right() {
        let post = Cylinder { base: Vector3::new(0.3, 0.2, 0.0), radius: 1.0, height: 1.0 };
        let area = |shape: Shape| occupied(&world(&[shape]), 0.01, 0.1, 0.5) as f64 * 1e-4;
        assert!((area(Shape::Cylinder(post)) - std::f64::consts::PI).abs() < 0.05);
        let size = Vector3::new(2.0, 1.0, 1.0);
        let slab = Cuboid { center: Vector3::new(0.1, 0.0, 0.5), size, yaw: 0.7 };
        assert!((area(Shape::Cuboid(slab)) - 2.0).abs() < 0.05);
    }

    #[test]
    fn absurd_resolutions_are_refused_with_the_size() {
        let post = Cylinder { base: Vector3::zeros(), radius: 10.0, height: 1.0 };
        let (world, band) = (world(&[Shape::Cylinder(post)]), HeightBand::new(0.0, 1.0).unwrap());
        assert!(world.true_grid(f64::NAN, band).is_err());
        let error = world.true_grid(1e-6, band).unwrap_err().to_string();
        assert!(error.contains("2.000e7 x 2.000e7 cells") && error.contains("4.3e-4 m or more"), "{error}");
        assert!(HeightBand::new(1.0, f64::NAN).is_err());
    }

    #[test]
    fn a_wall_on_a_border_belongs_to_one_side() {
        assert_eq!(run(3.0, 3.0, 9), 3..4);
        assert_eq!(run(3.0, 4.0, 9), 3..4);
        assert_eq!(run(2.5, 4.5, 9), 2..5);
        assert_eq!(run(-5.0, -2.0, 9), 0..0);
        assert_eq!(run(9.5, 12.0, 9).len(), 0);
    }
}
