//! Thinning of walls to their own thickness, without a gap.
//!
//! Problem: a wall of one cell that is moved by a part of a cell covers two cells in half, and a diagonal wall covers no cell by half. A
//! threshold of the coverage then opens the wall or thickens it. Idea: all cells that the wall touches are occupied at first, which closes
//! it. The cells with the smallest coverage are cleared first, as long as the wall stays connected and each of its cells stays
//! represented. Cells that are covered by half or more are never cleared. A cell is cleared only if it is simple: its neighbourhood has one
//! crossing from free to occupied \[Hilditch69\], so neither walls nor floors are joined or cut.

use std::collections::BTreeMap;
use trundle_core::GridGeometry;

/// Coverage from which a cell is occupied whatever its neighbours are. Source: ours; half keeps the area of a wall.
const MIN_KEPT_SHARE: f64 = 0.5;

/// A cell that occupied cells of the map touch.
pub(super) struct TouchedCell {
    /// Row-major index.
    pub linear: usize,
    /// Part of the cell that they cover, 0 to 1.
    pub share: f64,
    /// Their row-major indices in the map.
    pub sources: Vec<usize>,
}

/// Which cells are occupied, of those that occupied cells of the map touch. Walls do not open, and none is thicker than its coverage makes
/// it.
pub(super) fn thinned(geometry: &GridGeometry, touched: &[TouchedCell]) -> Vec<bool> {
    let mut plane = Plane::new(geometry);
    let mut represented: BTreeMap<usize, u32> = BTreeMap::new();
    for cell in touched {
        plane.set(cell.linear, true);
        cell.sources.iter().for_each(|source| *represented.entry(*source).or_default() += 1);
    }
    let mut fringe: Vec<&TouchedCell> = touched.iter().filter(|cell| cell.share < MIN_KEPT_SHARE).collect();
    fringe.sort_by(|a, b| a.share.total_cmp(&b.share).then(a.linear.cmp(&b.linear)));
    // A cleared cell can make others simple.
    loop {
        let before = fringe.len();
        fringe.retain(|cell| {
            let is_spare = cell.sources.iter().all(|source| represented[source] > 1);
            if !is_spare || !plane.is_simple(cell.linear) {
                return true;
            }
            plane.set(cell.linear, false);
            for source in &cell.sources {
                if let Some(count) = represented.get_mut(source) {
                    *count -= 1;
                }
            }
            false
        });
        if fringe.len() == before {
            break;
        }
    }
    touched.iter().map(|cell| plane.is_occupied(cell.linear)).collect()
}

/// Occupied cells, with a border of free cells.
struct Plane {
    width: usize,
    stride: usize,
    cells: Vec<bool>,
}

impl Plane {
    fn new(geometry: &GridGeometry) -> Self {
        let stride = geometry.width + 2;
        Self { width: geometry.width, stride, cells: vec![false; stride * (geometry.height + 2)] }
    }

    fn place(&self, linear: usize) -> usize {
        (linear / self.width + 1) * self.stride + linear % self.width + 1
    }

    fn set(&mut self, linear: usize, is_occupied: bool) {
        let at = self.place(linear);
        self.cells[at] = is_occupied;
    }

    fn is_occupied(&self, linear: usize) -> bool {
        self.cells[self.place(linear)]
    }

    /// Whether the cell can change without joining or cutting anything: occupied cells are connected by sides and corners, others by sides.
    fn is_simple(&self, linear: usize) -> bool {
        let (at, up) = (self.place(linear), self.stride);
        let around = [at + 1, at + up + 1, at + up, at + up - 1, at - 1, at - up - 1, at - up, at - up + 1]
            .map(|near| self.cells[near]);
        let crossings = (0..8).step_by(2).filter(|&side| {
            let corner = around[(side + 1) % 8];
            !around[side] && (corner || around[(side + 2) % 8])
        });
        crossings.count() == 1
    }
}
