//! An address to listen on: its text, and who reaches it.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};

/// The address of a text: `IP:PORT`, an IP with the default port, or a port of the loopback address.
///
/// # Errors
/// When the text is none of these.
pub fn read_address(text: &str, default_port: u16) -> Result<SocketAddr, String> {
    let loopback = |port: u16| SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let whole_ip = |ip: IpAddr| SocketAddr::from((ip, default_port));
    let socket = text.parse::<SocketAddr>();
    let socket = socket.or_else(|_| text.parse::<u16>().map(loopback));
    let socket = socket.or_else(|_| text.parse::<IpAddr>().map(whole_ip));
    socket.map_err(|_| {
        format!(
            "'{text}': expected IP:PORT, as 127.0.0.1:{default_port}; 0.0.0.0:{default_port} serves every network of this machine"
        )
    })
}

/// Whether other machines can reach a server at this address.
#[must_use]
pub fn is_shared(address: SocketAddr) -> bool {
    !address.ip().to_canonical().is_loopback()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_an_ip_and_a_port_or_one_of_them() {
        let read = |text: &str| read_address(text, 80).map(|address| address.to_string());
        assert_eq!(read("9000").unwrap(), "127.0.0.1:9000");
        assert_eq!(read("0.0.0.0").unwrap(), "0.0.0.0:80");
        assert_eq!(read("[::1]:81").unwrap(), "[::1]:81");
        for wrong in ["", "recording.mcap", "70000", "robot.local:80", "1.2.3:80"] {
            assert!(read(wrong).unwrap_err().contains("expected IP:PORT, as 127.0.0.1:80"), "{wrong}");
        }
    }

    #[test]
    fn only_loopback_is_not_shared() {
        let is_shared = |text: &str| is_shared(read_address(text, 80).unwrap());
        for own in ["9000", "127.0.0.1", "127.9.9.9", "[::1]:80", "[::ffff:127.0.0.1]:80"] {
            assert!(!is_shared(own), "{own}");
        }
        for shared in ["0.0.0.0", "192.168.1.4:80", "[::]:80", "[fe80::1]:80", "[::ffff:192.168.1.4]:80"] {
            assert!(is_shared(shared), "{shared}");
        }
    }
}
