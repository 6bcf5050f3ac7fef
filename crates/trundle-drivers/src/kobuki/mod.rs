//! The Kobuki base: its serial protocol, driver and emulator.
//!
//! | module | content |
//! |---|---|
//! | [`protocol`] | commands and feedback packets, to bytes and from bytes |
//! | [`decoder`] | packets out of a damaged stream of bytes |
//! | [`feedback_events`] | sensor events out of packets |
//! | [`accessories`] | lights, sounds and outputs of a running base |
//! | `kept_accessories` | those of its commands that outlast a lost link |
//! | [`base`], [`base_config`], [`base_status`], [`start_error`] | the driver: threads, settings, counters, errors of the start |
//! | [`base_guard`] | a process that stops the base if this process dies (Unix) |
//! | [`stream_check`] | signs of two users of one port |
//! | `base_identity` | the unique id of the base on the port |
//! | [`link`] | a link of bytes, and its opener |
//! | [`serial_port`] | a serial port of the system (Unix) |
//! | [`emulator`] | the device's end of the protocol |
//! | [`pseudo_terminal`] | a serial port without hardware (Unix) |

pub mod accessories;
pub mod base;
pub mod base_config;
#[cfg(unix)]
pub mod base_guard;
mod base_identity;
pub mod base_status;
mod command_schedule;
pub mod decoder;
pub mod emulator;
pub mod feedback_events;
mod io_loop;
mod kept_accessories;
pub mod link;
mod link_state;
mod outbox;
mod probe;
pub mod protocol;
#[cfg(unix)]
pub mod pseudo_terminal;
#[cfg(unix)]
pub mod serial_port;
pub mod start_error;
pub mod stream_check;

pub use accessories::Accessories;
pub use base::{EventSink, KobukiBase};
pub use base_config::KobukiBaseConfig;
pub use base_status::{BaseCounters, Versions};
pub use decoder::fuzz_decoder;
pub use emulator::{EmulatedKobuki, KobukiState};
pub use feedback_events::GyroSource;
pub use link::{ByteLink, ConnectError, Connector};
#[cfg(unix)]
pub use pseudo_terminal::PseudoTerminal;
#[cfg(unix)]
pub use serial_port::{SerialConnector, SerialPort};
pub use start_error::StartError;
