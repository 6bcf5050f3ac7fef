//! Options of the live page.

use crate::{Certificate, LiveAddress, Tokens};
use trundle_app::operator::MapFolder;

/// Options of the live page.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LiveOptions {
    /// Address of the page.
    pub address: LiveAddress,
    /// Permissions to drive and to view.
    pub tokens: Tokens,
    /// Whether the run takes commands; a replay and an experiment take none.
    pub is_steered: bool,
    /// Maps that may be loaded.
    pub maps: Option<MapFolder>,
    /// Certificate of an encrypted page.
    pub certificate: Option<Certificate>,
}

impl LiveOptions {
    /// A page at `address`, not encrypted.
    pub const fn new(
        address: LiveAddress,
        tokens: Tokens,
        is_steered: bool,
        maps: Option<MapFolder>,
    ) -> Self {
        Self { address, tokens, is_steered, maps, certificate: None }
    }
}
