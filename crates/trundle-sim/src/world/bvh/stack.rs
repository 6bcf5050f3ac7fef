//! The traversal stack of the hierarchy.

/// Number of entries without heap allocation. Source: ours.
const INLINE_ENTRIES: usize = 64;

/// (distance, link).
type Entry = (f32, u32);

/// A stack of nodes to be visited. Up to [`INLINE_ENTRIES`] entries, more than any reasonable tree needs, cost no allocation.
pub(super) struct Stack {
    fixed: [Entry; INLINE_ENTRIES],
    len: usize,
    rest: Vec<Entry>,
}

impl Stack {
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self { fixed: [(0.0, 0); INLINE_ENTRIES], len: 0, rest: Vec::new() }
    }

    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(super) fn push(&mut self, entry: Entry) {
        if self.len < INLINE_ENTRIES {
            self.fixed[self.len] = entry;
        } else {
            self.rest.push(entry);
        }
        self.len += 1;
    }

    /// Inserts an entry among those above `bottom`, sorted with the nearest on top.
    #[inline(always)]
    pub(super) fn push_sorted(&mut self, bottom: usize, entry: Entry) {
        let mut at = self.len;
        self.push(entry);
        while at > bottom && at < INLINE_ENTRIES && self.fixed[at - 1].0 < entry.0 {
            self.fixed.swap(at, at - 1);
            at -= 1;
        }
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<Entry> {
        self.len = self.len.checked_sub(1)?;
        if self.len < INLINE_ENTRIES { Some(self.fixed[self.len]) } else { self.rest.pop() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_come_first_and_nothing_is_lost_beyond_the_fixed_part() {
        let mut stack = Stack::new();
        stack.push((9.0, 0));
        for (i, distance) in [3.0, 1.0, 2.0].into_iter().enumerate() {
            stack.push_sorted(1, (distance, i as u32 + 1));
        }
        let order: Vec<u32> = std::iter::from_fn(|| stack.pop()).map(|entry| entry.1).collect();
        assert_eq!(order, [2, 3, 1, 0]);
        (0..200).for_each(|i| stack.push_sorted(0, (0.0, i)));
        let mut popped: Vec<u32> = std::iter::from_fn(|| stack.pop()).map(|entry| entry.1).collect();
        popped.sort_unstable();
        assert_eq!(popped, (0..200).collect::<Vec<_>>());
    }
}
