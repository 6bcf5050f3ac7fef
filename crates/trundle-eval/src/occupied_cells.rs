//! The occupied cells of a grid, with a search for the nearest one.

use trundle_core::{Cell, CellIndex, GridGeometry, Hypotenuse, OccupancyGrid, Vector2};

/// The occupied cells of a grid, for nearest-cell queries.
#[derive(Debug)]
pub(crate) struct OccupiedCells {
    geometry: GridGeometry,
    occupied: Vec<bool>,
    /// Whether each row has an occupied cell; empty rows are skipped.
    rows: Vec<bool>,
}

impl OccupiedCells {
    pub(crate) fn of(grid: &OccupancyGrid) -> Self {
        let occupied: Vec<bool> = grid.cells().iter().map(|cell| *cell == Cell::Occupied).collect();
        let geometry = *grid.geometry();
        let rows = occupied.chunks(geometry.width).map(|row| row.contains(&true)).collect();
        Self { geometry, occupied, rows }
    }

    /// Centres of the cells, m.
    pub(crate) fn centers(&self) -> impl Iterator<Item = Vector2> + '_ {
        let cells = self.occupied.iter().enumerate().filter(|(_, is)| **is);
        cells.map(|(i, _)| self.geometry.center(self.geometry.cell(i)))
    }

    /// The centre of the occupied cell nearest to a point, within `reach` m.
    ///
    /// Rows by increasing distance, until a row is farther than the best cell.
    pub(crate) fn nearest(&self, point: Vector2, reach: f64) -> Option<Vector2> {
        let g = &self.geometry;
        let at = (point - g.origin) / g.resolution - Vector2::repeat(0.5);
        let (mut best, mut found) = (reach / g.resolution, None);
        let below = (0..rows_below(at.y, g.height)).rev();
        let above = rows_below(at.y, g.height)..g.height;
        let (mut below, mut above) = (below.peekable(), above.peekable());
        loop {
            let down = below.peek().map(|&row| at.y - row as f64);
            let up = above.peek().map(|&row| row as f64 - at.y);
            let row = match (down, up) {
                (None, None) => break,
                (Some(d), u) if u.is_none_or(|u| d <= u) => below.next(),
                _ => above.next(),
            };
            let Some(row) = row else { break };
            let away = (row as f64 - at.y).abs();
            if away > best {
                break;
            }
            if let Some((col, distance)) = self.nearest_in_row(row, at.x, away, best) {
                (best, found) = (distance, Some(g.center(CellIndex { col, row })));
            }
        }
        found
    }

    /// Column and distance, cells, of the occupied cell of a row that is nearest, at most `best`.
    fn nearest_in_row(&self, row: usize, x: f64, away: f64, best: f64) -> Option<(usize, f64)> {
        if !self.rows[row] {
            return None;
        }
        let half = (best * best - away * away).max(0.0).sqrt();
        let width = self.geometry.width as f64;
        let (first, last) = ((x - half).ceil().max(0.0), (x + half).floor().min(width - 1.0));
        if first > last {
            return None;
        }
        let cells = &self.occupied[row * self.geometry.width..];
        let columns = (first as usize..=last as usize).filter(|&col| cells[col]);
        let nearest = columns.min_by(|&a, &b| (a as f64 - x).abs().total_cmp(&(b as f64 - x).abs()))?;
        Some((nearest, away.hypotenuse(nearest as f64 - x)))
    }
}

/// Number of rows with centres at or below `y`, in cells.
fn rows_below(y: f64, height: usize) -> usize {
    if y < 0.0 { 0 } else { (y.floor() as usize + 1).min(height) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_nearest_is_what_looking_at_all_finds(
            art in prop::collection::vec(prop::collection::vec(prop::bool::weighted(0.1), 12), 9),
            x in -1.0..4.0, y in -1.0..3.0, reach in 0.1..5.0,
        ) {
            let geometry = GridGeometry::new(0.25, Vector2::new(0.1, -0.2), 12, 9).unwrap();
            let cells = art.concat().into_iter().map(|o| if o { Cell::Occupied } else { Cell::Free }).collect();
            let cells = OccupiedCells::of(&OccupancyGrid::new(geometry, cells).unwrap());
            let point = Vector2::new(x, y);
            let expected = cells.centers().map(|c| (c - point).norm()).filter(|d| *d <= reach).reduce(f64::min);
            let found = cells.nearest(point, reach).map(|c| (c - point).norm());
            match (found, expected) {
                (Some(a), Some(b)) => prop_assert!((a - b).abs() < 1e-12, "{} {}", a, b),
                (a, b) => prop_assert!(a.is_none() && b.is_none(), "{:?} {:?}", a, b),
            }
        }
    }
}
