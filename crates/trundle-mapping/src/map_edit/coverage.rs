//! The parts of a cell that the cells of a moved map cover.

use trundle_core::{Cell, CellIndex, GridGeometry, OccupancyGrid, Pose2, Vector2};

/// Samples along the side of a cell, of a cell as large as the map's. Source: ours, shares to 1/64.
const SAMPLES_PER_SIDE: usize = 8;
/// Maximum number of samples along the side of a larger cell. Source: ours.
const MAX_SAMPLES_PER_SIDE: usize = 32;

/// The coverage of a cell that occupied cells of the map touch.
pub(super) struct OccupiedCoverage {
    /// Part of the cell that occupied cells cover, 0 to 1.
    pub share: f64,
    /// The value if the cell is not occupied: free or unknown, of which more covers the cell.
    pub otherwise: Cell,
    /// The occupied cells of the map that the cell touches, by their row-major index.
    pub sources: Vec<usize>,
}

/// The value of a cell of the new lattice.
pub(super) enum Coverage {
    /// No occupied cell touches the cell.
    Open(Cell),
    /// Occupied cells touch it.
    Touched(OccupiedCoverage),
}

/// Coverage of the cells of a new lattice by a moved map.
pub(super) struct CoverageSampler<'a> {
    grid: &'a OccupancyGrid,
    geometry: &'a GridGeometry,
    map_from_target: Pose2,
    samples: usize,
    /// Cells about the map's cell under the centre that a new cell can touch.
    reach: i64,
}

impl<'a> CoverageSampler<'a> {
    pub(super) fn new(grid: &'a OccupancyGrid, target_from_map: Pose2, geometry: &'a GridGeometry) -> Self {
        let ratio = geometry.resolution / grid.geometry().resolution;
        let samples = (SAMPLES_PER_SIDE as f64 * ratio.max(1.0)).ceil() as usize;
        Self {
            grid,
            geometry,
            map_from_target: target_from_map.inverse(),
            samples: samples.min(MAX_SAMPLES_PER_SIDE),
            reach: (ratio * std::f64::consts::FRAC_1_SQRT_2).ceil().max(1.0) as i64,
        }
    }

    /// The coverage of a cell of the new lattice.
    pub(super) fn of(&self, cell: CellIndex) -> Coverage {
        let near = self.nearby(self.geometry.center(cell));
        match near {
            Nearby::Uniform(value) if value != Cell::Occupied => Coverage::Open(value),
            _ => self.sampled(cell),
        }
    }

    fn sampled(&self, cell: CellIndex) -> Coverage {
        let source = self.grid.geometry();
        let mut sources: Vec<usize> = Vec::new();
        let (mut occupied, mut free) = (0_usize, 0_usize);
        for k in 0..self.samples * self.samples {
            let Some(found) = source.cell_at(self.sample(cell, k)).map(|cell| source.linear(cell)) else {
                continue;
            };
            match self.grid.cells()[found] {
                Cell::Occupied => {
                    occupied += 1;
                    if !sources.contains(&found) {
                        sources.push(found);
                    }
                }
                Cell::Free => free += 1,
                Cell::Unknown => {}
            }
        }
        let all = self.samples * self.samples;
        let otherwise = if 2 * free >= all - occupied { Cell::Free } else { Cell::Unknown };
        if occupied == 0 {
            return Coverage::Open(otherwise);
        }
        Coverage::Touched(OccupiedCoverage { share: occupied as f64 / all as f64, otherwise, sources })
    }

    /// Sample `k` of a cell, in the map's frame.
    fn sample(&self, cell: CellIndex, k: usize) -> Vector2 {
        let part = |k: usize| (k as f64 + 0.5) / self.samples as f64;
        let inside =
            Vector2::new(cell.col as f64 + part(k % self.samples), cell.row as f64 + part(k / self.samples));
        self.map_from_target.transform(self.geometry.origin + inside * self.geometry.resolution)
    }

    /// The values of the map about a point of the new lattice.
    fn nearby(&self, center: Vector2) -> Nearby {
        let GridGeometry { resolution, origin, width, height } = *self.grid.geometry();
        let at = ((self.map_from_target.transform(center) - origin) / resolution).map(f64::floor);
        let (col, row) = (at.x as i64, at.y as i64);
        let value = |col: i64, row: i64| {
            let inside = (0..width as i64).contains(&col) && (0..height as i64).contains(&row);
            if inside { self.grid.cells()[row as usize * width + col as usize] } else { Cell::Unknown }
        };
        let first = value(col, row);
        for y in row - self.reach..=row + self.reach {
            for x in col - self.reach..=col + self.reach {
                if value(x, y) != first {
                    return Nearby::Mixed;
                }
            }
        }
        Nearby::Uniform(first)
    }
}

enum Nearby {
    Uniform(Cell),
    Mixed,
}
