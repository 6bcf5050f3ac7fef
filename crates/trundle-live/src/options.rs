//! How the live page is served.

use crate::{LiveAddress, Tokens};

/// How the live page is served.
#[derive(Debug, Clone)]
pub struct LiveOptions {
    /// Where.
    pub address: LiveAddress,
    /// Permissions to drive and to look.
    pub tokens: Tokens,
    /// Whether the run takes commands; a replay takes none.
    pub is_steered: bool,
}
