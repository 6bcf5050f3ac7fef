//! A priority queue for keys that never fall below the one taken last: one list a step of the key, sorted when its turn
//! comes.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A cell, the cost with which it was reached, and that cost plus what is at least ahead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Entry {
    pub(crate) key: f64,
    pub(crate) cost: f32,
    pub(crate) cell: u32,
}

/// Lowest key first; of equal keys the one that is further on its way; then by cell, so that the order is fixed.
impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_key = other.key.total_cmp(&self.key);
        by_key.then(self.cost.total_cmp(&other.cost)).then(other.cell.cmp(&self.cell))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Eq for Entry {}

/// The queue.
#[derive(Debug, Default)]
pub(crate) struct Buckets {
    lists: Vec<Vec<Entry>>,
    current: BinaryHeap<Entry>,
    base: f64,
    step: f64,
    now: usize,
}

/// Keys further than this many steps from the first share the last bucket: a bound on memory, not on correctness.
const MOST: f64 = 1e6;

impl Buckets {
    /// Empties the queue, for keys from `base` up in steps of `step`.
    pub(crate) fn reset(&mut self, base: f64, step: f64) {
        self.lists.iter_mut().for_each(Vec::clear);
        self.current.clear();
        (self.base, self.step, self.now) = (base, step, 0);
    }

    pub(crate) fn push(&mut self, entry: Entry) {
        let bucket = ((entry.key - self.base) / self.step).clamp(0.0, MOST) as usize;
        if bucket <= self.now {
            self.current.push(entry);
            return;
        }
        if bucket >= self.lists.len() {
            self.lists.resize_with(bucket + 1, Vec::new);
        }
        self.lists[bucket].push(entry);
    }

    /// Takes the entry with the lowest key.
    pub(crate) fn pop(&mut self) -> Option<Entry> {
        while self.current.is_empty() && self.now + 1 < self.lists.len() {
            self.now += 1;
            self.current.extend(self.lists[self.now].drain(..));
        }
        self.current.pop()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_come_by_rising_key() {
        let mut queue = Buckets::default();
        queue.reset(1.0, 0.5);
        for (cell, key) in [3.2, 1.1, 9.0, 1.0, 1.3, 3.1].into_iter().enumerate() {
            queue.push(Entry { key, cost: 0.0, cell: cell as u32 });
        }
        let cells: Vec<u32> = std::iter::from_fn(|| queue.pop()).map(|entry| entry.cell).collect();
        assert_eq!(cells, [3, 1, 4, 5, 0, 2]);
    }
}
