//! Names of this machine in the Host of a request. A page that rebinds its own name to this machine sends that name; an address cannot be
//! rebound.

use std::net::IpAddr;

/// The name or the address of a Host; `None` if its port is invalid.
#[must_use]
pub fn name_of_host(host: &str) -> Option<&str> {
    let (name, port) = match host.strip_prefix('[') {
        Some(rest) => rest.split_once(']').unwrap_or_default(),
        None => host.split_at(host.rfind(':').unwrap_or(host.len())),
    };
    let is_port = |port: &str| port.strip_prefix(':').is_some_and(|port| port.parse::<u16>().is_ok());
    (port.is_empty() || is_port(port)).then_some(name)
}

/// Whether a name is one of this machine: loopback, and if other machines can reach it (`is_shared`) any address and the machine's name.
#[must_use]
pub fn is_own_name(name: &str, is_shared: bool) -> bool {
    match name.parse::<IpAddr>() {
        Ok(address) => is_shared || address.is_loopback(),
        Err(_) => name.eq_ignore_ascii_case("localhost") || is_shared && is_machine_name(name),
    }
}

/// Whether a name is that of this machine, plain or on the local network.
fn is_machine_name(name: &str) -> bool {
    let own = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    let own = own.trim();
    let plain = name.strip_suffix(".local").unwrap_or(name);
    !own.is_empty() && plain.eq_ignore_ascii_case(own)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_cannot_be_rebound_are_own() {
        let is_own = |host, is_shared| name_of_host(host).is_some_and(|name| is_own_name(name, is_shared));
        for own in ["127.0.0.1:8642", "localhost:8642", "LOCALHOST", "[::1]:8642", "127.9.9.9"] {
            assert!(is_own(own, false), "{own}");
        }
        for foreign in [
            "evil.example:8642",
            "192.168.1.4:8642",
            "",
            "127.0.0.1.evil.example",
            "[::2]:1",
            "127.0.0.1:8642; x",
            "[::1",
        ] {
            assert!(!is_own(foreign, false), "{foreign}");
        }
        assert!(is_own("192.168.1.4:8642", true) && !is_own("evil.example", true));
    }
}
