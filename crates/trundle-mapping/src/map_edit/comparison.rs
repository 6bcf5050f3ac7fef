//! Two maps, cell by cell.

use super::lattice::lattice_of;
use super::resample::resampled;
use trundle_core::{Cell, GridGeometry, Invalid, OccupancyGrid, Pose2};
use trundle_grid::{DistanceField, UnknownIs};

/// The values of a place in the first and in the second map.
pub type CellPair = [Cell; 2];

/// Two maps on the cells of the first one.
#[derive(Debug, Clone, PartialEq)]
pub struct MapComparison {
    geometry: GridGeometry,
    pairs: Vec<CellPair>,
}

impl MapComparison {
    /// Compares two maps on the cells of the first one. Occupied cells of the maps agree if they are at most `within` m apart; both then
    /// count as occupied in both maps.
    ///
    /// # Errors
    /// When no map has a known cell, or the maps lie too far apart for one grid.
    pub fn new(
        first: &OccupancyGrid,
        second: &OccupancyGrid,
        first_from_second: Pose2,
        within: f64,
    ) -> Result<Self, Invalid> {
        let geometry = lattice_of(first, &[(second, first_from_second)])?;
        let first = resampled(first, Pose2::IDENTITY, geometry);
        let second = resampled(second, first_from_second, geometry);
        let mut pairs: Vec<CellPair> =
            first.cells().iter().zip(second.cells()).map(|(a, b)| [*a, *b]).collect();
        if within > 0.0 {
            join_near(&mut pairs, &first, &second, within);
        }
        Ok(Self { geometry, pairs })
    }

    /// Position of the cells.
    #[must_use]
    pub fn geometry(&self) -> &GridGeometry {
        &self.geometry
    }

    /// The values of each cell, row by row from the lowest y.
    #[must_use]
    pub fn pairs(&self) -> &[CellPair] {
        &self.pairs
    }

    /// Number of cells with these values.
    #[must_use]
    pub fn count(&self, pair: CellPair) -> usize {
        self.pairs.iter().filter(|found| **found == pair).count()
    }
}

/// Makes an occupied cell occupied in both maps if the other map has an occupied cell within `within` m of its centre.
fn join_near(pairs: &mut [CellPair], first: &OccupancyGrid, second: &OccupancyGrid, within: f64) {
    let half = first.geometry().resolution / 2.0;
    // Distances are from a centre to the near side of a square.
    let field = |grid| DistanceField::up_to(within + half, grid, UnknownIs::Free);
    let fields = [field(first), field(second)];
    let is_near = |field: &DistanceField, i: usize| {
        field.at_linear(i) <= within - half + 1e-6 || field.at_linear(i) == 0.0
    };
    for (i, pair) in pairs.iter_mut().enumerate() {
        let is_one = (pair[0] == Cell::Occupied) != (pair[1] == Cell::Occupied);
        if is_one && fields.iter().all(|field| is_near(field, i)) {
            *pair = [Cell::Occupied; 2];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::Vector2;

    fn grid(art: &str) -> OccupancyGrid {
        OccupancyGrid::from_ascii(0.1, art).unwrap()
    }

    #[test]
    fn pairs_are_counted_on_the_cells_of_the_first_map() {
        let found =
            MapComparison::new(&grid("##.?\n...."), &grid("#.#.\n??.."), Pose2::IDENTITY, 0.0).unwrap();
        use Cell::{Free, Occupied, Unknown};
        assert_eq!(found.count([Occupied, Occupied]), 1);
        assert_eq!(found.count([Occupied, Free]), 1);
        assert_eq!(found.count([Free, Occupied]), 1);
        assert_eq!(found.count([Free, Unknown]), 2);
        assert_eq!(found.count([Unknown, Free]), 1);
        assert_eq!(found.count([Free, Free]), 2);
    }

    #[test]
    fn walls_a_cell_apart_agree_within_a_cell() {
        let (a, b) = (grid("..#...\n..#..."), grid("...#..\n...#.."));
        let count = |within| {
            let found = MapComparison::new(&a, &b, Pose2::IDENTITY, within).unwrap();
            (found.count([Cell::Occupied; 2]), found.count([Cell::Occupied, Cell::Free]))
        };
        assert_eq!((count(0.0), count(0.09), count(0.1)), ((0, 2), (0, 2), (4, 0)));
    }

    #[test]
    fn a_map_of_another_origin_and_cell_size_is_compared() {
        let (coarse, fine) =
            (grid("#.\n.."), OccupancyGrid::from_ascii(0.05, "##..\n##..\n....\n....").unwrap());
        let found = MapComparison::new(&coarse, &fine, Pose2::IDENTITY, 0.0).unwrap();
        assert_eq!((found.count([Cell::Occupied; 2]), found.count([Cell::Free; 2])), (1, 3));
        let away = MapComparison::new(&coarse, &fine, Pose2::new(0.3, 0.0, 0.0), 0.0).unwrap();
        assert_eq!(away.geometry().width, 5);
        assert_eq!(away.geometry().origin, Vector2::zeros());
        assert_eq!(away.count([Cell::Unknown, Cell::Occupied]), 1);
    }
}
