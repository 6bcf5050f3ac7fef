//! Whether anybody reads a topic.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether other nodes subscribe to a topic. Clones share it.
#[derive(Debug, Clone)]
pub struct Readers {
    /// Full name of the topic.
    pub(super) topic: String,
    are_there: Arc<AtomicBool>,
}

impl Readers {
    pub(super) fn new(topic: String) -> Self {
        Self { topic, are_there: Arc::default() }
    }

    /// Whether another node reads the topic; up to a second late.
    #[must_use]
    pub fn are_there(&self) -> bool {
        self.are_there.load(Ordering::Relaxed)
    }

    pub(super) fn set(&self, are_there: bool) {
        self.are_there.store(are_there, Ordering::Relaxed);
    }
}
