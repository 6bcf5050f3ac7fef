//! Reasons in files: the text, and the names of the kinds.

use super::kind::ReasonKind;
use serde::{Deserialize, Serialize};

/// A reason in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct RecordedReason {
    /// The text.
    pub(super) reason: String,
    /// The kinds, outermost first; empty in files without kinds.
    #[serde(default)]
    pub(super) kinds: Vec<ReasonKind>,
}
