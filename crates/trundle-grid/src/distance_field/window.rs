//! Rectangle of cells.

use std::ops::Range;
use trundle_core::GridGeometry;

/// Rectangle of cells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Window {
    pub(crate) cols: Range<usize>,
    pub(crate) rows: Range<usize>,
}

impl Window {
    /// All cells.
    pub(super) fn whole(geometry: &GridGeometry) -> Self {
        Self { cols: 0..geometry.width, rows: 0..geometry.height }
    }

    /// Grows to hold these columns of a row.
    pub(super) fn include(&mut self, cols: &Range<usize>, row: usize) {
        self.cols = self.cols.start.min(cols.start)..self.cols.end.max(cols.end);
        self.rows = self.rows.start.min(row)..self.rows.end.max(row + 1);
    }

    /// The smallest box around the range `changed` of each row; `None` if no row changed.
    pub(super) fn around(
        geometry: &GridGeometry,
        changed: impl Fn(usize) -> Option<Range<usize>>,
    ) -> Option<Self> {
        let mut found: Option<Self> = None;
        for row in 0..geometry.height {
            let Some(cols) = changed(row) else { continue };
            match &mut found {
                Some(window) => window.include(&cols, row),
                None => found = Some(Self { cols, rows: row..row + 1 }),
            }
        }
        found
    }
}
