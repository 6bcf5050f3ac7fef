//! Keyframes by position.

use crate::ids::KeyframeId;
use std::collections::BTreeMap;
use trundle_core::Vector3;

/// Side of a cell: 1 m, the extent of the keyframes of one place. Source: ours.
const CELL_M: f64 = 1.0;

/// Keyframes by position: finds those near a point without checking all others.
#[derive(Debug, Clone, Default)]
pub(crate) struct KeyframeGrid {
    cells: BTreeMap<[i32; 3], Vec<KeyframeId>>,
}

impl KeyframeGrid {
    /// Adds a keyframe.
    pub fn insert(&mut self, id: KeyframeId, position: Vector3) {
        self.cells.entry(cell(position)).or_default().push(id);
    }

    /// Removes a keyframe that was added at `position`.
    pub fn remove(&mut self, id: KeyframeId, position: Vector3) {
        let key = cell(position);
        let Some(ids) = self.cells.get_mut(&key) else { return };
        ids.retain(|other| *other != id);
        if ids.is_empty() {
            self.cells.remove(&key);
        }
    }

    /// The keyframes in all cells that touch the cube of half size `reach` (m) around `position`, by rising id.
    pub fn near(&self, position: Vector3, reach: f64) -> Vec<KeyframeId> {
        let (low, high) = (cell(position.add_scalar(-reach)), cell(position.add_scalar(reach)));
        let mut found = Vec::new();
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                let row = self.cells.range([x, y, low[2]]..=[x, y, high[2]]);
                row.for_each(|(_, ids)| found.extend_from_slice(ids));
            }
        }
        found.sort_unstable();
        found
    }
}

fn cell(position: Vector3) -> [i32; 3] {
    // The cast saturates.
    std::array::from_fn(|i| (position[i] / CELL_M).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_near_keyframe_is_found(
            places in prop::collection::vec(prop::array::uniform3(-4.0..4.0), 1..30),
            at in prop::array::uniform3(-4.0..4.0), reach in 0.0..2.5, gone in 0..30usize,
        ) {
            let at = Vector3::from(at);
            let mut grid = KeyframeGrid::default();
            let places: Vec<Vector3> = places.into_iter().map(Vector3::from).collect();
            let id = KeyframeId::from_index;
            places.iter().enumerate().for_each(|(i, p)| grid.insert(id(i), *p));
            places.get(gone).iter().for_each(|p| grid.remove(id(gone), **p));
            let found = grid.near(at, reach);
            prop_assert!(!found.contains(&id(gone)));
            for (i, place) in places.iter().enumerate().filter(|(i, _)| *i != gone) {
                let off = (place - at).amax();
                prop_assert!(off > reach || found.contains(&id(i)));
                prop_assert!(off <= reach + CELL_M || !found.contains(&id(i)));
            }
        }
    }
}
