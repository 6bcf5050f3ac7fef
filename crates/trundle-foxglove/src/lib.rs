//! A run in Foxglove and Lichtblick, to view only.
//!
//! [`FoxgloveServer::start`] serves views of a run by Foxglove's WebSocket protocol on a separate thread. The views come from
//! `trundle_app::operator`; the robot never waits for a viewer, and without viewers nothing is computed. No message of a viewer reaches the
//! robot: the server offers no capability of the protocol and has no code that sends a command.
//!
//! The messages and their schemas are those of the `foxglove` crate. Its server is not used: it accepts every page of a browser.
//!
//! | part | purpose |
//! |---|---|
//! | `access` | the limit of viewers, the checks of Host and Origin |
//! | `viewer` | one program that displays the run: its subscriptions, and the data sent to it |
//! | `protocol` | the protocol's messages |
//! | `topic`, `messages` | the topics, and their messages from a view of the run |
//!
//! ```
//! let address = trundle_foxglove::read_foxglove_address("9000")?;
//! assert_eq!(address.to_string(), "127.0.0.1:9000");
//! assert!(trundle_foxglove::read_foxglove_address("kitchen:8765").is_err());
//! # Ok::<(), String>(())
//! ```

mod access;
mod error;
mod messages;
mod options;
mod protocol;
mod server;
mod topic;
mod viewer;

pub use access::PageOrigin;
pub use error::FoxgloveError;
pub use options::{DEFAULT_ADDRESS, FoxgloveOptions, read_foxglove_address};
pub use server::FoxgloveServer;
