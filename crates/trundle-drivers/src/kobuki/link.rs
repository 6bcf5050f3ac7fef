//! A byte link to a device, and its opener.

use std::io;
use std::path::PathBuf;
use std::time::Duration;
use thiserror::Error;

/// An open link of bytes to a device.
pub trait ByteLink: Send {
    /// Reads the available bytes; waits at most `wait` for the first one. Returns 0 if no byte arrived.
    ///
    /// # Errors
    /// When the link is permanently lost.
    fn read(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize>;

    /// Writes without waiting; the number of bytes taken, 0 when the link is full.
    ///
    /// # Errors
    /// When the link is permanently lost.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize>;
}

/// Opens a link, and opens it again after it was lost.
pub trait Connector: Send {
    /// Opens the link; bytes from before are dropped.
    ///
    /// # Errors
    /// When the port is missing, busy, not permitted, or not a serial port.
    fn connect(&mut self) -> Result<Box<dyn ByteLink>, ConnectError>;

    /// The name of the port of the latest attempt, for messages.
    fn port(&self) -> String;
}

/// A port that cannot be opened.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConnectError {
    /// The port does not exist.
    #[error("port {} does not exist: connect the base's USB cable and switch the base on", port.display())]
    Missing {
        /// The port.
        port: PathBuf,
    },
    /// The port exists, but no device is connected.
    #[error("port {} has no device behind it: connect the base's USB cable and switch the base on, or name another port", port.display())]
    NoDevice {
        /// The port.
        port: PathBuf,
    },
    /// Another program has the port.
    #[error("port {} is in use by another program: close it (`fuser {}` names it)", port.display(), port.display())]
    Busy {
        /// The port.
        port: PathBuf,
    },
    /// The user has no permission to open the port.
    #[error(
        "no right to open port {}: join the group dialout with `sudo usermod -aG dialout $USER`, then log in again",
        port.display()
    )]
    NoRights {
        /// The port.
        port: PathBuf,
    },
    /// The file is not a serial port.
    #[error("{} is not a serial port, expected one as /dev/ttyUSB0 or /dev/kobuki", port.display())]
    NotASerialPort {
        /// The file.
        port: PathBuf,
    },
    /// The port cannot be opened for another reason.
    #[error("port {} cannot be opened: {source}", port.display())]
    Io {
        /// The port.
        port: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}
