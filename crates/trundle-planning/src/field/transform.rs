//! The exact distance transform of \[Felzenszwalb12\] over cell squares, as a whole or where something changed.
//!
//! Two sweeps over the columns, then one lower envelope of parabolas a row: O(cells). A parabola stands on each vertical
//! cell edge: the nearest point of a square seen from another column's centre lies on its near edge, so width + 1
//! parabolas are enough for distances to squares instead of centres.
//!
//! After a change inside a box, only cells can change that are no nearer to their old obstacle than to the box. Seen
//! from the box these lie in the shape of a star: the way from such a cell to the box leads through such cells only. So
//! rows are looked at from the box outward until one has none (a cell of slack covers the way between two centres).

use super::window::Window;
use crate::field::FAR;
use trundle_core::GridGeometry;

/// A count of rows that stands for "none in this column". From here on a distance counts as none.
pub(super) const NONE: u16 = u16::MAX;

/// What the transform keeps from one change to the next.
#[derive(Debug)]
pub(super) struct Transform<'a> {
    pub(super) geometry: &'a GridGeometry,
    /// Whether everything outside the grid is an obstacle.
    pub(super) outside: bool,
    /// Of each cell, rows to the nearest obstacle of its column; 0 in obstacles.
    pub(super) gap: &'a mut [u16],
    /// From centres to squares, m.
    pub(super) distance: &'a mut [f32],
}

impl Transform<'_> {
    /// Brings gaps and distances up to date after obstacles changed inside `dirty`; returns where distances may have.
    pub(super) fn update(&mut self, dirty: &Window, occupied: impl Fn(usize) -> bool) -> Window {
        let whole = *dirty == Window::whole(self.geometry);
        let rows = if whole { 0..self.geometry.height } else { self.rows_of_gaps(dirty) };
        self.sweep(dirty, rows.clone(), occupied);
        let mut envelope = Envelope::new(self.geometry.width);
        let mut touched = dirty.clone();
        let mut refresh = |this: &mut Self, row: usize| {
            let cols = if whole { Some(dirty.cols.clone()) } else { this.cols_of_row(dirty, row) };
            let Some(cols) = cols else { return false };
            touched.include(&cols, row);
            envelope.transform(this, row, cols);
            true
        };
        (dirty.rows.start..self.geometry.height).take_while(|row| refresh(self, *row)).for_each(drop);
        (0..dirty.rows.start).rev().take_while(|row| refresh(self, *row)).for_each(drop);
        touched
    }

    /// The rows where a column's gap may change: those no nearer to their old obstacle than to the box.
    fn rows_of_gaps(&self, dirty: &Window) -> std::ops::Range<usize> {
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

    /// Counts the cells to the nearest occupied one in the same column. The gap beside the rows bounds what comes from
    /// beyond them, and is the truth where it matters.
    fn sweep(&mut self, dirty: &Window, rows: std::ops::Range<usize>, occupied: impl Fn(usize) -> bool) {
        let (width, cols) = (self.geometry.width, dirty.cols.clone());
        let beyond = if self.outside { 0 } else { NONE };
        for row in rows.clone() {
            let (below, here) = self.gap.split_at_mut(row * width);
            let inside = dirty.rows.contains(&row);
            for col in cols.clone() {
                let under = if row == 0 { beyond } else { below[below.len() - width + col] };
                let is_obstacle = if inside { occupied(row * width + col) } else { here[col] == 0 };
                here[col] = if is_obstacle { 0 } else { under.saturating_add(1) };
            }
        }
        for row in rows.rev() {
            let (here, above) = self.gap.split_at_mut((row + 1) * width);
            let here = &mut here[row * width..];
            for col in cols.clone() {
                let over = above.get(col).copied().unwrap_or(beyond);
                here[col] = here[col].min(over.saturating_add(1));
            }
        }
    }

    /// The columns of a row where distances may change, a cell of slack included.
    fn cols_of_row(&self, dirty: &Window, row: usize) -> Option<std::ops::Range<usize>> {
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
        let first = (0..width).find(may_change)?;
        let last = (first..width).rev().find(may_change)?;
        Some(first..last + 1)
    }
}

/// The lower envelope of parabolas standing on the vertical edges of a row's cells; lengths in cells.
struct Envelope {
    /// Edge `e` (at e - 1/2) of each parabola of the envelope.
    edge: Vec<f64>,
    /// Its height.
    height: Vec<f64>,
    /// Where it begins to be the lowest.
    from: Vec<f64>,
}

impl Envelope {
    fn new(width: usize) -> Self {
        let buffer = || Vec::with_capacity(width + 1);
        Self { edge: buffer(), height: buffer(), from: buffer() }
    }

    /// Writes the distances of `cols` of a row.
    fn transform(&mut self, field: &mut Transform<'_>, row: usize, cols: std::ops::Range<usize>) {
        let GridGeometry { width, resolution, .. } = *field.geometry;
        let span = row * width..(row + 1) * width;
        let (gap, distance) = (&field.gap[span.clone()], &mut field.distance[span]);
        self.build(gap, sources(distance, &cols, resolution), field.outside);
        let mut k = 0;
        for x in cols {
            let at = x as f64;
            while k + 1 < self.from.len() && self.from[k + 1] <= at {
                k += 1;
            }
            let beside = self.edge.get(k).map_or(f64::INFINITY, |edge| (at - edge).powi(2) + self.height[k]);
            distance[x] = (beside.min(squared(gap[x])).sqrt() * resolution).min(FAR) as f32;
        }
    }

    /// From the gaps of the columns `sources`.
    fn build(&mut self, gap: &[u16], sources: std::ops::Range<usize>, outside: bool) {
        self.edge.clear();
        self.height.clear();
        self.from.clear();
        let border = if outside { 0 } else { NONE };
        for e in sources.start..=sources.end {
            let left = if e == 0 { border } else { gap[e - 1] };
            let right = gap.get(e).copied().unwrap_or(border);
            let least = left.min(right);
            if least < NONE {
                self.push(e as f64 - 0.5, squared(least));
            }
        }
    }

    fn push(&mut self, edge: f64, height: f64) {
        let mut from = f64::NEG_INFINITY;
        while let (Some(&e), Some(&h), Some(&f)) = (self.edge.last(), self.height.last(), self.from.last()) {
            let meet = ((height + edge * edge) - (h + e * e)) / (2.0 * (edge - e));
            if meet > f {
                from = meet;
                break;
            }
            self.edge.pop();
            self.height.pop();
            self.from.pop();
        }
        self.edge.push(edge);
        self.height.push(height);
        self.from.push(from);
    }
}

/// The columns that can hold the nearest obstacle of any of `cols`: from a neighbour that keeps its distance, no further
/// than that distance, for the distance changes by at most a cell a cell.
fn sources(distance: &[f32], cols: &std::ops::Range<usize>, resolution: f64) -> std::ops::Range<usize> {
    let reach = |col: usize| (f64::from(distance[col]) / resolution).ceil() as usize + 2;
    let low = cols.start.checked_sub(1).map_or(0, |beside| beside.saturating_sub(reach(beside)));
    let high = if cols.end < distance.len() { cols.end + reach(cols.end) } else { distance.len() };
    low..high.min(distance.len())
}

/// The squared vertical gap, in cells, between a cell's centre and a square `count` rows away.
fn squared(count: u16) -> f64 {
    if count == NONE { f64::INFINITY } else { (f64::from(count) - 0.5).max(0.0).powi(2) }
}
