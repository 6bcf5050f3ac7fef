//! Regions of cells, by label.

use std::collections::BTreeSet;
use trundle_core::GridGeometry;

/// A label of each cell, or none.
pub(super) struct Regions {
    geometry: GridGeometry,
    cells: Vec<Option<u32>>,
    count: usize,
}

impl Regions {
    pub(super) fn new(geometry: GridGeometry, cells: Vec<Option<u32>>, count: usize) -> Self {
        Self { geometry, cells, count }
    }

    pub(super) fn geometry(&self) -> &GridGeometry {
        &self.geometry
    }

    pub(super) fn cells(&self) -> &[Option<u32>] {
        &self.cells
    }

    /// One more than the largest label.
    pub(super) fn len(&self) -> usize {
        self.count
    }

    /// The labels that cells have, in order.
    pub(super) fn labels(&self) -> Vec<u32> {
        let counts = self.counts();
        (0..self.count as u32).filter(|label| counts[*label as usize] > 0).collect()
    }

    /// Number of cells of each label.
    pub(super) fn counts(&self) -> Vec<usize> {
        let mut counts = vec![0; self.count];
        self.cells.iter().flatten().for_each(|label| counts[*label as usize] += 1);
        counts
    }

    /// The cells of a label.
    pub(super) fn cells_of(&self, label: u32) -> impl Iterator<Item = usize> + '_ {
        (0..self.cells.len()).filter(move |i| self.cells[*i] == Some(label))
    }

    /// Gives each cell the label that `new` has for its own.
    pub(super) fn relabel(&mut self, new: &[Option<u32>]) {
        self.cells.iter_mut().for_each(|label| *label = label.and_then(|label| new[label as usize]));
    }

    /// The pairs of neighbouring cells of different labels, the lower label first.
    pub(super) fn borders(&self) -> impl Iterator<Item = ([u32; 2], [usize; 2])> + '_ {
        let width = self.geometry.width;
        let pairs = move |i: usize| {
            let right = (!(i + 1).is_multiple_of(width)).then_some(i + 1);
            let up = (i + width < self.cells.len()).then_some(i + width);
            [right, up].into_iter().flatten().map(move |near| [i, near])
        };
        (0..self.cells.len()).flat_map(pairs).filter_map(|[a, b]| {
            let (one, two) = (self.cells[a]?, self.cells[b]?);
            (one != two).then_some(([one.min(two), one.max(two)], [a, b]))
        })
    }

    /// Gives a region the holes inside it that are smaller than `max_area` m^2.
    pub(super) fn fill_holes(&mut self, max_area: f64) {
        let GridGeometry { resolution, .. } = self.geometry;
        let max_cells = (max_area / (resolution * resolution)) as usize;
        let mut seen = vec![false; self.cells.len()];
        for start in 0..self.cells.len() {
            if self.cells[start].is_some() || seen[start] {
                continue;
            }
            let (hole, around) = self.hole(start, &mut seen);
            if let (Some(label), true) = (around, hole.len() < max_cells) {
                hole.into_iter().for_each(|i| self.cells[i] = Some(label));
            }
        }
    }

    /// The cells without a label that are connected with `start`, and the label of all cells about them if it is one.
    fn hole(&self, start: usize, seen: &mut [bool]) -> (Vec<usize>, Option<u32>) {
        seen[start] = true;
        let hole = connected(&self.geometry, start, |i| {
            self.cells[i].is_none() && !std::mem::replace(&mut seen[i], true)
        });
        let beside = hole.iter().flat_map(|i| neighbours(&self.geometry, *i));
        let around: BTreeSet<Option<u32>> = beside
            .filter_map(|near| match near.map(|near| self.cells[near]) {
                Some(None) => None,
                Some(label) => Some(label),
                None => Some(None),
            })
            .collect();
        let only = around.first().filter(|_| around.len() == 1).copied().flatten();
        (hole, only)
    }
}

/// `start` and the cells that are connected with it by sides over cells that `enter` accepts. `enter` refuses a cell that it accepted before.
pub(super) fn connected(
    geometry: &GridGeometry,
    start: usize,
    mut enter: impl FnMut(usize) -> bool,
) -> Vec<usize> {
    let (mut cells, mut open) = (Vec::new(), vec![start]);
    while let Some(i) = open.pop() {
        cells.push(i);
        open.extend(neighbours(geometry, i).into_iter().flatten().filter(|near| enter(*near)));
    }
    cells
}

/// The cells beside a cell: right, left, above, below; `None` outside the grid.
pub(super) fn neighbours(geometry: &GridGeometry, i: usize) -> [Option<usize>; 4] {
    let (width, col) = (geometry.width, i % geometry.width);
    [
        (col + 1 < width).then_some(i + 1),
        (col > 0).then(|| i - 1),
        (i + width < geometry.len()).then_some(i + width),
        i.checked_sub(width),
    ]
}
