//! The exact distance transform over cell squares, as a whole or of a changed part.
//!
//! Two sweeps over the columns count the rows to the nearest obstacle, then each row is eroded by parabolas
//! ([`super::erosion`]).
//!
//! After a change inside a box, only cells can change whose old obstacle is at least as far as the box. These cells form a star around the
//! box: the line from such a cell to the box crosses only such cells. Rows are therefore processed from the box outward until a row has no
//! such cell. A cell of slack covers the distance between two centres.

use super::erosion::{Erosion, Gaps};
use super::window::Window;
use std::ops::Range;
use trundle_core::GridGeometry;

/// Memory of the transform between two changes.
#[derive(Debug)]
pub(super) struct Transform<'a> {
    pub(super) geometry: &'a GridGeometry,
    pub(super) is_obstacle: &'a [bool],
    /// Whether the space outside the grid is an obstacle.
    pub(super) outside: bool,
    /// For each cell, rows to the nearest obstacle of its column, at most `none`; 0 in obstacles.
    pub(super) gap: &'a mut [u16],
    /// Distances from centres to squares, m, at most `reach`.
    pub(super) distance: &'a mut [f32],
    /// The count of rows that means a column without an obstacle.
    pub(super) none: u16,
    /// Largest stored distance, m.
    pub(super) reach: f64,
}

impl Transform<'_> {
    /// Updates gaps and distances after obstacles changed inside `dirty`; returns the window of possible changes.
    pub(super) fn update(&mut self, dirty: &Window) -> Window {
        let whole = *dirty == Window::whole(self.geometry);
        let rows = if whole { 0..self.geometry.height } else { self.rows_of_gaps(dirty) };
        self.sweep(dirty.cols.clone(), rows);
        let mut erosion = Erosion::default();
        let mut touched = dirty.clone();
        let mut refresh = |this: &mut Self, row: usize| {
            let cols = if whole { Some(dirty.cols.clone()) } else { this.cols_of_row(dirty, row) };
            let Some(cols) = cols else { return false };
            touched.include(&cols, row);
            let line = row * this.geometry.width..(row + 1) * this.geometry.width;
            let border = if this.outside { 0 } else { this.none };
            let gaps = Gaps { of: &this.gap[line.clone()], none: this.none, border };
            let distance = &mut this.distance[line];
            erosion.erode(gaps, cols.clone());
            erosion.write(&mut distance[cols], this.geometry.resolution, this.reach);
            true
        };
        (dirty.rows.start..self.geometry.height).take_while(|row| refresh(self, *row)).for_each(drop);
        (0..dirty.rows.start).rev().take_while(|row| refresh(self, *row)).for_each(drop);
        touched
    }

    /// The rows in which a column's gap may change: those whose old obstacle is at least as far as the box.
    fn rows_of_gaps(&self, dirty: &Window) -> Range<usize> {
        let width = self.geometry.width;
        let reaches = |row: usize, off: usize| {
            let at = row * width;
            self.gap[at + dirty.cols.start..at + dirty.cols.end].iter().any(|gap| usize::from(*gap) >= off)
        };
        let (mut low, mut high) = (dirty.rows.start, dirty.rows.end);
        while high < self.geometry.height && reaches(high, high + 1 - dirty.rows.end) {
            high += 1;
        }
        while low > 0 && reaches(low - 1, dirty.rows.start - low + 1) {
            low -= 1;
        }
        low..high
    }

    /// Counts the cells to the nearest occupied one in the same column. The gap next to the rows bounds the effect of obstacles outside
    /// them, and is exact for the cells that can change.
    fn sweep(&mut self, cols: Range<usize>, rows: Range<usize>) {
        let (width, none) = (self.geometry.width, self.none);
        let beyond = vec![if self.outside { 0 } else { none }; cols.len()];
        for row in rows.clone() {
            let (below, here) = self.gap.split_at_mut(row * width);
            let under = if row == 0 { &beyond } else { &below[below.len() - width..][cols.clone()] };
            let is_obstacle = &self.is_obstacle[row * width..][cols.clone()];
            for ((here, under), is_obstacle) in here[cols.clone()].iter_mut().zip(under).zip(is_obstacle) {
                let counted = under.saturating_add(1).min(none);
                *here = if *is_obstacle { 0 } else { counted };
            }
        }
        for row in rows.rev() {
            let (here, above) = self.gap.split_at_mut((row + 1) * width);
            let over = if above.is_empty() { &beyond } else { &above[cols.clone()] };
            for (here, over) in here[row * width..][cols.clone()].iter_mut().zip(over) {
                *here = (*here).min(over.saturating_add(1));
            }
        }
    }

    /// The columns of a row in which distances may change, including one cell of slack.
    fn cols_of_row(&self, dirty: &Window, row: usize) -> Option<Range<usize>> {
        let GridGeometry { width, resolution, .. } = *self.geometry;
        let off = |at: usize, low: usize, high: usize| {
            let (at, low, high) = (at as f32, low as f32, high as f32);
            (low - 0.5 - at).max(at + 0.5 - high).max(0.0)
        };
        let across = off(row, dirty.rows.start, dirty.rows.end);
        let per_cell = 1.0 / resolution as f32;
        let line = &self.distance[row * width..(row + 1) * width];
        let may_change = |col: &usize| {
            let along = off(*col, dirty.cols.start, dirty.cols.end);
            let reach = line[*col] * per_cell + 1.01;
            reach * reach >= along * along + across * across
        };
        // No distance is above the reach.
        let max = (self.reach / resolution).min(width as f64) as usize + 3;
        let cols = dirty.cols.start.saturating_sub(max)..(dirty.cols.end + max).min(width);
        let first = cols.clone().find(may_change)?;
        let last = (first..cols.end).rev().find(may_change)?;
        Some(first..last + 1)
    }
}
