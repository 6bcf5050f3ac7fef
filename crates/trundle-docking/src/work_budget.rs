//! Counted work, done in parts.
//!
//! Problem: a search of some tens of milliseconds does not fit into a control step of twenty. Idea: the search is a future that yields when
//! its grant is used up, and continues with the next grant. Counted work alone decides the places of yields: the answer and the number of
//! grants are equal on every machine.

use std::fmt;
use std::pin::{Pin, pin};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::task::{Context, Poll, Waker};

/// Counts the cost of queries, and the cost allowed before the next yield.
#[derive(Debug)]
pub struct WorkBudget {
    work: AtomicU64,
    granted: AtomicU64,
    /// Total work at which every search ends.
    pub max: u64,
}

impl WorkBudget {
    /// A budget that never yields.
    pub fn endless(max: u64) -> Arc<Self> {
        Arc::new(Self { work: AtomicU64::new(0), granted: AtomicU64::new(u64::MAX), max })
    }

    /// A budget that yields immediately, until work is granted.
    pub fn rationed(max: u64) -> Arc<Self> {
        Arc::new(Self { work: AtomicU64::new(0), granted: AtomicU64::new(0), max })
    }

    /// Work so far.
    pub fn work(&self) -> u64 {
        self.work.load(Ordering::Relaxed)
    }

    /// Whether the total limit is reached.
    pub fn is_spent(&self) -> bool {
        self.work() >= self.max
    }

    /// Adds work. A plan runs on one thread.
    pub fn spend(&self, work: u64) {
        self.work.store(self.work().saturating_add(work), Ordering::Relaxed);
    }

    /// Grants work from now on.
    fn grant(&self, work: u64) {
        self.granted.store(self.work().saturating_add(work), Ordering::Relaxed);
    }
}

/// A future that is ready when granted work is left.
#[derive(Debug, Clone, Copy)]
pub struct BudgetYield<'m>(pub &'m WorkBudget);

impl Future for BudgetYield<'_> {
    type Output = ();

    fn poll(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<()> {
        let left = self.0.work() < self.0.granted.load(Ordering::Relaxed);
        if left { Poll::Ready(()) } else { Poll::Pending }
    }
}

/// The result of a search with a budget that never yields.
pub fn run_to_end<T>(search: impl Future<Output = T>) -> T {
    match pin!(search).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => unreachable!("invariant: an endless budget never yields"),
    }
}

/// A search in parts: see [`crate::DockingPlanner::begin`].
pub struct PlanningJob<T> {
    budget: Arc<WorkBudget>,
    search: Pin<Box<dyn Future<Output = T> + Send + Sync>>,
}

impl<T> PlanningJob<T> {
    pub(crate) fn new(
        budget: Arc<WorkBudget>,
        search: impl Future<Output = T> + Send + Sync + 'static,
    ) -> Self {
        Self { budget, search: Box::pin(search) }
    }

    /// Continues the search for about `work` steps of about ten nanoseconds each ([`crate::ContactSpace::work`]), up to the next possible
    /// yield. Returns the result at the end, equal to that of [`crate::DockingPlanner::plan_with_margin`] for any division into parts. Must
    /// not be called again after the result.
    pub fn advance(&mut self, work: u64) -> Option<T> {
        self.budget.grant(work);
        match self.search.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(found) => Some(found),
            Poll::Pending => None,
        }
    }

    /// Work so far, in the same steps.
    pub fn work(&self) -> u64 {
        self.budget.work()
    }
}

impl<T> fmt::Debug for PlanningJob<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PlanningJob").field("work", &self.work()).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Work of `steps` steps of ten, with a yield before each.
    async fn steps(budget: Arc<WorkBudget>, steps: u32) -> u32 {
        for _ in 0..steps {
            BudgetYield(&budget).await;
            budget.spend(10);
        }
        steps
    }

    #[test]
    fn a_job_does_what_is_granted_and_at_most_one_step_more() {
        let budget = WorkBudget::rationed(u64::MAX);
        let mut job = PlanningJob::new(Arc::clone(&budget), steps(budget, 10));
        assert_eq!((job.advance(0), job.work()), (None, 0));
        assert_eq!((job.advance(25), job.work()), (None, 30));
        assert_eq!((job.advance(20), job.work()), (None, 50));
        assert_eq!((job.advance(u64::MAX), job.work()), (Some(10), 100));
    }

    #[test]
    fn unused_grants_are_not_saved() {
        let budget = WorkBudget::rationed(u64::MAX);
        let mut job = PlanningJob::new(Arc::clone(&budget), steps(budget, 3));
        for _ in 0..5 {
            job.advance(0);
        }
        assert_eq!((job.advance(1), job.work()), (None, 10));
    }

    #[test]
    fn an_endless_budget_runs_to_its_end_and_is_spent_at_its_limit() {
        let budget = WorkBudget::endless(25);
        assert_eq!(run_to_end(steps(Arc::clone(&budget), 2)), 2);
        assert!(!budget.is_spent());
        assert_eq!(run_to_end(steps(Arc::clone(&budget), 1)), 1);
        assert!(budget.is_spent());
        budget.spend(u64::MAX);
        assert_eq!(budget.work(), u64::MAX);
    }
}
