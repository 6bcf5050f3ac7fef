//! Budget of a search in lookups of the pyramid, which does not depend on the machine's speed.

use std::cell::Cell;

/// Remaining number of lookups of a search.
#[derive(Debug)]
pub(crate) struct LookupBudget {
    given: u64,
    left: Cell<u64>,
}

impl LookupBudget {
    /// Budget of `lookups`.
    pub(crate) fn new(lookups: u64) -> Self {
        Self { given: lookups, left: Cell::new(lookups) }
    }

    /// Unlimited budget.
    pub(crate) fn unlimited() -> Self {
        Self::new(u64::MAX)
    }

    /// Subtracts `lookups`, down to zero.
    pub(crate) fn take(&self, lookups: usize) {
        self.left.set(self.left.get().saturating_sub(lookups as u64));
    }

    /// Whether the budget is spent. The search may then have missed the best place.
    pub(crate) fn is_spent(&self) -> bool {
        self.left.get() == 0
    }

    /// Number of lookups used.
    pub(crate) fn used(&self) -> u64 {
        self.given - self.left.get()
    }
}
