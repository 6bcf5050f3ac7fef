//! A priority queue for keys that hardly fall: one list a step of the key.

/// Cells by rising key; cells of one bucket come in no particular but a fixed order.
#[derive(Debug, Default)]
pub(crate) struct Buckets {
    lists: Vec<Vec<(u32, f32)>>,
    base: f64,
    step: f64,
    now: usize,
}

/// Keys further than this many steps from the first share the last bucket: a bound on memory, not on correctness.
const MOST: f64 = 4e6;

impl Buckets {
    /// Empties the queue, for keys from `base` up in steps of `step`.
    pub(crate) fn reset(&mut self, base: f64, step: f64) {
        self.lists.iter_mut().for_each(Vec::clear);
        (self.base, self.step, self.now) = (base, step, 0);
    }

    /// Adds an entry: a cell and the cost with which it was reached.
    pub(crate) fn push(&mut self, key: f64, cell: u32, cost: f32) {
        let bucket = ((key - self.base) / self.step).clamp(self.now as f64, MOST) as usize;
        if bucket >= self.lists.len() {
            self.lists.resize_with(bucket + 1, Vec::new);
        }
        self.lists[bucket].push((cell, cost));
    }

    /// Takes an entry of the lowest bucket, with the lowest key that bucket can hold.
    pub(crate) fn pop(&mut self) -> Option<(f64, u32, f32)> {
        while self.now < self.lists.len() {
            if let Some((cell, cost)) = self.lists[self.now].pop() {
                return Some((self.base + self.now as f64 * self.step, cell, cost));
            }
            self.now += 1;
        }
        None
    }
}
