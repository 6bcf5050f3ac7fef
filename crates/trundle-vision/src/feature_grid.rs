//! Keypoints by position.

use crate::Keypoint;
use std::ops::{Range, RangeInclusive};

/// Side of a cell: 16 px. Source: ours.
const CELL_PX: f32 = 16.0;

/// The features of an image sorted into square cells, for the search of projected points.
///
/// Building is linear in the features; a query reads the cells that its window touches.
#[derive(Debug, Clone, PartialEq)]
pub struct FeatureGrid {
    columns: usize,
    rows: usize,
    /// Start of each cell's entries (row by row); one more at the end.
    starts: Vec<u32>,
    entries: Vec<Entry>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Entry {
    x: f32,
    y: f32,
    index: u32,
    octave: u8,
}

impl FeatureGrid {
    /// Sorts `keypoints` of an image of `width` x `height` px; raw or rectified px, as in the queries. Keypoints outside the image are
    /// found too; those whose position is not finite are never found.
    pub fn new(keypoints: &[Keypoint], width: usize, height: usize) -> Self {
        let count = |side: usize| (side as f32 / CELL_PX).ceil().max(1.0) as usize;
        let (columns, rows) = (count(width), count(height));
        let mut grid = Self { columns, rows, starts: vec![0; columns * rows + 1], entries: Vec::new() };
        let cell = |k: &Keypoint| cell_of(k.y, rows) * columns + cell_of(k.x, columns);
        keypoints.iter().for_each(|k| grid.starts[cell(k) + 1] += 1);
        for i in 1..grid.starts.len() {
            grid.starts[i] += grid.starts[i - 1];
        }
        let mut next = grid.starts.clone();
        grid.entries = vec![Entry { x: 0.0, y: 0.0, index: 0, octave: 0 }; keypoints.len()];
        for (index, keypoint) in keypoints.iter().enumerate() {
            let Keypoint { x, y, octave, .. } = *keypoint;
            let slot = &mut next[cell(keypoint)];
            grid.entries[*slot as usize] = Entry { x, y, index: index as u32, octave };
            *slot += 1;
        }
        grid
    }

    /// The indices of the keypoints within `radius` px (inclusive) of (`x`, `y`) with an octave in `octaves`: cell by cell, row by row,
    /// increasing within a cell.
    pub fn near(
        &self,
        x: f32,
        y: f32,
        radius: f32,
        octaves: RangeInclusive<u8>,
    ) -> impl Iterator<Item = usize> + '_ {
        let radius = radius.max(0.0);
        let across = cell_of(x - radius, self.columns)..cell_of(x + radius, self.columns) + 1;
        let down = cell_of(y - radius, self.rows)..cell_of(y + radius, self.rows) + 1;
        let inside = move |e: &&Entry| {
            let (dx, dy) = (e.x - x, e.y - y);
            dx * dx + dy * dy <= radius * radius && octaves.contains(&e.octave)
        };
        down.flat_map(move |row| self.cells(row, across.clone())).filter(inside).map(|e| e.index as usize)
    }

    /// The entries of some cells of one row, contiguous in memory.
    fn cells(&self, row: usize, columns: Range<usize>) -> &[Entry] {
        let start = |column: usize| self.starts[row * self.columns + column] as usize;
        &self.entries[start(columns.start)..start(columns.end)]
    }
}

/// The cell of a coordinate, the first or last one for those outside.
fn cell_of(position: f32, cells: usize) -> usize {
    // The cast saturates, and takes NaN for 0.
    ((position / CELL_PX) as usize).min(cells - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_keypoints() -> impl Strategy<Value = Vec<Keypoint>> {
        let keypoint = (-30.0..130.0_f32, -30.0..90.0_f32, 0..4u8).prop_map(|(x, y, octave)| Keypoint {
            x,
            y,
            octave,
            angle: 0.0,
            response: 0.0,
        });
        prop::collection::vec(keypoint, 0..100)
    }

    proptest! {
        #[test]
        fn the_grid_finds_what_a_linear_search_finds(
            keypoints in any_keypoints(),
            x in -50.0..150.0_f32, y in -50.0..110.0_f32, radius in 0.0..60.0_f32, low in 0..4u8, high in 0..4u8,
        ) {
            let mut found: Vec<usize> =
                FeatureGrid::new(&keypoints, 100, 60).near(x, y, radius, low..=high).collect();
            found.sort();
            let inside = |k: &Keypoint| (k.x - x).powi(2) + (k.y - y).powi(2) <= radius * radius;
            let expected: Vec<usize> = (0..keypoints.len())
                .filter(|&i| inside(&keypoints[i]) && (low..=high).contains(&keypoints[i].octave))
                .collect();
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn odd_queries_find_nothing() {
        let keypoint = Keypoint { x: f32::NAN, y: 1.0, octave: 0, angle: 0.0, response: 0.0 };
        let grid = FeatureGrid::new(&[keypoint], 0, 0);
        assert_eq!(grid.near(0.0, 0.0, 1e9, 0..=7).count(), 0);
        assert_eq!(grid.near(f32::NAN, 0.0, 5.0, 0..=7).count(), 0);
        assert_eq!(grid.near(0.0, 0.0, -5.0, 0..=7).count(), 0);
    }
}
