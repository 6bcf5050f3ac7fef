//! The address of a broker.

use std::fmt;
use std::str::FromStr;

/// Port of MQTT without encryption. Source: IANA.
const PLAIN_PORT: u16 = 1883;

/// The address of a broker: `mqtt://[USER@]HOST[:PORT]`. It contains no password, which the list of processes would show.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BrokerAddress {
    /// The user, if the broker requires one.
    pub user: Option<String>,
    /// Name or address of the machine.
    pub host: String,
    /// The port.
    pub port: u16,
}

const FORM: &str = "expected mqtt://USER@HOST:PORT, as mqtt://robot@192.168.1.4:1883";

impl FromStr for BrokerAddress {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.starts_with("mqtts://") {
            return Err(
                "mqtts: this program does not encrypt; let a broker on this machine forward to the encrypted one (docs/how-to/home-and-fleet.md)"
                    .to_owned(),
            );
        }
        let rest = text.strip_prefix("mqtt://").ok_or(FORM)?;
        let rest = rest.strip_suffix('/').unwrap_or(rest);
        let (user, place) = match rest.rsplit_once('@') {
            Some((user, place)) => (Some(user), place),
            None => (None, rest),
        };
        if user.is_some_and(|user| user.contains(':')) {
            return Err("the address holds a password, which every user of this machine could read: \
                        give it by TRUNDLE_MQTT_PASSWORD or --mqtt-password-file"
                .to_owned());
        }
        let (host, port) = split_port(place)?;
        let is_name = |text: &str| !text.is_empty() && !text.contains(['/', '?', '#', ' ']);
        if !is_name(host) || user.is_some_and(str::is_empty) {
            return Err(format!("'{text}': {FORM}"));
        }
        Ok(Self { user: user.map(str::to_owned), host: host.to_owned(), port })
    }
}

/// Host and port; an IPv6 address is in brackets.
fn split_port(place: &str) -> Result<(&str, u16), String> {
    let end_of_host = place.rfind(']').map_or(0, |bracket| bracket + 1);
    match place[end_of_host..].rfind(':') {
        None => Ok((place, PLAIN_PORT)),
        Some(colon) => {
            let (host, port) = place.split_at(end_of_host + colon);
            let port = &port[1..];
            port.parse().map(|port| (host, port)).map_err(|_| format!("port '{port}': {FORM}"))
        }
    }
}

impl BrokerAddress {
    /// Whether the broker runs on this machine.
    #[must_use]
    pub fn is_local(&self) -> bool {
        let host = self.host.trim_matches(['[', ']']);
        host == "localhost" || host.parse::<std::net::IpAddr>().is_ok_and(|address| address.is_loopback())
    }
}

impl fmt::Display for BrokerAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let user = self.user.as_ref().map(|user| format!("{user}@")).unwrap_or_default();
        write!(f, "mqtt://{user}{}:{}", self.host, self.port)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read() {
        let read = |text: &str| text.parse::<BrokerAddress>().map(|address| address.to_string());
        assert_eq!(read("mqtt://broker").unwrap(), "mqtt://broker:1883");
        assert_eq!(read("mqtt://robot@10.0.0.2:1884/").unwrap(), "mqtt://robot@10.0.0.2:1884");
        assert_eq!(read("mqtt://[::1]:1883").unwrap(), "mqtt://[::1]:1883");
        assert!(read("mqtt://robot:secret@broker").unwrap_err().contains("TRUNDLE_MQTT_PASSWORD"));
        assert!(read("mqtts://broker").unwrap_err().contains("does not encrypt"));
        for wrong in
            ["", "broker", "http://broker", "mqtt://", "mqtt://@broker", "mqtt://broker:70000", "mqtt://a/b"]
        {
            assert!(read(wrong).unwrap_err().contains("expected mqtt://"), "{wrong}");
        }
    }
}
