use super::{HeightBand, Outline, World};
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Vector2, require_positive};

/// Cells are shrunk by this fraction, so that a wall that ends on a cell's border does not fill the cell.
const SHRINK: f64 = 1e-6;

impl World {
    /// The true map: every cell that a solid of the height band reaches into is occupied, all others are free.
    ///
    /// The grid lies in the world frame and covers all solids; cells are `resolution` m wide, lines at its multiples.
    ///
    /// # Errors
    /// When the resolution is not positive or so small that there would be more than 2^31 cells.
    pub fn true_grid(&self, resolution: f64, band: HeightBand) -> Result<OccupancyGrid, Invalid> {
        require_positive("resolution", resolution, "m")?;
        let low = (self.bounds.min.xy() / resolution).map(f64::floor);
        let high = (self.bounds.max.xy() / resolution).map(f64::ceil);
        let (width, height) = ((high.x - low.x) as usize, (high.y - low.y) as usize);
        let mut grid = OccupancyGrid::filled(
            GridGeometry::new(resolution, low * resolution, width, height)?,
            Cell::Free,
        );
        for outline in self.obstacles(band).outlines() {
            fill(&mut grid, outline);
        }
        Ok(grid)
    }
}

fn fill(grid: &mut OccupancyGrid, outline: &Outline) {
    let geometry = *grid.geometry();
    let (low, high) = outline.bounds();
    let first = |low: f64, origin: f64| ((low - origin) / geometry.resolution).floor().max(0.0) as usize;
    for row in first(low.y, geometry.origin.y)..=first(high.y, geometry.origin.y).min(geometry.height - 1) {
        for col in first(low.x, geometry.origin.x)..=first(high.x, geometry.origin.x).min(geometry.width - 1)
        {
            let cell = CellIndex { col, row };
            if outline.clearance(&square(geometry.center(cell), geometry.resolution)) <= 0.0 {
                grid.set(cell, Cell::Occupied);
            }
        }
    }
}

fn square(center: Vector2, side: f64) -> Outline {
    let h = side / 2.0 * (1.0 - SHRINK);
    let corners = [(h, h), (-h, h), (-h, -h), (h, -h)].map(|(x, y)| center + Vector2::new(x, y));
    Outline::new(corners.to_vec(), 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paint::{Finish, Paint};
    use crate::world::{Cuboid, Cylinder, Shape, Solid};
    use trundle_core::Vector3;

    #[test]
    fn a_table_is_four_legs_below_and_a_top_above() {
        let finish = Finish::all(Paint::Flat { color: [128; 3] });
        let top = Cuboid { center: Vector3::new(1.0, 1.0, 0.7), size: Vector3::new(2.0, 2.0, 0.1), yaw: 0.0 };
        let leg = Cylinder { base: Vector3::new(0.25, 0.25, 0.0), radius: 0.1, height: 0.65 };
        let solids =
            [Shape::Cuboid(top), Shape::Cylinder(leg)].map(|shape| Solid { shape, finish: finish.clone() });
        let world = World::new(solids.to_vec(), 1).unwrap();
        let occupied = |low, high| {
            let grid = world.true_grid(0.5, HeightBand::new(low, high).unwrap()).unwrap();
            grid.cells().iter().filter(|&&cell| cell == Cell::Occupied).count()
        };
        assert_eq!(occupied(0.02, 0.6), 1);
        assert_eq!(occupied(0.02, 0.7), 16);
        assert!(world.true_grid(f64::NAN, HeightBand::new(0.0, 1.0).unwrap()).is_err());
        assert!(HeightBand::new(1.0, f64::NAN).is_err());
    }
}
