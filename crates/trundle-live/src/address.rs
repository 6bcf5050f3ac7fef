//! Address of the live page.

use std::fmt;
use std::net::{Ipv4Addr, SocketAddr};
use std::str::FromStr;
use trundle_app::listening::read_address;

/// Port of the live page if none is given. Source: ours; IANA has it unassigned.
const DEFAULT_PORT: u16 = 8642;

/// Address of the live page: an address of this machine and a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LiveAddress {
    /// The address.
    pub socket: SocketAddr,
    /// Whether another port may be used if this one is in use.
    pub takes_another_port: bool,
}

impl LiveAddress {
    /// The text for the default: loopback, port 8642, or a free port if it is in use.
    pub const DEFAULT: &'static str = "loopback";
}

impl Default for LiveAddress {
    fn default() -> Self {
        let socket = SocketAddr::from((Ipv4Addr::LOCALHOST, DEFAULT_PORT));
        Self { socket, takes_another_port: true }
    }
}

impl FromStr for LiveAddress {
    type Err = String;

    /// `loopback`, `IP:PORT`, or a port of the loopback address.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        if text == Self::DEFAULT {
            return Ok(Self::default());
        }
        let socket = read_address(text, DEFAULT_PORT)?;
        Ok(Self { socket, takes_another_port: false })
    }
}

impl fmt::Display for LiveAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.socket.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trundle_app::listening::is_shared;

    #[test]
    fn an_address_is_read_and_loopback_is_not_shared() {
        let read = |text: &str| text.parse::<LiveAddress>();
        assert_eq!(read("loopback").unwrap(), LiveAddress::default());
        assert_eq!(read("9000").unwrap().socket.to_string(), "127.0.0.1:9000");
        assert_eq!(read("0.0.0.0").unwrap().socket.to_string(), "0.0.0.0:8642");
        assert!(!is_shared(LiveAddress::default().socket));
        for wrong in ["", "recording.mcap", "70000", "robot.local:80", "1.2.3:80"] {
            assert!(read(wrong).unwrap_err().contains("expected IP:PORT"), "{wrong}");
        }
    }
}
