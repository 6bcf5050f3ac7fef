//! A bucket queue \[Dial69\]: whole-numbered keys that never decrease, one list per key, in a ring.

/// A cell and its cost when queued.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Entry {
    pub(crate) cell: u32,
    pub(crate) cost: u32,
}

/// A monotone bucket queue. Among equal keys, the newest entry comes first.
#[derive(Debug, Default)]
pub(crate) struct BucketQueue {
    lists: Vec<Vec<Entry>>,
    now: u32,
    left: usize,
}

impl BucketQueue {
    /// Empties the queue, for keys from `first` up that are never more than `reach` above the last key taken.
    pub(crate) fn reset(&mut self, first: u32, reach: u32) {
        self.lists.iter_mut().for_each(Vec::clear);
        self.lists.resize_with((reach as usize + 1).next_power_of_two(), Vec::new);
        (self.now, self.left) = (first, 0);
    }

    pub(crate) fn push(&mut self, key: u32, entry: Entry) {
        debug_assert!(
            key >= self.now && ((key - self.now) as usize) < self.lists.len(),
            "key {key} at {}",
            self.now
        );
        let slot = self.slot(key);
        self.lists[slot].push(entry);
        self.left += 1;
    }

    /// Like [`BucketQueue::push`], but keys may decrease, to half the reach below the last key taken. Keys outside are clamped to the
    /// reach.
    pub(crate) fn push_near(&mut self, key: u32, entry: Entry) {
        let half = self.lists.len() as u32 / 2;
        let key = key.clamp(self.now.saturating_sub(half), self.now + half - 1);
        self.now = self.now.min(key);
        self.push(key, entry);
    }

    /// Takes an entry with the lowest key.
    pub(crate) fn pop(&mut self) -> Option<(u32, Entry)> {
        if self.left == 0 {
            return None;
        }
        loop {
            let slot = self.slot(self.now);
            if let Some(entry) = self.lists[slot].pop() {
                self.left -= 1;
                return Some((self.now, entry));
            }
            self.now += 1;
        }
    }

    fn slot(&self, key: u32) -> usize {
        key as usize & (self.lists.len() - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn entries_come_by_rising_key_around_the_ring() {
        let mut queue = BucketQueue::default();
        queue.reset(100, 10);
        [103, 100, 110].into_iter().for_each(|key| queue.push(key, Entry { cell: key, cost: 0 }));
        let mut keys = Vec::new();
        while let Some((key, entry)) = queue.pop() {
            assert_eq!(key, entry.cell);
            keys.push(key);
            if key < 130 {
                queue.push(key + 10, Entry { cell: key + 10, cost: 0 });
            }
        }
        assert_eq!(keys, [100, 103, 110, 110, 113, 120, 120, 123, 130, 130, 133]);
    }

    proptest! {
        #[test]
        fn every_entry_comes_out_once_and_by_rising_key(first in 0_u32..1000, above in prop::collection::vec(0_u32..64, 0..100)) {
            let mut queue = BucketQueue::default();
            queue.reset(first, 64);
            for (cell, above) in above.iter().enumerate() {
                queue.push(first + above, Entry { cell: cell as u32, cost: *above });
            }
            let popped: Vec<(u32, Entry)> = std::iter::from_fn(|| queue.pop()).collect();
            prop_assert!(popped.windows(2).all(|pair| pair[0].0 <= pair[1].0));
            prop_assert!(popped.iter().all(|(key, entry)| *key == first + entry.cost && above[entry.cell as usize] == entry.cost));
            let mut cells: Vec<u32> = popped.iter().map(|(_, entry)| entry.cell).collect();
            cells.sort_unstable();
            prop_assert!(cells.into_iter().eq(0..above.len() as u32));
        }
    }

    #[test]
    fn a_reset_queue_is_empty() {
        let mut queue = BucketQueue::default();
        queue.reset(0, 4);
        queue.push(3, Entry { cell: 1, cost: 2 });
        queue.reset(0, 4);
        assert_eq!(queue.pop(), None);
    }
}
