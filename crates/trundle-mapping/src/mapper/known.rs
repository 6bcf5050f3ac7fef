use super::GridMapper;
use crate::{GridCell, MapperConfig};
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Vector2};

impl GridMapper {
    /// A map that goes on from a three-valued one, whose cells count as sure as evidence gets.
    ///
    /// # Errors
    /// When the configuration is out of range, or the grid has cells of another size, lies askew of this one's, or reaches beyond
    /// its greatest extent.
    pub fn from_grid(config: MapperConfig, grid: &OccupancyGrid) -> Result<Self, Invalid> {
        let mut mapper = Self::new(config)?;
        let (low, high) = mapper.cells_of(grid.geometry())?;
        mapper.grow(low, high);
        mapper.live.begin();
        for (i, value) in grid.cells().iter().enumerate() {
            let log_odds = match value {
                Cell::Unknown => continue,
                Cell::Free => -mapper.config.clamp_low as f32,
                Cell::Occupied => mapper.config.clamp_high as f32,
            };
            let index = grid.geometry().cell(i);
            let cell = GridCell { x: low.x + index.col as i32, y: low.y + index.row as i32 };
            let evidence = mapper.evidence.entry(cell);
            evidence.log_odds = log_odds;
            if is_surface(grid, index) {
                evidence.add_hit(Vector2::repeat(0.5));
            }
            mapper.live.show(cell, log_odds);
        }
        Ok(mapper)
    }

    /// The lowest and the highest of this map's cells that a grid covers.
    fn cells_of(&self, geometry: &GridGeometry) -> Result<(GridCell, GridCell), Invalid> {
        let GridGeometry { resolution, origin, width, height } = *geometry;
        let own = self.config.resolution;
        if (resolution - own).abs() > 1e-9 {
            return Err(Invalid::new("resolution of the map", resolution, "m", format!("{own}")));
        }
        let (corner, size) = (origin / own, Vector2::new(width as f64, height as f64));
        let rounded = corner.map(f64::round);
        if (corner - rounded).norm() > 1e-3 {
            let value = format!("({}, {})", origin.x, origin.y);
            return Err(Invalid::new("origin of the map", value, "m", format!("multiples of {own}")));
        }
        let most = self.config.half_extent / own;
        if rounded.amax() > most || (rounded + size).amax() > most {
            let value = format!("{width} x {height} cells from ({}, {})", origin.x, origin.y);
            let within = format!("within {} m of the origin", self.config.half_extent);
            return Err(Invalid::new("extent of the map", value, "m", within));
        }
        let middle = Vector2::repeat(0.5);
        Ok((GridCell::containing(rounded + middle), GridCell::containing(rounded + size - middle)))
    }
}

/// Whether a laser can have measured a cell: it is occupied, and free beside. What is inside a wall is nothing to match with.
fn is_surface(grid: &OccupancyGrid, cell: CellIndex) -> bool {
    let GridGeometry { width, height, .. } = *grid.geometry();
    let is_free = |(right, up): (isize, isize)| {
        let (col, row) = (cell.col.checked_add_signed(right), cell.row.checked_add_signed(up));
        let beside = col.zip(row).filter(|(col, row)| *col < width && *row < height);
        beside.is_some_and(|(col, row)| grid.get(CellIndex { col, row }) == Cell::Free)
    };
    grid.get(cell) == Cell::Occupied && [(1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().any(is_free)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_that_does_not_lie_on_the_cells_is_refused_by_name() {
        let from = |resolution, x| {
            let geometry = GridGeometry::new(resolution, Vector2::new(x, 0.0), 3, 3).unwrap();
            let grid = OccupancyGrid::filled(geometry, Cell::Free);
            GridMapper::from_grid(MapperConfig::default(), &grid).map(drop).map_err(|error| error.field)
        };
        assert_eq!(from(0.05, -0.1), Ok(()));
        assert_eq!(from(0.1, -0.1).unwrap_err(), "resolution of the map");
        assert_eq!(from(0.05, 0.02).unwrap_err(), "origin of the map");
        assert_eq!(from(0.05, 1e6).unwrap_err(), "extent of the map");
    }
}
