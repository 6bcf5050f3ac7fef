//! Actions that are carried out immediately.

use super::header::MessageHeader;
use super::order::Action;
use serde::Deserialize;

/// Actions that are carried out immediately.
#[derive(Debug, Clone, Deserialize)]
pub struct InstantActions {
    /// The header.
    #[serde(flatten)]
    pub header: MessageHeader,
    /// The actions. Masters of version 1.1, and some of 2.0, name the field `instantActions`.
    #[serde(alias = "instantActions")]
    pub actions: Vec<Action>,
}
