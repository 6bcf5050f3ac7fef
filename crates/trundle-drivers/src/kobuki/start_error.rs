//! Reason why a base cannot be started.

use super::base_status::FIRMWARE_PAGE;
use super::link::ConnectError;
use super::protocol::Version;
use super::stream_check::StreamFault;
use thiserror::Error;
use trundle_core::Invalid;

/// A base that cannot be started.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StartError {
    /// The configuration is refused.
    #[error(transparent)]
    Config(#[from] Invalid),
    /// The port cannot be opened.
    #[error(transparent)]
    Connect(#[from] ConnectError),
    /// The link broke while the base was waited for.
    #[error("port {port} broke while the base was waited for: {source}; check the cable")]
    Link {
        /// The port.
        port: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// No byte arrives.
    #[error(
        "port {port}: no byte came within {waited_s} s, expected 50 packets per second: switch the base on, or check the cable"
    )]
    NoBytes {
        /// The port.
        port: String,
        /// Time waited, s.
        waited_s: f64,
    },
    /// Something comes, but no packet of a Kobuki.
    #[error(
        "port {port}: {bytes} bytes came within {waited_s} s, but no Kobuki packet; {refused} damaged headers; the first bytes are \
         {first_bytes}: another device is on this port, or another program reads it"
    )]
    NotAKobuki {
        /// The port.
        port: String,
        /// Time waited, s.
        waited_s: f64,
        /// Bytes received.
        bytes: u64,
        /// Refused packet headers.
        refused: u64,
        /// The first bytes received, in hexadecimal.
        first_bytes: String,
    },
    /// Two devices or programs send on the port.
    #[error("port {port}: {fault}")]
    Stream {
        /// The port.
        port: String,
        /// The fault.
        fault: StreamFault,
    },
    /// The firmware has another protocol version.
    #[error("port {port}: the base's firmware is {firmware}, expected 1.x: update it, see {FIRMWARE_PAGE}")]
    Firmware {
        /// The port.
        port: String,
        /// Version of the firmware.
        firmware: Version,
    },
    /// The system gives no thread.
    #[error("no thread for the base on port {port}: {source}; close other programs")]
    Thread {
        /// The port.
        port: String,
        /// The system's reason.
        source: std::io::Error,
    },
}
