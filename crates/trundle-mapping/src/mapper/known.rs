use super::GridMapper;
use crate::{GridCell, MapperConfig};
use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Vector2};

impl GridMapper {
    /// A map that goes on from a three-valued one, whose cells count as sure as evidence gets. Scans are matched with its walls from
    /// the first on, at the middles of their cells, since where in them the hits were is not saved: half a cell may be wrong there, for
    /// all scans alike, until new hits tell it better.
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

/// Whether scans are to be matched with a cell: it is occupied, and free beside. The surface is at the near side of that cell in a wall
/// that a plan shows solid, and at its far side where noise has drawn a wall two cells thick; deeper cells would pull scans into
/// solid walls.
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
    fn what_is_deep_inside_a_wall_is_nothing_to_match_with() {
        let geometry = GridGeometry::new(0.05, Vector2::zeros(), 12, 7).unwrap();
        let mut grid = OccupancyGrid::filled(geometry, Cell::Free);
        (0..7).for_each(|row| (3..12).for_each(|col| grid.set(CellIndex { col, row }, Cell::Occupied)));
        let mapper = GridMapper::from_grid(MapperConfig::default(), &grid).unwrap();
        let is_site = |x| mapper.evidence.get(GridCell { x, y: 3 }).unwrap().hit().is_some();
        assert_eq!([2, 3, 4, 8].map(is_site), [false, true, false, false]);
    }

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
