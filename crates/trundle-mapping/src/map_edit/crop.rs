//! Parts of a map: its cells unchanged, its frame unchanged.

use trundle_core::{Cell, CellIndex, GridGeometry, Invalid, OccupancyGrid, Vector2};

/// Part of a cell by which a box may miss a border between cells without taking in the next cell. Source: ours.
const BORDER_ROUNDING_CELLS: f64 = 1e-6;

/// The cells that a box of the map frame touches, from its `low` to its `high` corner \[m\]; a box beyond the map ends at the map's border.
///
/// # Errors
/// When the box has no area or no cell of the map.
pub fn cropped(grid: &OccupancyGrid, low: Vector2, high: Vector2) -> Result<OccupancyGrid, Invalid> {
    let GridGeometry { resolution, origin, width, height } = *grid.geometry();
    if !(low.x < high.x && low.y < high.y) {
        let value = box_text(low, high);
        return Err(Invalid::new("box", value, "m", "corners with X0 < X1 and Y0 < Y1"));
    }
    let first = |low: f64, side: usize| {
        (low / resolution + BORDER_ROUNDING_CELLS).floor().clamp(0.0, side as f64) as usize
    };
    let end = |high: f64, side: usize| {
        (high / resolution - BORDER_ROUNDING_CELLS).ceil().clamp(0.0, side as f64) as usize
    };
    let (low_cell, high_cell) = (low - origin, high - origin);
    let cols = first(low_cell.x, width)..end(high_cell.x, width);
    let rows = first(low_cell.y, height)..end(high_cell.y, height);
    if cols.is_empty() || rows.is_empty() {
        let far = origin + Vector2::new(width as f64, height as f64) * resolution;
        let expected = format!("a part of the map, which is {} m", box_text(origin, far));
        return Err(Invalid::new("box", box_text(low, high), "m", expected));
    }
    part(grid, (cols.start, rows.start), (cols.len(), rows.len()))
}

/// The smallest part of a map with all its known cells.
///
/// # Errors
/// When the map has no known cell.
pub fn known_part(grid: &OccupancyGrid) -> Result<OccupancyGrid, Invalid> {
    let geometry = grid.geometry();
    let known = |i: &usize| grid.cells()[*i] != Cell::Unknown;
    let mut cells = (0..geometry.len()).filter(known).map(|i| geometry.cell(i));
    let Some(start) = cells.next() else {
        return Err(Invalid::new("number of known cells", 0, "", "1 or more"));
    };
    let (low, high) = cells.fold((start, start), |(low, high), cell| {
        let lower = CellIndex { col: low.col.min(cell.col), row: low.row.min(cell.row) };
        (lower, CellIndex { col: high.col.max(cell.col), row: high.row.max(cell.row) })
    });
    part(grid, (low.col, low.row), (high.col - low.col + 1, high.row - low.row + 1))
}

/// The part of `size` cells whose lower left cell is `first`.
fn part(grid: &OccupancyGrid, first: (usize, usize), size: (usize, usize)) -> Result<OccupancyGrid, Invalid> {
    let GridGeometry { resolution, origin, width, .. } = *grid.geometry();
    let corner = origin + Vector2::new(first.0 as f64, first.1 as f64) * resolution;
    let rows = (first.1..first.1 + size.1).map(|row| row * width + first.0);
    let cells = rows.flat_map(|start| grid.cells()[start..start + size.0].iter().copied()).collect();
    OccupancyGrid::new(GridGeometry::new(resolution, corner, size.0, size.1)?, cells)
}

fn box_text(low: Vector2, high: Vector2) -> String {
    // Without the rounding of their computation.
    let [x0, y0, x1, y1] = [low.x, low.y, high.x, high.y].map(|v| (v * 1e6).round() / 1e6);
    format!("({x0}, {y0}) to ({x1}, {y1})")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map() -> OccupancyGrid {
        OccupancyGrid::from_ascii(0.5, "?????\n?#..?\n?.#.?\n?????").unwrap()
    }

    #[test]
    fn a_box_takes_whole_cells_and_keeps_the_frame() {
        let map = map();
        let part = cropped(&map, Vector2::new(0.6, 0.5), Vector2::new(1.5, 5.0)).unwrap();
        assert_eq!(part.geometry().origin, Vector2::new(0.5, 0.5));
        assert_eq!((part.geometry().width, part.geometry().height), (2, 3));
        for i in 0..part.geometry().len() {
            let at = part.geometry().center(part.geometry().cell(i));
            assert_eq!(part.at(at), map.at(at));
        }
        let whole = cropped(&map, Vector2::new(-9.0, -9.0), Vector2::new(9.0, 9.0)).unwrap();
        assert_eq!(whole, map);
    }

    #[test]
    fn the_known_part_has_no_unknown_border() {
        let known = known_part(&map()).unwrap();
        assert_eq!(known.geometry().origin, Vector2::new(0.5, 0.5));
        assert_eq!(known.cells(), OccupancyGrid::from_ascii(0.5, "#..\n.#.").unwrap().cells());
        assert!(known_part(&OccupancyGrid::from_ascii(0.5, "??").unwrap()).is_err());
    }

    #[test]
    fn boxes_without_a_cell_are_refused_with_the_maps_extent() {
        let refused =
            |low: [f64; 2], high: [f64; 2]| cropped(&map(), low.into(), high.into()).unwrap_err().to_string();
        assert_eq!(
            refused([3.0, 3.0], [4.0, 4.0]),
            "box is (3, 3) to (4, 4) m, expected a part of the map, which is (0, 0) to (2.5, 2) m"
        );
        assert!(refused([1.0, 1.0], [1.0, 2.0]).contains("X0 < X1"));
        assert!(refused([f64::NAN, 1.0], [1.0, 2.0]).contains("X0 < X1"));
    }
}
