//! Directory of shared tiles over a bounding box that grows in all directions.

use std::sync::Arc;

/// Dense directory of tiles, each behind `Arc`: a clone shares all tiles with its original.
///
/// Lookup is O(1). Memory: one reference for each slot of the bounding box.
#[derive(Debug)]
pub(crate) struct TileDirectory<T> {
    /// Lowest slot of the bounding box.
    first: (i32, i32),
    cols: usize,
    rows: usize,
    slots: Vec<Option<Arc<T>>>,
}

impl<T> Default for TileDirectory<T> {
    fn default() -> Self {
        Self { first: (0, 0), cols: 0, rows: 0, slots: Vec::new() }
    }
}

impl<T> Clone for TileDirectory<T> {
    fn clone(&self) -> Self {
        Self { slots: self.slots.clone(), ..*self }
    }
}

impl<T> TileDirectory<T> {
    /// Tile at a slot; `None` if no tile was stored.
    pub(crate) fn get(&self, at: (i32, i32)) -> Option<&Arc<T>> {
        self.index(at).and_then(|index| self.slots[index].as_ref())
    }

    /// Slot to write to. The bounding box grows to contain it.
    pub(crate) fn slot_mut(&mut self, at: (i32, i32)) -> &mut Option<Arc<T>> {
        let index = self.reach(at);
        &mut self.slots[index]
    }

    /// Grows the bounding box to contain a slot; index of the slot.
    pub(crate) fn reach(&mut self, at: (i32, i32)) -> usize {
        if let Some(index) = self.index(at) {
            return index;
        }
        let empty = self.slots.is_empty();
        let last = (self.first.0 + self.cols as i32 - 1, self.first.1 + self.rows as i32 - 1);
        let low = if empty { at } else { (self.first.0.min(at.0), self.first.1.min(at.1)) };
        let high = if empty { at } else { (last.0.max(at.0), last.1.max(at.1)) };
        self.resize(low, ((high.0 - low.0 + 1) as usize, (high.1 - low.1 + 1) as usize));
        self.index(at).expect("invariant: the directory was grown to contain the slot")
    }

    /// Lowest slot of the bounding box, with its columns and rows.
    #[cfg(test)]
    pub(crate) fn bounds(&self) -> ((i32, i32), (usize, usize)) {
        (self.first, (self.cols, self.rows))
    }

    /// Stored tiles with their slots, row by row.
    pub(crate) fn iter(&self) -> impl Iterator<Item = ((i32, i32), &Arc<T>)> {
        let at = |i: usize| (self.first.0 + (i % self.cols) as i32, self.first.1 + (i / self.cols) as i32);
        self.slots.iter().enumerate().filter_map(move |(i, tile)| Some((at(i), tile.as_ref()?)))
    }

    /// Bytes of the directory itself, without its tiles.
    pub(crate) fn bytes(&self) -> usize {
        self.slots.capacity() * size_of::<Option<Arc<T>>>()
    }

    fn resize(&mut self, first: (i32, i32), (cols, rows): (usize, usize)) {
        let mut slots = vec![None; cols * rows];
        for (i, tile) in self.slots.drain(..).enumerate() {
            let col = (self.first.0 - first.0) as usize + i % self.cols;
            let row = (self.first.1 - first.1) as usize + i / self.cols;
            slots[row * cols + col] = tile;
        }
        *self = Self { first, cols, rows, slots };
    }

    fn index(&self, (x, y): (i32, i32)) -> Option<usize> {
        let (col, row) =
            (x.wrapping_sub(self.first.0) as u32 as usize, y.wrapping_sub(self.first.1) as u32 as usize);
        (col < self.cols && row < self.rows).then_some(row * self.cols + col)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    proptest! {
        #[test]
        fn is_a_map_from_slots_to_tiles(
            writes in prop::collection::vec((-40..40_i32, -40..40_i32, any::<u8>()), 1..40),
        ) {
            let mut directory = TileDirectory::default();
            let mut model = BTreeMap::new();
            for (x, y, value) in writes {
                *directory.slot_mut((x, y)) = Some(Arc::new(value));
                model.insert((x, y), value);
            }
            let found: BTreeMap<_, _> = directory.iter().map(|(at, tile)| (at, **tile)).collect();
            prop_assert_eq!(&found, &model);
            let (first, (cols, rows)) = directory.bounds();
            let low = (model.keys().map(|at| at.0).min(), model.keys().map(|at| at.1).min());
            let high = (model.keys().map(|at| at.0).max(), model.keys().map(|at| at.1).max());
            prop_assert_eq!((Some(first.0), Some(first.1)), low);
            prop_assert_eq!((Some(first.0 + cols as i32 - 1), Some(first.1 + rows as i32 - 1)), high);
            prop_assert!(directory.get((41, 0)).is_none() && directory.get((i32::MIN, i32::MAX)).is_none());
        }
    }
}
