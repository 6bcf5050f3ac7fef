//! Budget of a search in lookups of the pyramid: the same on every machine, unlike time.

use std::cell::Cell;

/// Lookups that a search may still make.
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

    /// Budget that no search spends.
    pub(crate) fn unlimited() -> Self {
        Self::new(u64::MAX)
    }

    /// Takes `lookups` out, or all that is left.
    pub(crate) fn take(&self, lookups: usize) {
        self.left.set(self.left.get().saturating_sub(lookups as u64));
    }

    /// Whether nothing is left. A search that spent it may have missed the best place.
    pub(crate) fn is_spent(&self) -> bool {
        self.left.get() == 0
    }

    /// Lookups taken out.
    pub(crate) fn used(&self) -> u64 {
        self.given - self.left.get()
    }
}
