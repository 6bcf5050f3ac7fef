//! Context of a displayed run: its position in a series, and the runs before it.

use std::sync::Arc;

/// A work of many steps or runs, one of which is shown.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SeriesView {
    /// Name of the counted things: `images`, `runs`.
    pub unit: &'static str,
    /// Number of finished ones.
    pub done: usize,
    /// Total number; `None` if unknown.
    pub total: Option<usize>,
    /// Number of runs that were shown before the present one. At another number all that was shown belongs to another run.
    pub number: u64,
    /// Name of the displayed run; empty if the series has one run.
    pub shown: String,
    /// The runs that have ended, in the order of their ends.
    pub ended: Arc<Vec<EndedRun>>,
}

/// A run that has ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EndedRun {
    /// Name of the run.
    pub name: String,
    /// Whether the run succeeded.
    pub is_success: bool,
    /// Result of the run, in one sentence.
    pub text: String,
}
