//! Outlines of blocking cells.

use crate::scene::cells::Cells;
use trundle_collision::Segment;
use trundle_core::{GridGeometry, Vector2};

/// The outlines of blocking cells, joined along straight lines: the borders between blocking and free cells.
pub fn outlines(cells: &Cells) -> Vec<Segment> {
    let (geometry, (left, right), (low, high)) = (cells.geometry(), cells.cols, cells.rows);
    let at = |col: isize, row: isize| col >= 0 && row >= 0 && cells.blocks(col as usize, row as usize);
    let (left, right, low, high) = (left as isize, right as isize, low as isize, high as isize);
    let mut pieces = Vec::new();
    for row in low..=high {
        let differs = |col: isize| at(col, row) != at(col, row - 1);
        runs(left, right, differs, |from, to| pieces.push(piece(geometry, (from, row), (to, row))));
    }
    for col in left..=right {
        let differs = |row: isize| at(col, row) != at(col - 1, row);
        runs(low, high, differs, |from, to| pieces.push(piece(geometry, (col, from), (col, to))));
    }
    pieces
}

/// Runs of cells along one line, from and to.
fn runs(first: isize, end: isize, holds: impl Fn(isize) -> bool, mut found: impl FnMut(isize, isize)) {
    let mut start = None;
    for i in first..=end {
        let on = i < end && holds(i);
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
    use trundle_core::OccupancyGrid;

    #[test]
    fn a_wall_of_cells_has_four_sides() {
        let grid = OccupancyGrid::from_ascii(0.5, "......\n.####.\n......").unwrap();
        let kind = |cell| grid.get(cell);
        let pieces = outlines(&Cells::new(*grid.geometry(), Vector2::zeros(), 9.0, false, kind));
        assert_eq!(pieces.len(), 4);
        let length: f64 = pieces.iter().map(|s| (s.b - s.a).norm()).sum();
        assert!((length - 5.0).abs() < 1e-12);
    }
}
