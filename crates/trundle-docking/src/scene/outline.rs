use crate::geometry::Segment;
use trundle_core::{CellIndex, GridGeometry, Vector2};

/// The outlines of a grid's occupied cells, as long as they run straight: between an occupied cell and one that is not.
///
/// `blocks` says which cells stand in the way.
pub fn outlines(geometry: &GridGeometry, blocks: impl Fn(CellIndex) -> bool) -> Vec<Segment> {
    let at = |col: isize, row: isize| {
        let inside =
            col >= 0 && row >= 0 && (col as usize) < geometry.width && (row as usize) < geometry.height;
        inside && blocks(CellIndex { col: col as usize, row: row as usize })
    };
    let mut pieces = Vec::new();
    for row in 0..=geometry.height as isize {
        let differs = |col: isize| at(col, row) != at(col, row - 1);
        runs(geometry.width, differs, |from, to| pieces.push(piece(geometry, (from, row), (to, row))));
    }
    for col in 0..=geometry.width as isize {
        let differs = |row: isize| at(col, row) != at(col - 1, row);
        runs(geometry.height, differs, |from, to| pieces.push(piece(geometry, (col, from), (col, to))));
    }
    pieces
}

/// Runs of cells along one line, from and to.
fn runs(count: usize, holds: impl Fn(isize) -> bool, mut found: impl FnMut(isize, isize)) {
    let mut start = None;
    for i in 0..=count as isize {
        let on = i < count as isize && holds(i);
        match (on, start) {
            (true, None) => start = Some(i),
            (false, Some(from)) => {
                found(from, i);
                start = None;
            }
            _ => {}
        }
    }
}

fn piece(geometry: &GridGeometry, from: (isize, isize), to: (isize, isize)) -> Segment {
    let corner = |(col, row): (isize, isize)| {
        geometry.origin + Vector2::new(col as f64, row as f64) * geometry.resolution
    };
    Segment { a: corner(from), b: corner(to) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_core::{Cell, OccupancyGrid};

    #[test]
    fn a_wall_of_cells_has_four_sides() {
        let grid = OccupancyGrid::from_ascii(0.5, "......\n.####.\n......").unwrap();
        let pieces = outlines(grid.geometry(), |cell| grid.get(cell) == Cell::Occupied);
        assert_eq!(pieces.len(), 4);
        let length: f64 = pieces.iter().map(|s| (s.b - s.a).norm()).sum();
        assert!((length - 5.0).abs() < 1e-12);
    }
}
