//! The live page: displays a run in a browser, and steers it.
//!
//! [`LivePage::start`] serves the page on a separate thread. The page reads views of the run and sends commands by `trundle_app::operator`;
//! the robot never waits for it. Without viewers only a short history is computed.
//!
//! | part | purpose |
//! |---|---|
//! | `access` | tokens of 128 bits: one for driving, one for viewing |
//! | `certificate` | encryption of the page (feature `tls`) |
//! | `http` | the page's files, the checks of Host and Origin, requests within a bounded time |
//! | `viewer` | one browser: data sent to it, and allowed requests |
//! | `wire` | the messages |
//! | `steering` | who holds the wheel; from a request to commands of the robot |
//!
//! The source of the page itself is `page/` (TypeScript); `assets/` holds it as built.
//!
//! ```
//! let address: trundle_live::LiveAddress = "127.0.0.1:8700".parse()?;
//! assert_eq!(address.to_string(), "127.0.0.1:8700");
//! assert!("kitchen:8700".parse::<trundle_live::LiveAddress>().is_err());
//! # Ok::<(), String>(())
//! ```

mod access;
mod address;
mod certificate;
mod error;
mod history;
mod http;
mod options;
mod origin;
mod page_state;
mod processor_time;
mod run_facts;
mod server;
mod steering;
mod viewer;
mod viewer_list;
mod wire;

pub use access::{Access, Tokens};
pub use address::LiveAddress;
pub use certificate::PageCertificate;
pub use error::LiveError;
pub use options::LiveOptions;
pub use run_facts::{RunFacts, RunKind};
pub use server::LivePage;
pub use wire::WIRE_VERSION;
