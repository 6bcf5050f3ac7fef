//! Options of the server.

use crate::PageOrigin;
use std::net::SocketAddr;
use trundle_app::listening::read_address;

/// Port of Foxglove's protocol if none is given. Source: the connection dialogue of Foxglove.
const DEFAULT_PORT: u16 = 8765;
/// The address if none is given: loopback, with the port that Foxglove connects to.
pub const DEFAULT_ADDRESS: &str = "127.0.0.1:8765";

/// Options of the server.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FoxgloveOptions {
    /// Address to listen on.
    pub address: SocketAddr,
    /// Name of the run, as viewers display it.
    pub name: String,
    /// Pages that may connect besides those of Foxglove.
    pub origins: Vec<PageOrigin>,
}

impl FoxgloveOptions {
    /// A server at `address` for a run of this name.
    #[must_use]
    pub const fn new(address: SocketAddr, name: String) -> Self {
        Self { address, name, origins: Vec::new() }
    }
}

/// Reads an address: `IP:PORT`, an IP, or a port of the loopback address.
///
/// # Errors
/// When the text is none of these.
pub fn read_foxglove_address(text: &str) -> Result<SocketAddr, String> {
    read_address(text, DEFAULT_PORT)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_app::listening::is_shared;

    #[test]
    fn the_default_of_foxglove_is_loopback_and_not_shared() {
        let default = read_foxglove_address(DEFAULT_ADDRESS).unwrap();
        assert!(default.port() == DEFAULT_PORT && !is_shared(default));
    }
}
