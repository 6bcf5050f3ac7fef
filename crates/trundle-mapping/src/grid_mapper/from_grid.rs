//! Map that continues from a saved occupancy grid.

use super::mapper::GridMapper;
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Vector2};
use trundle_grid::{GridCell, MapperConfig};

impl GridMapper {
    /// Map that continues from a three-valued grid. Each known cell gets the log-odds of its clamp.
    ///
    /// Scans match against the walls of the grid from the first scan on. Hits are assumed at the centres of the surface cells, since a
    /// saved grid does not store them. The error of a wall is up to half a cell, alike for all scans, until new hits arrive.
    ///
    /// # Errors
    /// When the configuration is out of range. Also when the grid has another resolution, an origin off the multiples of the resolution, or
    /// an extent beyond `half_extent`.
    pub fn from_grid(config: MapperConfig, grid: &OccupancyGrid) -> Result<Self, Invalid> {
        let mut mapper = Self::new(config)?;
        let (low, high) = cells_of(mapper.config(), grid.geometry())?;
        mapper.begin_with(low, high);
        for (i, value) in grid.cells().iter().enumerate() {
            let index = grid.geometry().cell(i);
            let cell = GridCell { x: low.x + index.col as i32, y: low.y + index.row as i32 };
            mapper.set_known(cell, *value, is_surface(grid, index));
        }
        Ok(mapper)
    }

    /// Refuses a grid that [`GridMapper::from_grid`] cannot continue from.
    ///
    /// # Errors
    /// When the grid has another resolution, an origin off the multiples of the resolution, or an extent beyond `half_extent`.
    pub fn require_fits(config: &MapperConfig, grid: &GridGeometry) -> Result<(), Invalid> {
        cells_of(config, grid).map(drop)
    }
}

/// Lowest and highest cell that a grid of this geometry covers.
fn cells_of(config: &MapperConfig, geometry: &GridGeometry) -> Result<(GridCell, GridCell), Invalid> {
    let GridGeometry { origin, width, height, .. } = *geometry;
    let own = config.resolution;
    geometry.require_lattice(own)?;
    let (corner, size) = (origin / own, Vector2::new(width as f64, height as f64));
    let rounded = corner.map(f64::round);
    let limit = config.half_extent / own;
    if rounded.amax() > limit || (rounded + size).amax() > limit {
        let value = format!("{width} x {height} cells from ({}, {})", origin.x, origin.y);
        let within = format!("within {} m of the origin", config.half_extent);
        return Err(Invalid::new("extent of the map", value, "m", within));
    }
    let middle = Vector2::repeat(0.5);
    Ok((GridCell::containing(rounded + middle), GridCell::containing(rounded + size - middle)))
}

/// Whether a cell is occupied and has a free neighbour. Scans match against these cells only.
///
/// A surface is the near side of a solid wall, and both sides of a wall that noise has drawn two cells thick. Deeper cells would pull
/// scans into solid walls.
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
    fn scans_match_against_the_surface_of_a_wall_and_not_its_inside() {
        let geometry = GridGeometry::new(0.05, Vector2::zeros(), 12, 7).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        (0..7).for_each(|row| (3..12).for_each(|col| grid.set(CellIndex { col, row }, Cell::Occupied)));
        let mapper = GridMapper::from_grid(MapperConfig::default(), &grid).unwrap();
        let has_hit = |x| mapper.evidence().get(GridCell { x, y: 3 }).unwrap().hit().is_some();
        assert_eq!([2, 3, 4, 8].map(has_hit), [false, true, false, false]);
    }

    #[test]
    fn a_grid_off_the_cells_is_refused_by_field() {
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
