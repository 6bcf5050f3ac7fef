//! Actions that are done at once.

use super::header::Header;
use super::order::Action;
use serde::Deserialize;

/// Actions that are done at once.
#[derive(Debug, Clone, Deserialize)]
pub struct InstantActions {
    /// The header.
    #[serde(flatten)]
    pub header: Header,
    /// The actions.
    pub actions: Vec<Action>,
}
