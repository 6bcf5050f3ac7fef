//! Options for joining a broker.

use crate::{BrokerAddress, FleetError};
use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// Environment variable of the password.
const PASSWORD_VARIABLE: &str = "TRUNDLE_MQTT_PASSWORD";
/// Largest file of a password \[bytes\]. Source: ours.
const MAX_PASSWORD_BYTES: usize = 1024;
/// Longest part of a name \[bytes\]. Source: ours.
const MAX_NAME_BYTES: usize = 64;
/// Manufacturer if none is given.
const MANUFACTURER: &str = "trundle";

/// Options for joining a broker.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct FleetOptions {
    /// The broker.
    pub broker: BrokerAddress,
    /// The password, if the broker requires one.
    pub password: Option<Password>,
    /// The robot in topics and messages.
    pub name: RobotName,
    /// The map in messages.
    pub map_id: String,
}

impl FleetOptions {
    /// A robot of the default name at a broker without a password.
    pub fn new(broker: BrokerAddress, map_id: String) -> Self {
        Self { broker, password: None, name: RobotName::default(), map_id }
    }
}

/// A password. Its debug text hides the content.
#[derive(Clone)]
pub struct Password(String);

impl Password {
    /// The password of a file, or of the variable TRUNDLE_MQTT_PASSWORD; `None` without both.
    ///
    /// # Errors
    /// When the file cannot be read, is too large or is empty.
    pub fn read(file: Option<&Path>) -> Result<Option<Self>, FleetError> {
        let Some(file) = file else {
            return Ok(std::env::var(PASSWORD_VARIABLE).ok().filter(|text| !text.is_empty()).map(Self));
        };
        let broken = |problem: String| FleetError::PasswordFile { file: file.to_owned(), problem };
        let text = std::fs::read_to_string(file).map_err(|error| broken(error.to_string()))?;
        let text = text.trim_end_matches(['\r', '\n']);
        if text.is_empty() || text.len() > MAX_PASSWORD_BYTES {
            let bytes = text.len();
            return Err(broken(format!("{bytes} bytes, expected one line of 1 to {MAX_PASSWORD_BYTES}")));
        }
        Ok(Some(Self(text.to_owned())))
    }

    /// The password itself.
    pub(crate) fn text(&self) -> &str {
        &self.0
    }
}

impl fmt::Debug for Password {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Password")
    }
}

/// The robot in topics and messages: `SERIAL` or `MANUFACTURER/SERIAL`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RobotName {
    /// Manufacturer.
    pub manufacturer: String,
    /// Serial number.
    pub serial_number: String,
}

impl Default for RobotName {
    /// The name of this machine; `robot` if that is not valid in a topic.
    fn default() -> Self {
        let machine = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
        let robot = || Self { manufacturer: MANUFACTURER.to_owned(), serial_number: "robot".to_owned() };
        machine.trim().parse().unwrap_or_else(|_| robot())
    }
}

impl FromStr for RobotName {
    type Err = FleetError;

    fn from_str(text: &str) -> Result<Self, FleetError> {
        let (manufacturer, serial_number) = text.split_once('/').unwrap_or((MANUFACTURER, text));
        let is_plain = |part: &str| {
            let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
            (1..=MAX_NAME_BYTES).contains(&part.len()) && part.chars().all(is_plain)
        };
        if !is_plain(manufacturer) || !is_plain(serial_number) {
            return Err(FleetError::Name(text.to_owned()));
        }
        Ok(Self { manufacturer: manufacturer.to_owned(), serial_number: serial_number.to_owned() })
    }
}

impl fmt::Display for RobotName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.manufacturer, self.serial_number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_in_topics() {
        let read = |text: &str| text.parse::<RobotName>().map(|name| name.to_string());
        assert_eq!(read("r-7").unwrap(), "trundle/r-7");
        assert_eq!(read("acme/r_7").unwrap(), "acme/r_7");
        for wrong in ["", "a/b/c", "#", "r+", "/r", "r/", "r 7", &"r".repeat(65)] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_password_is_the_line_of_its_file_and_is_not_shown() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("password");
        std::fs::write(&file, "secret\n").unwrap();
        let password = Password::read(Some(&file)).unwrap().unwrap();
        assert_eq!((password.text(), format!("{password:?}").as_str()), ("secret", "Password"));
        std::fs::write(&file, "\n").unwrap();
        assert!(Password::read(Some(&file)).unwrap_err().to_string().contains("expected one line"));
        assert!(Password::read(Some(&place.path().join("none"))).is_err());
    }
}
