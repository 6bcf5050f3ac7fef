//! What stands around a run that is shown: its part of a longer work, and the runs beside it.

use std::sync::Arc;

/// A work of many steps or runs, one of which is shown.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SeriesView {
    /// What is counted: `images`, `runs`.
    pub unit: &'static str,
    /// Number of those that are done.
    pub done: usize,
    /// Number of all, where it is known.
    pub total: Option<usize>,
    /// Number of runs that were shown before the present one. At another number all that was shown belongs to another run.
    pub number: u64,
    /// The run that is shown; empty where there is one alone.
    pub shown: String,
    /// The runs that have ended, in the order of their ends.
    pub ended: Arc<Vec<EndedRun>>,
}

/// A run that has ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EndedRun {
    /// Its name.
    pub name: String,
    /// Whether it is as it should be.
    pub is_success: bool,
    /// Its result in a sentence.
    pub text: String,
}
