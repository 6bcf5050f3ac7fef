//! A base as a user names it.

use crate::kobuki::{Connector, SerialConnector};
use crate::kobuki_finder::KobukiFinder;
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Udev rule that names a Kobuki's port and gives access to the group `dialout`. The FTDI chip of a Kobuki has a serial number that begins
/// with `kobuki`. Source: measured by many users; the chip is an FT232 (0403:6001).
pub const KOBUKI_UDEV_RULE: &str = "SUBSYSTEM==\"tty\", ATTRS{idVendor}==\"0403\", ATTRS{idProduct}==\"6001\", \
    ATTRS{serial}==\"kobuki*\", ATTR{device/latency_timer}=\"1\", MODE=\"0660\", GROUP=\"dialout\", SYMLINK+=\"kobuki\"";

/// A base as a user names it: `kobuki`, `kobuki:PORT`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum BaseSpec {
    /// A Kobuki at a serial port; `None`: the port at which one is found, at each attempt to connect.
    Kobuki(Option<PathBuf>),
}

impl BaseSpec {
    /// Opener of the base's port. `program` has the command [`crate::kobuki::base_guard::GUARD_COMMAND`]: a guard process stops the base if
    /// this program dies.
    #[must_use]
    pub fn connector(&self, program: &Path) -> Box<dyn Connector> {
        let Self::Kobuki(port) = self;
        match port {
            Some(port) => Box::new(SerialConnector::new(port).guarded_by(program)),
            None => Box::new(KobukiFinder::new(program)),
        }
    }
}

impl FromStr for BaseSpec {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once(':') {
            None if text == "kobuki" => Ok(Self::Kobuki(None)),
            Some(("kobuki", port)) if !port.is_empty() => Ok(Self::Kobuki(Some(port.into()))),
            _ => Err(format!("no base '{text}', expected kobuki or kobuki:PORT, as kobuki:/dev/ttyUSB0")),
        }
    }
}

impl fmt::Display for BaseSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Kobuki(port) = self;
        match port {
            Some(port) => write!(f, "kobuki:{}", port.display()),
            None => f.write_str("kobuki"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_base_is_named_by_kind_and_port() {
        for text in ["kobuki", "kobuki:/dev/ttyUSB0", "kobuki:/tmp/a:b"] {
            assert_eq!(text.parse::<BaseSpec>().unwrap().to_string(), text);
        }
        for text in ["", "roomba", "kobuki:", "Kobuki:/dev/ttyUSB0"] {
            assert!(
                text.parse::<BaseSpec>().unwrap_err().starts_with(&format!("no base '{text}', expected"))
            );
        }
    }
}
