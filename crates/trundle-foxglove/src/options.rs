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

    /// Whether other machines can reach the server.
    pub(crate) fn is_shared(&self) -> bool {
        !self.address.ip().is_loopback()
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

    #[test]
    fn the_default_of_foxglove_is_loopback_and_not_shared() {
        let is_shared = |text: &str| {
            let address = read_foxglove_address(text).unwrap();
            FoxgloveOptions::new(address, String::new()).is_shared()
        };
        assert_eq!(read_foxglove_address(DEFAULT_ADDRESS).unwrap().port(), DEFAULT_PORT);
        assert!(!is_shared(DEFAULT_ADDRESS) && !is_shared("[::1]:1") && !is_shared("9000"));
        assert!(is_shared("0.0.0.0") && is_shared("192.168.1.4:8765"));
    }
}
