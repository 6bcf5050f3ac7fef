//! Work that is counted, and may be done in parts.
//!
//! Problem: a search of some tens of milliseconds has no place in a control step of twenty. Idea: the search is a future that
//! rests wherever it has used up what it was granted, and goes on at the next grant. Nothing but counted work decides where,
//! so that the answer and the number of grants are the same on every machine.

use crate::plan::Plan;
use std::fmt;
use std::pin::{Pin, pin};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::task::{Context, Poll, Waker};

/// Counts what answers have cost, and how much they may cost before a rest.
#[derive(Debug)]
pub struct Meter {
    work: AtomicU64,
    granted: AtomicU64,
    /// Everything ends when the work comes to this.
    pub most: u64,
}

impl Meter {
    /// Never asks for a rest.
    pub fn endless(most: u64) -> Arc<Self> {
        Arc::new(Self { work: AtomicU64::new(0), granted: AtomicU64::new(u64::MAX), most })
    }

    /// Rests at once, until more is granted.
    pub fn rationed(most: u64) -> Arc<Self> {
        Arc::new(Self { work: AtomicU64::new(0), granted: AtomicU64::new(0), most })
    }

    /// So far.
    pub fn work(&self) -> u64 {
        self.work.load(Ordering::Relaxed)
    }

    /// Whether it has come to the most.
    pub fn is_spent(&self) -> bool {
        self.work() >= self.most
    }

    /// Adds work. One at a time: a plan runs on one thread.
    pub fn spend(&self, work: u64) {
        self.work.store(self.work().saturating_add(work), Ordering::Relaxed);
    }

    /// From now on so much.
    fn grant(&self, work: u64) {
        self.granted.store(self.work().saturating_add(work), Ordering::Relaxed);
    }
}

/// Waits until there is something left of what was granted.
#[derive(Debug, Clone, Copy)]
pub struct Rest<'m>(pub &'m Meter);

impl Future for Rest<'_> {
    type Output = ();

    fn poll(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<()> {
        let left = self.0.work() < self.0.granted.load(Ordering::Relaxed);
        if left { Poll::Ready(()) } else { Poll::Pending }
    }
}

/// The result of a search among spaces of an endless meter.
pub fn at_once<T>(search: impl Future<Output = T>) -> T {
    match pin!(search).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => unreachable!("invariant: an endless meter never asks for a rest"),
    }
}

/// A plan, or something else, in the making: see [`crate::Docker::begin`].
pub struct Planning<T = Plan> {
    meter: Arc<Meter>,
    search: Pin<Box<dyn Future<Output = T> + Send + Sync>>,
}

impl<T> Planning<T> {
    pub(crate) fn new(meter: Arc<Meter>, search: impl Future<Output = T> + Send + Sync + 'static) -> Self {
        Self { meter, search: Box::pin(search) }
    }

    /// Searches on for about `work` steps, each about ten nanoseconds ([`crate::Space::work`]): it rests at the first place
    /// beyond. The plan, once there is one: the same as [`crate::Docker::plan_keeping`]'s, however it is cut. Not to be called
    /// again after that.
    pub fn go_on(&mut self, work: u64) -> Option<T> {
        self.meter.grant(work);
        match self.search.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(found) => Some(found),
            Poll::Pending => None,
        }
    }

    /// What it has cost so far, in the same steps.
    pub fn work(&self) -> u64 {
        self.meter.work()
    }
}

impl<T> fmt::Debug for Planning<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Planning").field("work", &self.work()).finish_non_exhaustive()
    }
}
