//! Questions to the floor map.

use trundle_core::{Cell, CellIndex, OccupancyGrid, Vector2};

/// The cells whose centres are within `radius` of a point, m; empty around a point outside the map.
pub(crate) fn cells_about(
    grid: &OccupancyGrid,
    at: Vector2,
    radius: f64,
) -> impl Iterator<Item = CellIndex> + use<> {
    let geometry = *grid.geometry();
    let reach = (radius / geometry.resolution).ceil() as usize;
    let around = move |at: usize, size: usize| at.saturating_sub(reach)..(at + reach + 1).min(size);
    let square = move |CellIndex { col, row }| {
        around(row, geometry.height)
            .flat_map(move |row| around(col, geometry.width).map(move |col| CellIndex { col, row }))
    };
    geometry
        .cell_at(at)
        .into_iter()
        .flat_map(square)
        .filter(move |cell| (geometry.center(*cell) - at).norm() < radius)
}

/// Whether no occupied cell is between two points. The last `own_size` m are ignored, because an obstacle hides its own cells.
pub(crate) fn is_in_sight(grid: &OccupancyGrid, from: Vector2, to: Vector2, own_size: f64) -> bool {
    let (way, step) = (to - from, grid.geometry().resolution / 2.0);
    let count = ((way.norm() - own_size).max(0.0) / step) as usize;
    let mut points = (0..count).map(|i| from + way * (i as f64 * step / way.norm()));
    !points.any(|point| grid.at(point) == Cell::Occupied)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_disc_of_cells_ends_at_the_rim_and_at_the_edge_of_the_map() {
        let grid = OccupancyGrid::from_ascii(0.1, &vec![".".repeat(20); 20].join("\n")).unwrap();
        let at = Vector2::new(1.0, 0.1);
        let cells: Vec<_> = cells_about(&grid, at, 0.3).collect();
        let brute = (0..grid.geometry().len()).map(|k| grid.geometry().cell(k));
        let brute: Vec<_> = brute.filter(|c| (grid.geometry().center(*c) - at).norm() < 0.3).collect();
        assert_eq!(cells, brute);
        assert_eq!(cells_about(&grid, Vector2::new(-1.0, 0.0), 0.3).count(), 0);
    }

    #[test]
    fn a_wall_hides_what_is_behind_it_and_not_itself() {
        let grid = OccupancyGrid::from_ascii(0.1, "..........\n.....#....\n..........\n").unwrap();
        let [here, wall, behind] = [0.05, 0.55, 0.95].map(|x| Vector2::new(x, 0.15));
        assert!(!is_in_sight(&grid, here, behind, 0.0));
        assert!(!is_in_sight(&grid, here, wall, 0.0));
        assert!(is_in_sight(&grid, here, wall, 0.1));
        assert!(is_in_sight(&grid, here, here, 0.0));
    }
}
