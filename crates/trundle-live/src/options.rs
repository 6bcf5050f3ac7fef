//! Options of the live page.

use crate::{LiveAddress, Tokens};
use trundle_app::operator::MapFolder;

/// Options of the live page.
#[derive(Debug, Clone)]
pub struct LiveOptions {
    /// Address of the page.
    pub address: LiveAddress,
    /// Permissions to drive and to view.
    pub tokens: Tokens,
    /// Whether the run takes commands; a replay and an experiment take none.
    pub is_steered: bool,
    /// Maps that may be loaded.
    pub maps: Option<MapFolder>,
}
