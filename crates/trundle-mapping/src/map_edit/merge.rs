//! Two maps as one.

use super::lattice::lattice_of;
use super::resample::resampled;
use trundle_core::{Cell, Invalid, OccupancyGrid, Pose2};

/// The effect of a map that is merged into another one, in cells.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct MergeCounts {
    /// Unknown cells that became known.
    pub added: usize,
    /// Free cells that became occupied.
    pub occupied: usize,
    /// Occupied cells that became free.
    pub freed: usize,
    /// Known cells that both maps have in common.
    pub shared: usize,
}

/// Both maps on the cells of the first one, which grow as needed. Where the second map is known, it replaces the first one. The second map
/// is resampled once.
///
/// # Errors When no map has a known cell, or the maps lie too far apart for one grid.
pub fn merged(
    first: &OccupancyGrid,
    second: &OccupancyGrid,
    first_from_second: Pose2,
) -> Result<(OccupancyGrid, MergeCounts), Invalid> {
    let geometry = lattice_of(first, &[(second, first_from_second)])?;
    let mut grid = resampled(first, Pose2::IDENTITY, geometry);
    let newer = resampled(second, first_from_second, geometry);
    let mut counts = MergeCounts::default();
    for (i, value) in newer.cells().iter().enumerate().filter(|(_, value)| **value != Cell::Unknown) {
        match (grid.cells()[i], *value) {
            (Cell::Unknown, _) => counts.added += 1,
            (Cell::Free, Cell::Occupied) => counts.occupied += 1,
            (Cell::Occupied, Cell::Free) => counts.freed += 1,
            _ => {}
        }
        counts.shared += usize::from(grid.cells()[i] != Cell::Unknown);
        grid.set(geometry.cell(i), *value);
    }
    Ok((grid, counts))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_newer_map_wins_where_it_is_known() {
        let old = OccupancyGrid::from_ascii(0.1, "##..\n....").unwrap();
        let new = OccupancyGrid::from_ascii(0.1, ".?\n##").unwrap();
        let (grid, counts) = merged(&old, &new, Pose2::new(0.1, 0.0, 0.0)).unwrap();
        assert_eq!(grid, OccupancyGrid::from_ascii(0.1, "#...\n.##.").unwrap());
        assert_eq!(counts, MergeCounts { added: 0, occupied: 2, freed: 1, shared: 3 });
        let (grid, counts) = merged(&old, &new, Pose2::new(0.3, -0.1, 0.0)).unwrap();
        assert_eq!(grid.cells(), OccupancyGrid::from_ascii(0.1, "##..?\n....?\n???##").unwrap().cells());
        assert_eq!((grid.geometry().width, grid.geometry().height, counts.added), (5, 3, 2));
    }
}
